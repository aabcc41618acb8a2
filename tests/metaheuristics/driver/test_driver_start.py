"""A search that is handed points to start from begins with them, and they count."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from loops import CENTRE, HI, LO, Recorder, bowl, holed, run_entry, same

from metaheuristics import ALGORITHMS, Status, Task, TaskError, apart, minimise
from metaheuristics.driver.task import Moves
from metaheuristics.swarms.pso import pso

pytestmark = pytest.mark.filterwarnings("error")

OWN = [name for name, entry in ALGORITHMS.items() if not entry.libraries]
OTHERS = [name for name, entry in ALGORITHMS.items() if entry.libraries]
START = np.array([[0.5, 2.2, -3.0], [2.9, 2.4, -6.0], CENTRE])


def points(name: str, **given: Any) -> Recorder:
    f = Recorder(holed)
    assert run_entry(name, f, **given).status is Status.ok
    return f


@pytest.mark.parametrize("name", OWN)
def test_every_swarm_begins_with_its_start_and_draws_the_rest_as_without_one(name: str) -> None:
    first, plain = points(name, start=START).batches[0], points(name).batches[0]
    assert len(first) == len(plain) > len(START)
    np.testing.assert_array_equal(first[:3], START)
    np.testing.assert_array_equal(first[3:], plain[3:])
    assert not np.array_equal(plain[:3], START)


@pytest.mark.parametrize("name", OWN)
def test_no_start_is_an_empty_start(name: str) -> None:
    assert same(run_entry(name), run_entry(name, start=np.empty((0, 3))))


@pytest.mark.parametrize("name", OTHERS)
def test_an_adapter_that_takes_no_start_says_so_before_anything_is_evaluated(name: str) -> None:
    pytest.importorskip(
        {"minionpy": "minionpy", "cmaes": "cmaes"}.get(ALGORITHMS[name].libraries[0], "scipy")
    )
    f = Recorder(bowl)
    result = run_entry(name, f, start=START)
    assert result.status is Status.ignored_start
    assert "3 to start from" in result.note
    assert (result.evaluations, f.values) == (0, [])


def test_a_small_population_takes_the_first_points() -> None:
    first = points("pso", start=START, population=2).batches[0]
    np.testing.assert_array_equal(first, START[:2])


def test_the_start_counts_and_its_best_is_the_first_best() -> None:
    result = run_entry("pso", start=START, budget=700)
    assert result.evaluations == 700
    assert (result.trace_evaluations[-2], result.fitness) == (3, 0.0)
    np.testing.assert_array_equal(result.x, CENTRE)


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(OWN), st.integers(0, 2**32 - 1), st.integers(1, 6))
def test_no_search_ends_worse_than_the_best_point_it_started_from(name: str, seed: int, m: int) -> None:
    start = LO + (HI - LO) * np.random.default_rng(seed).random((m, 3))
    assert run_entry(name, holed, budget=200, start=start).fitness <= holed(start).min()


def rewriting(task: Task) -> Moves:
    task.start[0] = task.lo
    while True:
        yield task.first(5)


def second_first(task: Task) -> Moves:
    yield task.start[::-1]
    while True:
        yield task.sample(5)


def one_by_one(task: Task) -> Moves:
    for point in task.start:
        yield point[None]
    while True:
        yield task.sample(5)


def test_the_start_cannot_be_written_to_or_reordered_but_may_be_asked_for_one_by_one() -> None:
    def status(search: Any) -> tuple[Status, int]:
        result = minimise(search, bowl, LO, HI, budget=20, seed=0, start=START)
        return result.status, result.evaluations

    assert status(rewriting) == (Status.raised, 0)
    assert status(second_first) == (Status.ignored_start, 0)
    assert status(one_by_one) == (Status.ok, 20)


def test_in_a_process_of_its_own_a_search_has_the_same_start() -> None:
    here, there = Recorder(bowl), Recorder(bowl)
    minimise(pso, here, LO, HI, budget=150, seed=1, start=START)
    result = minimise(apart(pso, seconds=30.0), there, LO, HI, budget=150, seed=1, start=START)
    assert result.isolated
    np.testing.assert_array_equal(here.points, there.points)
    np.testing.assert_array_equal(there.points[:3], START)
    ignored = minimise(apart(second_first, seconds=30.0), bowl, LO, HI, budget=9, seed=1, start=START)
    assert (ignored.status, ignored.evaluations) == (Status.ignored_start, 0)


@pytest.mark.parametrize(
    ("start", "words"),
    [
        ([0.0, 2.2, -3.0], r"start needs shape \(m, 3\), got \(3,\)"),
        ([[0.0, 2.2]], r"start needs shape \(m, 3\), got \(1, 2\)"),
        ([START[0], [0.0, 2.6, -3.0]], r"start\[1, 1\] = 2.6 lies outside the box \[2.0, 2.5\]"),
        ([[np.nan, 2.2, -3.0]], r"start\[0, 0\] = nan"),
    ],
)
def test_what_is_no_start_is_refused_in_words(start: Any, words: str) -> None:
    with pytest.raises(TaskError, match=words):
        minimise(pso, bowl, LO, HI, budget=9, seed=0, start=start)
