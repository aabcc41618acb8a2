"""PSO against itself and against half of itself, at the size of a grading: 36 problems, 31 seeds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from made_cells import cell
from small_problems import variants

from compare.benchmark.objective import Objective, search_box
from compare.grading.contest import SwarmVerdict, contest
from metaheuristics import ALGORITHMS, minimise

SEEDS, REPETITIONS, BUDGET = 31, 20, 800


def losses(problem: Any, seeds: range, budget: int) -> np.ndarray:
    """Logarithms of the time above the best that CMA-ES finds."""
    objective, (lo, hi) = Objective(problem, stretch=True), search_box(problem)
    best = ALGORITHMS["cma-es"]
    least = minimise(best.search(), objective, lo, hi, budget=3000, seed=0, **best.parameters).fitness
    pso = ALGORITHMS["pso"].function
    found = [
        minimise(pso, objective, lo, hi, budget=budget, seed=seed, population=20).fitness
        for seed in seeds
    ]
    return np.log10(np.maximum(np.array(found) / least - 1.0, 1e-7))


@pytest.mark.long
def test_pso_is_equal_to_itself_20_of_20_times_and_half_its_budget_is_worse() -> None:
    problems = variants(36)
    whole = {name: losses(one, range(3 * SEEDS), BUDGET) for name, one in problems.items()}
    half = {
        name: cell(losses(one, range(500, 500 + SEEDS), BUDGET // 2)) for name, one in problems.items()
    }
    verdicts = []
    for repetition in range(REPETITIONS):  # two sets of runs without a run in common
        rng = np.random.default_rng(repetition)
        mixed = {name: rng.permutation(each) for name, each in whole.items()}
        mine = {name: cell(each[:SEEDS]) for name, each in mixed.items()}
        other = {name: cell(each[SEEDS : 2 * SEEDS]) for name, each in mixed.items()}
        verdicts.append(contest(mine, other).verdict)
    assert verdicts == [SwarmVerdict.equal] * REPETITIONS
    against = {name: cell(each[:SEEDS]) for name, each in whole.items()}
    found = contest(half, against)
    assert found.verdict is SwarmVerdict.worse
    assert found.counts[0] == 0
    assert found.counts[1] > 18
