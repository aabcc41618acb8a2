"""What an item measures of a task: repeated swarm runs, the certified optimum, what given times do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.benchmark.grade import Graded, Run, durations_of, grade
from compare.benchmark.suite import Budget
from compare.papers.printed_motions import used_most
from formulations import FAMILIES, Problem, check, family_bound
from formulations.problem.arrays import Array


def trials(problem: Problem, swarm: str, budget: Budget, runs: int) -> list[Graded]:
    """Runs with seeds 0, 1, ... as the papers have it: infeasible = worst fitness. Each is judged."""
    size = budget.evaluations, budget.population
    return [
        grade(Run(problem.name, "shared", swarm, seed, *size), problem, None, "none")
        for seed in range(runs)
    ]


def summary(found: Sequence[Graded]) -> dict[str, Any]:
    """Verified times of all runs [s], and the durations of the median one (the lower of two)."""
    solved = sorted((g.row.seconds, g.run.seed) for g in found if g.row.seconds is not None)
    by_seed = {g.run.seed: durations_of(g.row).tolist() for g in found}
    median = solved[(len(solved) - 1) // 2] if solved else None
    return {
        "runs": len(found),
        "seconds": [seconds for seconds, _ in solved],
        "median": None if median is None else median[0],
        "durations": None if median is None else by_seed[median[1]],
    }


def least(problem: Problem) -> dict[str, Any]:
    """The family's optimum: certified bound, best verified time, its durations [s].

    Proved to a gap and not for a time, to be the same on every machine.
    """
    found = family_bound(problem, gap=1e-6)
    durations = None if found.durations is None else found.durations.tolist()
    return {"bound": found.seconds, "optimum": found.upper, "durations": durations}


def judged(problem: Problem, durations: ArrayLike) -> dict[str, Any]:
    """What the independent check says of the spline with these durations."""
    times: Array = np.asarray(durations, dtype=np.float64)
    verdict = check(problem, FAMILIES[problem.family].trajectory(problem, times))
    return {
        "durations": times.tolist(),
        "seconds": verdict.seconds,
        "keeps": verdict.feasible,
        "stretch": verdict.stretch,
        "most": used_most(verdict),
        "faults": list(verdict.faults),
    }


def listed(values: Sequence[object]) -> str:
    """1, 2 and 5."""
    words = [str(value) for value in values]
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def triple(numbers: Sequence[float], digits: int = 3) -> str:
    """1.000, 2.000, 5.000."""
    return ", ".join(f"{n:.{digits}f}" for n in numbers)


def percent(share: float, digits: int = 1) -> str:
    """12.3 %."""
    return f"{100.0 * share:.{digits}f}\u00a0%"
