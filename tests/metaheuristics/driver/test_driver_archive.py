"""The archive: each improvement at its evaluation, progress, and time."""

from __future__ import annotations

from math import inf
from time import sleep

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from loops import HI, LO, Array, Recorder, bowl, script

from metaheuristics import Status, Task, minimise
from metaheuristics.driver.task import Moves

pytestmark = pytest.mark.filterwarnings("error")


@given(
    sizes=st.lists(st.integers(1, 6), min_size=1, max_size=8),
    values=st.lists(st.sampled_from([inf, 3.0, 2.0, 1.0, 0.0, -1.0]), min_size=48, max_size=48),
    budget=st.integers(1, 48),
)
def test_the_trace_has_each_improvement_at_its_evaluation(
    sizes: list[int], values: list[float], budget: int
) -> None:
    stream = iter(values)
    f = Recorder(lambda x: np.array([next(stream) for _ in x]))
    result = minimise(script(sizes), f, LO, HI, budget=budget, seed=0)

    used = min(budget, sum(sizes))
    trace, best, best_x = [], inf, None
    for i in range(used):
        if values[i] < best:
            best, best_x = values[i], f.points[i]
            trace.append((i + 1, best))
    if not trace or trace[-1][0] != used:
        trace.append((used, best))
    assert len(f.values) == result.evaluations == used
    assert list(zip(result.trace_evaluations, result.trace_best, strict=True)) == trace
    assert result.fitness == best
    assert np.array_equal(np.asarray(result.x), np.asarray(best_x))
    if sum(sizes) < budget:
        assert result.status is Status.stopped_early
    else:
        assert result.status is (Status.ok if best < inf else Status.no_feasible_point)


def test_progress_is_the_share_of_evaluations_used() -> None:
    seen = []

    def algorithm(task: Task) -> Moves:
        for n in (3, 5, 8):
            seen.append(task.progress)
            yield task.sample(n)

    minimise(algorithm, bowl, LO, HI, budget=16, seed=0)
    assert seen == [0.0, 3 / 16, 8 / 16]


def test_time_is_booked_to_whoever_spent_it() -> None:
    def slow(task: Task) -> Moves:
        while True:
            sleep(0.05)
            yield task.sample(1)

    def slow_bowl(x: Array) -> Array:
        sleep(0.05)
        return bowl(x)

    one = minimise(slow, bowl, LO, HI, budget=2, seed=0)
    other = minimise(script([1, 1]), slow_bowl, LO, HI, budget=2, seed=0)
    assert one.seconds_algorithm >= 0.1 > 0.05 > one.seconds_objective
    assert other.seconds_objective >= 0.1 > 0.05 > other.seconds_algorithm
