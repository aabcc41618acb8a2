"""A flock that contracts to zero is called drawn to zero; PSO and random search are not."""

from __future__ import annotations

import numpy as np
import pytest
from made_cells import cell
from small_problems import variants

from compare.benchmark.coordinates import seen_in
from compare.benchmark.objective import Objective, search_box
from compare.benchmark.protocol import Coordinates
from compare.grading.cells import Cell
from compare.grading.zero import DrawnToZero, drawn_to_zero
from metaheuristics import ALGORITHMS, Task, minimise
from metaheuristics.driver.task import Moves

SEEDS = 9


def contracting(task: Task, *, population: int = 20) -> Moves:
    """Every move ends nearer to zero."""
    x = task.sample(population)
    while True:
        fitness = yield x
        best = x[fitness.argmin()]
        x = task.clip(task.rng.random(x.shape) * (best + task.rng.normal(size=x.shape) * x))


def moved(search: object) -> DrawnToZero:
    cells: dict[tuple[str, str, Coordinates], Cell] = {}
    for name, problem in variants(10).items():
        objective, (lo, hi) = Objective(problem, stretch=True), search_box(problem)
        for seen in Coordinates:
            task = seen_in(seen, objective, lo, hi)
            runs = [
                minimise(search, *task, budget=400, seed=seed, population=20).fitness  # type: ignore[arg-type]
                for seed in range(SEEDS)
            ]
            cells[name, "it", seen] = cell(np.log10(np.array(runs)))
    return drawn_to_zero(cells, "it", list(variants(10)))


def test_a_flock_that_contracts_to_zero_is_found() -> None:
    found = moved(contracting)
    assert found.drawn
    assert found.sentence.startswith("It is drawn to zero, and gains from it here")


@pytest.mark.parametrize("name", ["pso", "mipso", "random"])
def test_a_search_that_does_not_know_zero_is_not_accused(name: str) -> None:
    found = moved(ALGORITHMS[name].function)
    assert not found.drawn
    assert "not drawn to zero" in found.sentence or "no sign" in found.sentence


def test_what_rounding_does_in_one_direction_is_no_accusation() -> None:
    """Common random numbers make the least difference significant; it is negligible all the same."""
    cells: dict[tuple[str, str, Coordinates], Cell] = {}
    for k in range(12):
        losses = np.random.default_rng(k).normal(size=11)
        for seen, shift in zip(
            Coordinates, (0.0, 0.0, 1e-12), strict=True
        ):  # printed, mirrored, offset
            cells[f"i{k}", "it", seen] = cell(losses + shift)
    found = drawn_to_zero(cells, "it", [f"i{k}" for k in range(12)])
    assert found.moved[0].coordinates is Coordinates.offset
    assert found.moved[0].effect.p < 0.05
    assert not found.drawn
