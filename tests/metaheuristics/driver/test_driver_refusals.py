"""What the driver refuses: from an algorithm, from an objective, from its caller."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf, nan
from typing import Any

import numpy as np
import pytest
from loops import HI, LO, Array, Recorder, bowl, script

from metaheuristics import ObjectiveError, Status, Task, TaskError, minimise
from metaheuristics.driver.task import Moves
from metaheuristics.swarms.pso import pso

pytestmark = pytest.mark.filterwarnings("error")


def after_one_good_batch(then: Callable[[Task], Any]) -> Callable[[Task], Iterator[Any]]:
    """Yield four good points, then whatever ``then`` gives."""

    def algorithm(task: Task) -> Iterator[Any]:
        yield task.sample(4)
        while True:
            yield then(task)

    return algorithm


def with_entry(value: float) -> Callable[[Task], Array]:
    """Make a good batch of five with one bad entry in its last row."""

    def batch(task: Task) -> Array:
        x = task.sample(5)
        x[4, 1] = value
        return x

    return batch


def stop(message: str) -> Any:
    """Raise, where only an expression fits."""
    raise RuntimeError(message)


MISDEEDS: dict[str, tuple[Status, str, Callable[[Task], Any]]] = {
    "one point": (Status.wrong_shape, "(3,)", lambda t: t.sample(1)[0]),
    "transposed": (Status.wrong_shape, "(3, 5)", lambda t: t.sample(5).T[:, :5]),
    "no rows": (Status.wrong_shape, "(0, 3)", lambda t: t.sample(0)),
    "nothing": (Status.wrong_shape, "()", lambda t: None),
    "words": (Status.wrong_shape, "ValueError", lambda t: [["a", "b", "c"]]),
    "ragged": (Status.wrong_shape, "ValueError", lambda t: [[1.0, 2.0, 3.0], [1.0]]),
    "a hair over": (Status.out_of_box, "x[4, 1]", with_entry(np.nextafter(2.5, 3.0))),
    "a hair under": (Status.out_of_box, "x[4, 1]", with_entry(np.nextafter(2.0, 1.0))),
    "nan": (Status.not_finite, "x[4, 1] = nan", with_entry(nan)),
    "infinite": (Status.not_finite, "x[4, 1] = -inf", with_entry(-inf)),
    "raises": (Status.raised, "RuntimeError: two lines", lambda t: stop("two\n lines")),
    "writes to the box": (Status.raised, "read-only", lambda t: t.lo.__setitem__(0, -9.0)),
}


@pytest.mark.parametrize("misdeed", MISDEEDS)
def test_a_misdeed_has_its_status_and_keeps_what_was_found(misdeed: str) -> None:
    status, note, then = MISDEEDS[misdeed]
    f = Recorder(bowl)
    result = minimise(after_one_good_batch(then), f, LO, HI, budget=100, seed=0)  # type: ignore[arg-type]
    assert result.status is status
    assert note in result.note
    assert "\n" not in result.note
    assert result.evaluations == len(f.values) == 4
    assert result.fitness == min(f.values)
    assert result.trace_evaluations[-1] == 4


def test_returning_early_is_a_status() -> None:
    result = minimise(script([4]), bowl, LO, HI, budget=5, seed=0)
    assert result.status is Status.stopped_early
    assert result.evaluations == 4
    at_once = minimise(script([]), bowl, LO, HI, budget=5, seed=0)
    assert (at_once.status, at_once.evaluations, at_once.x) == (Status.stopped_early, 0, None)
    assert at_once.trace_evaluations.tolist() == [0]


def test_a_population_overwritten_after_its_evaluation_does_not_reach_the_answer() -> None:
    def overwriter(task: Task) -> Moves:
        x = task.sample(4)
        for _ in range(3):
            yield x
            x[:] = task.hi

    f = Recorder(bowl)
    result = minimise(overwriter, f, LO, HI, budget=12, seed=0)
    assert result.status is Status.ok
    assert np.array_equal(np.asarray(result.x), f.points[np.argmin(f.values)])
    assert bowl(f.points).tolist() == f.values


def test_an_algorithm_that_asks_for_more_than_the_budget_gets_none_of_it() -> None:
    def clinging(task: Task) -> Moves:
        for _ in range(5):
            try:
                while True:
                    yield task.sample(2)
            except Exception:
                pass

    for budget in (4, 5):
        f = Recorder(bowl)
        result = minimise(clinging, f, LO, HI, budget=budget, seed=0)
        assert result.status is Status.over_budget
        assert f"more than {budget}" in result.note
        assert result.evaluations == len(f.values) == budget


def test_an_error_of_the_objective_passes_through() -> None:
    def broken(x: Array) -> Array:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        minimise(pso, broken, LO, HI, budget=100, seed=0)


@pytest.mark.parametrize(
    ("f", "message"),
    [
        (lambda x: x, "shape (50, 3) for 50"),
        (lambda x: bowl(x)[:, None], "shape (50, 1)"),
        (lambda x: 1.0, "shape ()"),
        (lambda x: np.where(np.arange(len(x)) == 7, -inf, nan), "-inf for point 7"),
    ],
)
def test_an_objective_that_returns_no_fitness_is_refused(f: Any, message: str) -> None:
    with pytest.raises(ObjectiveError) as caught:
        minimise(pso, f, LO, HI, budget=100, seed=0)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"lo": [0.0, 2.0]}, "(2,) and (3,)"),
        ({"lo": 0.0, "hi": 1.0}, "() and ()"),
        ({"lo": [], "hi": []}, "(0,)"),
        ({"lo": [-1.0, 2.5, -7.0]}, "coordinate 1"),
        ({"lo": [-1.0, 2.0, nan]}, "coordinate 2"),
        ({"hi": [inf, 2.5, -1.0]}, "coordinate 0"),
        ({"lo": [-1.7e308, 2.0, -7.0], "hi": [1.7e308, 2.5, -1.0]}, "coordinate 0"),
        ({"budget": 0}, "got 0"),
        ({"budget": 1.5}, "got 1.5"),
        ({"seed": None}, "got None"),
        ({"seed": -1}, "got -1"),
    ],
)
def test_what_makes_no_task_is_refused(changed: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"lo": LO, "hi": HI, "budget": 100, "seed": 0}
    with pytest.raises(TaskError) as caught:
        minimise(pso, bowl, **(arguments | changed))
    assert message in str(caught.value)


def test_an_unknown_parameter_is_refused() -> None:
    with pytest.raises(TypeError, match="wings"):
        minimise(pso, bowl, LO, HI, budget=100, seed=0, wings=2)
