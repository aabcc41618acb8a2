"""Run what a grading needs and the store does not have; then grade from the store alone."""

from __future__ import annotations

import sys

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.proving import prove_all
from compare.benchmark.records.store import Store
from compare.benchmark.run import swarm, warm_up
from compare.benchmark.suite import Instance, Split, chosen, suite
from compare.benchmark.summaries import bound_of
from compare.engines import Engine
from compare.grading.failures import Console
from compare.grading.grading import Grading, graded
from compare.grading.protocol import GradingProtocol
from compare.grading.reasons import features_of
from formulations import CASES, InputError


def chosen_instances(names: str | None) -> tuple[list[Instance], str]:
    """Return the instances that a swarm is graded on, and what they are called.

    Parameters
    ----------
    names : str or None
        Names of shipped cases or of instances, or problem files, with commas between them; None: the
        held-out instances.

    Returns
    -------
    instances : list of Instance
    kind : str

    Raises
    ------
    InputError
        There is none of a name.
    """
    if names is None:
        return [one for one in suite() if one.split is Split.held_out], "held-out instances"
    listed = [name.strip() for name in names.split(",") if name.strip()]
    if not listed:
        raise InputError("--cases: none given")
    known = {} if set(listed) <= set(CASES) else {one.name: one for one in suite()}
    found = [known[name] if name in known else chosen([name])[0] for name in listed]
    if len({one.name for one in found}) < len(found):
        raise InputError("--cases: an instance is named twice")
    return found, "instances"


def run_and_grade(
    pool: Engine,
    protocol: GradingProtocol,
    instances: list[Instance],
    store: Store,
    *,
    called: tuple[str, str],
    kind: str,
) -> Grading:
    """Run what is missing, and grade.

    Parameters
    ----------
    pool : Engine
    protocol : GradingProtocol
    instances : list of Instance
    store : Store
        Where runs and bounds are kept; what it has is not computed again.
    called : (str, str)
        How the user named the swarm and the other one.
    kind : str
        What the instances are called.

    Returns
    -------
    Grading
    """
    prove_all(pool, instances, store)
    ladders, described = store.ladders(), store.instances()
    left_out = {one.name: reason for one in instances if (reason := _no_optimum(ladders[one.name]))}
    for name, reason in left_out.items():
        print(f"left out: {name}: {reason}", file=sys.stderr, flush=True)
    problems = {one.name: one.problem for one in instances if one.name not in left_out}
    if not problems:
        raise InputError(f"--cases: no instance has an optimum: {next(iter(left_out.values()))}")
    warm_up(problems)
    swarm(pool, protocol.runs(problems), problems, store, tell=Console())
    return graded(
        protocol,
        store.rows(),
        dict(store.traces()),
        proved={name: proved_gap(ladders[name]) for name in problems},
        features={
            name: features_of(problem, described[name]["features"])
            for name, problem in problems.items()
        },
        called=called,
        kind=kind,
        left_out=left_out,
    )


def _no_optimum(record: LadderRecord) -> str:
    """Why no gap can be told on an instance; empty if one can."""
    rung = record["ladder"]["family"]
    return "" if rung["seconds"] is not None else f"no verified optimum: {rung['note']}"


def proved_gap(record: LadderRecord) -> float:
    """Return how far a verified optimum is from the bound that gaps are measured against.

    Parameters
    ----------
    record : LadderRecord
        Bounds of an instance that has an optimum.

    Returns
    -------
    float
    """
    bound, _ = bound_of(record)
    optimum = record["ladder"]["family"]["seconds"]
    return max(0.0, optimum / bound - 1.0) if bound and optimum else 0.0
