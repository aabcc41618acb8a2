"""Run what a grading needs and the store does not have; then grade from the store alone."""

from __future__ import annotations

from concurrent.futures import Executor

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.proving import prove_all
from compare.benchmark.records.store import Store
from compare.benchmark.run import swarm, warm_up
from compare.benchmark.statistics import bound_of
from compare.benchmark.suite import Instance, Split, chosen, suite
from compare.grading.failures import Console
from compare.grading.grading import Grading, graded
from compare.grading.protocol import Protocol
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
    pool: Executor,
    protocol: Protocol,
    instances: list[Instance],
    store: Store,
    *,
    called: tuple[str, str],
    kind: str,
) -> Grading:
    """Run what is missing, and grade.

    Parameters
    ----------
    pool : Executor
    protocol : Protocol
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
    problems = {one.name: one.problem for one in instances}
    warm_up(problems)
    swarm(pool, protocol.runs(problems), problems, store, tell=Console())
    ladders, described = store.ladders(), store.instances()
    return graded(
        protocol,
        store.rows(),
        dict(store.traces()),
        proved={name: proved_gap(name, ladders[name]) for name in problems},
        features={
            name: features_of(problem, described[name]["features"])
            for name, problem in problems.items()
        },
        called=called,
        kind=kind,
    )


def proved_gap(name: str, record: LadderRecord) -> float:
    """Return how far the verified optimum of an instance is from the bound that gaps are measured against.

    Parameters
    ----------
    name : str
        The instance.
    record : LadderRecord
        Its bounds.

    Returns
    -------
    float

    Raises
    ------
    InputError
        If it has no optimum.
    """
    bound, _ = bound_of(record)
    optimum = record["ladder"]["family"]["seconds"]
    if bound is None or optimum is None:
        raise InputError(f"{name}: has no optimum: {record['ladder']['family']['note']}")
    return max(0.0, optimum / bound - 1.0)
