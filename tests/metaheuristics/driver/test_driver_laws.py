"""What holds for every algorithm of the registry, whatever it does."""

from __future__ import annotations

from math import inf, nan
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from loops import HI, LO, NAMES, Array, Recorder, bowl, holed, run_entry, same

from metaheuristics import ALGORITHMS, Status, Task, minimise
from metaheuristics.driver.task import Moves

pytestmark = pytest.mark.filterwarnings("error")


@pytest.mark.parametrize("budget", [1, 7, 49, 50, 51, 100, 333])
@pytest.mark.parametrize("name", NAMES)
def test_the_budget_is_met_to_the_evaluation(name: str, budget: int) -> None:
    f = Recorder(bowl)
    result = run_entry(name, f, budget=budget)
    assert result.status is Status.ok
    assert result.evaluations == budget == len(f.values)
    assert result.trace_evaluations[-1] == budget


@pytest.mark.parametrize("name", NAMES)
@given(budget=st.integers(1, 150), population=st.integers(1, 40), seed=st.integers(0, 2**32))
@settings(max_examples=10, deadline=None)
def test_the_answer_is_the_first_best_of_all_evaluated_points_of_the_box(
    name: str, budget: int, population: int, seed: int
) -> None:
    f = Recorder(holed)
    changed = {"population": population} if "population" in ALGORITHMS[name].parameters else {}
    result = run_entry(name, f, budget=budget, seed=seed, **changed)
    assert len(f.values) == budget
    assert np.all((f.points >= LO) & (f.points <= HI))
    assert result.fitness == min(f.values)
    if result.fitness < inf:
        assert result.status is Status.ok
        assert result.x is not None
        assert np.array_equal(result.x, f.points[np.argmin(f.values)])
    else:
        assert result.status is Status.no_feasible_point
        assert result.x is None


@pytest.mark.parametrize("name", NAMES)
def test_same_seed_same_result_and_another_seed_another(name: str) -> None:
    assert same(run_entry(name, seed=5), run_entry(name, seed=5))
    assert same(run_entry(name, seed=5), run_entry(name, seed=np.random.SeedSequence(5)))
    assert not same(run_entry(name, seed=5), run_entry(name, seed=6))


def test_a_seed_sequence_that_has_spawned_is_the_same_seed() -> None:
    def spawner(task: Task) -> Moves:
        while True:
            child = task.rng.spawn(1)[0]
            yield task.lo + (task.hi - task.lo) * child.random((4, task.dim))

    seed = np.random.SeedSequence(3, spawn_key=(2,))
    first = minimise(spawner, bowl, LO, HI, budget=20, seed=seed)
    seed.spawn(5)
    assert same(first, minimise(spawner, bowl, LO, HI, budget=20, seed=seed))


@pytest.mark.parametrize("name", NAMES)
def test_nothing_feasible_is_a_status_without_a_warning(name: str) -> None:
    result = run_entry(name, lambda x: np.full(len(x), inf))
    assert result.status is Status.no_feasible_point
    assert result.x is None
    assert result.fitness == inf
    assert result.evaluations == 700
    assert result.trace_evaluations.tolist() == [700]
    assert result.trace_best.tolist() == [inf]


@pytest.mark.parametrize("name", NAMES)
def test_an_infeasible_half_does_not_hide_the_optimum(name: str) -> None:
    result = run_entry(name, holed, budget=3000)
    assert result.status is Status.ok
    assert result.fitness < 0.05


@pytest.mark.parametrize("name", NAMES)
def test_nan_counts_as_infeasible(name: str) -> None:
    assert same(
        run_entry(name, holed), run_entry(name, lambda x: np.where(x[:, 0] > 1.0, nan, bowl(x)))
    )


@pytest.mark.parametrize("name", NAMES)
def test_an_objective_that_spoils_its_argument_or_reuses_its_buffer_changes_nothing(
    name: str,
) -> None:
    buffer = np.empty(1000)

    def rude(x: Array) -> Array:
        values = buffer[: len(x)]
        values[:] = bowl(x)
        x[:] = nan
        return values

    assert same(run_entry(name), run_entry(name, rude))


@pytest.mark.parametrize("name", NAMES)
def test_boxes_one_rounding_wide_are_never_left(name: str) -> None:
    lo = np.array([-0.1, 1.0, 1e-300, -3.3])
    hi = np.array([0.7, np.nextafter(1.0, 2.0), 2e-300, np.nextafter(-3.3, 0.0)])
    algorithm = ALGORITHMS[name]
    result = minimise(
        algorithm.function,
        lambda x: -x.sum(1),
        lo,
        hi,
        budget=500,
        seed=0,
        **algorithm.parameters,
    )
    assert (result.status, result.note) == (Status.ok, "")


class LargestDraw:
    """A generator stuck at the largest number `random` can give."""

    def random(self, size: tuple[int, ...]) -> Array:
        """Return 1 - 2^-53 everywhere."""
        return np.full(size, np.nextafter(1.0, 0.0))


@given(lo=st.floats(-1e300, 1e300), width=st.floats(1e-300, 1e300))
def test_the_largest_draw_does_not_round_past_the_box(lo: float, width: float) -> None:
    hi = lo + width
    assume(lo < hi)
    rng: Any = LargestDraw()
    task = Task(np.array([lo]), np.array([hi]), rng, 1, lambda: 0)
    assert lo <= task.sample(1)[0, 0] <= hi
