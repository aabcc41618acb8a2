"""Run what a grading needs and the store does not have; then grade from the store alone."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass

from compare.benchmark.ladders import LadderRecord, ladder_record
from compare.benchmark.records.proof_cache import proof_key
from compare.benchmark.records.store import Store
from compare.benchmark.run import each, swarm, warm_up
from compare.benchmark.statistics import bound_of
from compare.grading.failures import Console
from compare.grading.grading import Grading, graded
from compare.grading.protocol import Protocol
from compare.grading.reasons import Features, features_of
from formulations import CASES, InputError, Problem, ladder, load


@dataclass(frozen=True)
class Chosen:
    """The instances of a grading: problems and features by name, and what they are called."""

    problems: dict[str, Problem]
    features: dict[str, Features]
    kind: str


def chosen_instances(names: str | None) -> Chosen:
    """Return the instances that a swarm is graded on.

    Parameters
    ----------
    names : str or None
        Names of shipped cases, or problem files, with commas between them; None: the held-out instances.

    Returns
    -------
    Chosen

    Raises
    ------
    InputError
        There is none of a name.
    """
    kind = "held-out instances" if names is None else "instances"
    listed = (
        list(CASES) if names is None else [name.strip() for name in names.split(",") if name.strip()]
    )
    if not listed:
        raise InputError("--cases: none given")
    problems: dict[str, Problem] = {}
    for name in listed:
        problem = load(name)
        if problem.name in problems:
            raise InputError(f"--cases: two instances are called {problem.name}")
        problems[problem.name] = problem
    return Chosen(problems, {name: features_of(one) for name, one in problems.items()}, kind)


def run_and_grade(
    pool: Executor,
    protocol: Protocol,
    problems: Mapping[str, Problem],
    store: Store,
    *,
    features: Mapping[str, Features],
    called: tuple[str, str],
    kind: str,
) -> Grading:
    """Run what is missing, and grade.

    Parameters
    ----------
    pool : Executor
    protocol : Protocol
    problems : mapping of str to Problem
        By instance.
    store : Store
        Where runs and bounds are kept; what it has is not computed again.
    features : mapping of str to mapping of str to float
        By instance.
    called : (str, str)
        How the user named the swarm and the other one.
    kind : str
        What the instances are called.

    Returns
    -------
    Grading
    """
    instances = dict(problems)
    prove(pool, instances, store)
    warm_up(instances)
    swarm(pool, protocol.runs(instances), instances, store, tell=Console())
    ladders = store.ladders()
    return graded(
        protocol,
        store.rows(),
        dict(store.traces()),
        proved={name: proved_gap(name, ladders[name]) for name in instances},
        features=features,
        called=called,
        kind=kind,
    )


def prove(pool: Executor, problems: dict[str, Problem], store: Store) -> None:
    """Find optimum and certified bound of each problem's family, where the store does not have them.

    Parameters
    ----------
    pool : Executor
    problems : dict of str to Problem
        By instance.
    store : Store
    """
    keys = {name: proof_key(problem, certify=True) for name, problem in problems.items()}
    calls = []
    for name, problem in sorted(problems.items(), key=lambda item: -item[1].n_segments):
        known = store.proved(keys[name])
        if known is None:
            calls.append((name, problem))
        else:
            store.write_ladder(name, known)
    if calls:
        for name, found in each(pool, "optima", _optimum, calls):
            store.write_ladder(name, found, keys[name])


def _optimum(name: str, problem: Problem) -> tuple[str, LadderRecord]:
    return name, ladder_record(ladder(problem, rungs=("family", "family_lower")))


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
