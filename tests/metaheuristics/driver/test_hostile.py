"""What an optimiser may do to the driver, in each form it may come in, and what its row then says."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Callable
from typing import Any

import hostile
import numpy as np
import pytest
from loops import HI, LO, Array, Recorder, bowl

from metaheuristics import Result, Status, Task, algorithm, apart, minimise
from metaheuristics.driver.plug_in import search_of
from metaheuristics.driver.task import Fault, Moves, Search

pytestmark = pytest.mark.filterwarnings("error")


def run(search: Search, f: Callable[[Array], Array] = bowl, *, budget: int = 20) -> Result:
    return minimise(search, f, LO, HI, budget=budget, seed=1)


# optimiser, status, in the note, evaluations of 20
MISDEEDS: dict[str, tuple[Any, Status, str, int]] = {
    "claims less than it found": (hostile.Flatterer, Status.false_fitness, "best evaluated", 20),
    "claims zero": (hostile.liar, Status.false_fitness, "claims 0;", 20),
    "claims NaN": (hostile.early_liar, Status.false_fitness, "claims nan", 1),
    "claims a word": (hostile.nonsense, Status.false_fitness, "'best'", 1),
    "evaluates once too often": (hostile.glutton, Status.over_budget, "more than 20", 20),
    "asks for too large a batch": (hostile.gulper, Status.over_budget, "21", 20),
    "paints its fitness": (hostile.painter, Status.changed_input, "fitness", 4),
    "paints f's fitness": (hostile.painter_called, Status.changed_input, "fitness", 2),
    "widens the box": (hostile.vandal, Status.changed_input, "box", 20),
    "draws from numpy": (hostile.gambler, Status.global_random, "task.rng", 20),
    "draws from random": (hostile.dicer, Status.global_random, "task.rng", 20),
    "seeds numpy": (hostile.reseeder, Status.global_random, "task.rng", 20),
    "exits": (hostile.quitter, Status.exited, "SystemExit: 7", 4),
    "exits from a function": (hostile.quitter_called, Status.exited, "SystemExit: 7", 1),
    "raises in a function": (hostile.raiser, Status.raised, "ZeroDivisionError", 1),
    "leaves the box": (hostile.wanderer, Status.out_of_box, "x[0, 0]", 1),
    "asks for two coordinates": (hostile.poser, Status.wrong_shape, "(1, 2)", 0),
}


@pytest.mark.parametrize("misdeed", MISDEEDS)
def test_a_misdeed_is_named_and_what_was_found_is_kept(misdeed: str) -> None:
    optimiser, status, note, evaluations = MISDEEDS[misdeed]
    f = Recorder(bowl)
    result = run(search_of(optimiser), f)
    assert result.status is status
    assert note in result.note
    assert "\n" not in result.note
    assert result.evaluations == len(f.values) == evaluations
    assert result.fitness == min(f.values, default=np.inf)


@pytest.mark.parametrize("misdeed", ["claims zero", "draws from numpy"])
def test_a_misdeed_has_the_same_name_in_a_process_of_its_own(misdeed: str) -> None:
    optimiser, status, note, evaluations = MISDEEDS[misdeed]
    result = run(apart(search_of(optimiser), seconds=30.0))
    assert (result.status, result.evaluations) == (status, evaluations)
    assert note in result.note


def test_what_exits_at_once_ends_its_own_process_alone() -> None:
    result = run(apart(hostile.crasher, seconds=30.0))
    assert (result.status, result.evaluations) == (Status.exited, 4)
    assert "exit code 9" in result.note


@pytest.mark.parametrize("optimiser", [hostile.sleeper, hostile.late_sleeper])
def test_what_hangs_is_ended_at_its_time_limit(optimiser: Search) -> None:
    started = time.monotonic()
    result = run(apart(optimiser, seconds=0.3))
    assert result.status is Status.timed_out
    assert "0.3 s" in result.note
    assert result.evaluations == (4 if optimiser is hostile.sleeper else 20)
    assert time.monotonic() - started < 20.0


def test_a_process_of_its_own_finds_the_same_points() -> None:
    for search in (hostile.honest, search_of(hostile.called)):
        here, there = Recorder(bowl), Recorder(bowl)
        mine, other = run(search, here), run(apart(search, seconds=30.0), there)
        assert np.array_equal(here.points, there.points)
        assert mine.status is other.status is Status.ok


def test_a_process_of_its_own_takes_parameters_and_refuses_unknown_ones() -> None:
    pso = algorithm("pso").function
    here, there = Recorder(bowl), Recorder(bowl)
    for f, search in ((here, pso), (there, apart(pso, seconds=30.0))):
        minimise(search, f, LO, HI, budget=50, seed=3, population=7)
    assert np.array_equal(here.points, there.points)
    with pytest.raises(TypeError, match="wings"):
        minimise(apart(pso, seconds=30.0), bowl, LO, HI, budget=50, seed=3, wings=2)


@pytest.mark.parametrize("optimiser", [hostile.honest, hostile.Asked, hostile.called])
def test_an_honest_optimiser_is_ok_in_any_form(optimiser: Any) -> None:
    for budget in (1, 7, 20):
        f = Recorder(bowl)
        result = run(search_of(optimiser), f, budget=budget)
        assert (result.status, result.note) == (Status.ok, "")
        assert result.evaluations == len(f.values) == budget
        assert result.fitness == min(f.values)


def test_a_true_claim_that_comes_early_is_only_early() -> None:
    def early(f: Any, lo: Array, hi: Array, budget: int, rng: Any) -> Any:
        return lo, f(lo)

    result = run(search_of(early))
    assert (result.status, result.evaluations) == (Status.stopped_early, 1)


def test_the_global_generators_are_as_they_were_and_seeded_by_the_run() -> None:
    np.random.seed(5)
    random.seed(5)
    expected = np.random.random(3).tolist(), random.random()
    np.random.seed(5)
    random.seed(5)
    first = run(hostile.gambler)
    assert (np.random.random(3).tolist(), random.random()) == expected
    again = run(hostile.gambler)
    assert first.fitness == again.fitness
    assert minimise(hostile.gambler, bowl, LO, HI, budget=20, seed=2).fitness != first.fitness


def test_a_population_changed_by_another_thread_is_evaluated_as_it_was_checked() -> None:
    def racer(task: Task) -> Moves:
        x = task.sample(4)
        f.x = x
        while True:
            yield x

    class Spoiled(Recorder):
        x: Array

        def __call__(self, x: Array) -> Array:
            values = super().__call__(x)
            self.x[:] = 1e9  # what a thread of the algorithm's could do meanwhile
            return values

    f = Spoiled(bowl)
    result = run(racer, f, budget=4)
    assert np.array_equal(np.asarray(result.x), f.points[np.argmin(f.values)])


def test_an_optimiser_may_call_its_objective_from_many_threads() -> None:
    f = Recorder(bowl)
    result = run(search_of(hostile.crowd), f, budget=400)
    assert (result.status, result.note, result.evaluations) == (Status.ok, "", 400)


def test_no_thread_is_left_behind() -> None:
    before = threading.active_count()
    for optimiser in (hostile.called, hostile.glutton, hostile.raiser, hostile.wanderer):
        run(search_of(optimiser))
    for name in ("de", "nelder-mead", "slsqp"):
        entry = algorithm(name)
        minimise(entry.function, bowl, LO, HI, budget=200, seed=0, **entry.parameters)
    assert threading.active_count() == before


def test_an_error_of_the_objective_is_no_fault_of_a_plug_in() -> None:
    def broken(x: Array) -> Array:
        raise ZeroDivisionError

    before = threading.active_count()
    with pytest.raises(ZeroDivisionError):
        run(search_of(hostile.called), broken)
    assert threading.active_count() == before


def test_an_algorithm_cannot_call_itself_ok() -> None:
    def forger(task: Task) -> Moves:
        yield task.sample(2)
        raise Fault(Status.ok, "all is well")

    result = run(forger)
    assert (result.status, result.evaluations) == (Status.stopped_early, 2)
