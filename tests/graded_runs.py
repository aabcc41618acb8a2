"""Graded runs for the tests: small ones, stored ones, optima that are solved once for all tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from conftest import climbed

from compare.benchmark.grade import Graded, Run, grade
from compare.benchmark.records.rows import TIMING_COLUMNS, Row
from compare.benchmark.records.store import Store
from formulations import FamilyOptimum, Problem, load

TOLERANCE = 1e-9  # relative: of families without a proof, whose optimum is a local solver's


def graded(problem: Problem, bound: float, coding: str, swarm: str, seed: int, budget: int) -> Graded:
    return grade(Run(problem.name, coding, swarm, seed, budget, 20), problem, bound)


def optimum(case: str) -> FamilyOptimum:
    """Optimum of a shipped case, solved once for all tests."""
    found = climbed(case).optimum
    assert found is not None
    return found


def unbeatable(case: str) -> float:
    """What no verified motion of the case's family can beat: a theorem, where there is a prover."""
    bound = climbed(case).bound
    assert bound is not None
    assert bound.status == "proved"
    return bound.least_verified


def without_times(row: Row) -> dict[str, Any]:
    """What is the same when a run is repeated: all columns but the measured times."""
    return {name: value for name, value in row.to_json().items() if name not in TIMING_COLUMNS}


def stored(folder: Path, count: int) -> Store:
    """A store with so many small runs of one swarm."""
    store = Store(folder)
    store.clear()
    problem = load("sr4c")
    for seed in range(count):
        store.add(graded(problem, 4.7, "shared", "random", seed, 30))
    return store
