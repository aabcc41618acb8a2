"""Whatever a plug-in claims, raises, yields or returns: a row with a status, and text that can be kept."""

from __future__ import annotations

import csv
import io
import json
from typing import Any

import numpy as np
import poison
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from loops import HI, LO, Recorder, bowl

from metaheuristics import Result, Status, Task, apart, minimise
from metaheuristics.driver.task import Moves, Search

pytestmark = pytest.mark.filterwarnings("error")


def run(search: Search, f: Any = bowl, *, budget: int = 20, **parameters: Any) -> Result:
    return minimise(search, f, LO, HI, budget=budget, seed=1, **parameters)


def assert_can_be_kept(result: Result) -> None:
    """A status of the list, and a note that any file, table or screen takes on one line."""
    assert type(result.status) is Status
    assert type(result.note) is str
    assert result.note.isprintable()
    assert len(result.note) <= 400
    table = io.StringIO()
    csv.writer(table).writerow([result.status, result.note])
    (row,) = csv.reader(io.StringIO(table.getvalue()))
    assert row == [result.status.value, result.note]
    text = json.dumps({"status": result.status, "note": result.note}, ensure_ascii=False)
    assert json.loads(text.encode().decode())["note"] == result.note


@pytest.mark.parametrize("what", poison.EXCEPTIONS)
def test_any_exception_is_a_status_with_a_reason(what: str) -> None:
    f = Recorder(bowl)
    result = run(poison.raiser, f, what=what)
    assert_can_be_kept(result)
    assert result.status in (Status.raised, Status.exited)
    assert (result.status is Status.exited) == what.startswith("SystemExit")
    assert result.note
    assert result.evaluations == len(f.values) == 4
    assert result.fitness == min(f.values)


@pytest.mark.parametrize("what", poison.CLAIMS)
def test_any_claim_that_is_no_number_is_a_false_one(what: str) -> None:
    result = run(poison.claimer, what=what)
    assert_can_be_kept(result)
    assert result.status is Status.false_fitness
    assert "claims" in result.note
    assert result.evaluations == 4


@pytest.mark.parametrize("what", poison.RETURNED)
def test_whatever_is_returned_without_a_claim_is_only_early(what: str) -> None:
    result = run(poison.returner, what=what)
    assert_can_be_kept(result)
    assert result.status in (Status.stopped_early, Status.false_fitness)
    assert result.evaluations == 4


@pytest.mark.parametrize("what", poison.POINTS)
def test_any_population_that_is_none_is_a_wrong_shape(what: str) -> None:
    result = run(poison.pointer, what=what)  # type: ignore[arg-type]
    assert_can_be_kept(result)
    assert result.status is Status.wrong_shape
    assert result.evaluations == 4


@pytest.mark.parametrize("what", poison.SPOILS)
def test_an_array_of_fitness_made_into_something_else_is_a_changed_input(what: str) -> None:
    result = run(poison.spoiler, what=what)
    assert_can_be_kept(result)
    assert (result.status, result.evaluations) == (Status.changed_input, 4)


def test_a_box_made_into_something_else_is_a_changed_input() -> None:
    result = run(poison.box_spoiler)
    assert_can_be_kept(result)
    assert result.status is Status.changed_input


@pytest.mark.parametrize("what", ["a lone surrogate", "__str__ raises", "KeyboardInterrupt"])
def test_the_same_exceptions_in_a_process_of_its_own(what: str) -> None:
    here, there = run(poison.raiser, what=what), run(apart(poison.raiser, seconds=30.0), what=what)
    assert_can_be_kept(there)
    assert (there.status, there.note, there.evaluations) == (here.status, here.note, here.evaluations)


_ODD = [*poison.CLAIMS.values(), *poison.RETURNED.values()]
_PLAIN = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.complex_numbers(),
    st.text(st.characters(categories=["Lu", "Cs", "Cc", "Zl", "Zp"]), max_size=8),
    st.binary(max_size=8),
)
_NESTED = st.recursive(
    _PLAIN, lambda inner: st.lists(inner, max_size=3) | st.tuples(inner, inner), max_leaves=4
)
# made in the test alone: hypothesis, too, looks at what it draws
_ANYTHING = st.sampled_from(_ODD) | _NESTED.map(lambda value: lambda: value)
_BUILT_IN = st.sampled_from([ValueError, SystemExit, KeyboardInterrupt, OSError, UserWarning])
_RAISED = st.sampled_from([*poison.EXCEPTIONS.values()]) | st.builds(
    lambda kind, value: lambda: kind(value()), _BUILT_IN, _ANYTHING
)


@given(
    claim=_ANYTHING,
    raised=st.none() | _RAISED,
    points=st.none() | _ANYTHING,
    budget=st.integers(1, 9),
)
@settings(max_examples=300)
@pytest.mark.filterwarnings("default")  # what numpy says of odd arrays is not the law here
def test_whatever_a_plug_in_does_its_result_can_be_kept(
    claim: Any, raised: Any, points: Any, budget: int
) -> None:
    def plug_in(task: Task) -> Moves:
        yield task.sample(4)
        if points is not None:
            yield points()
        if raised is not None:
            raise raised()
        return task.lo, claim()

    f = Recorder(bowl)
    result = run(plug_in, f, budget=budget)
    assert_can_be_kept(result)
    assert result.evaluations == len(f.values) <= budget
    assert result.fitness == min(f.values)


@pytest.mark.parametrize("number", [np.array(1e9), np.array([1e9]), np.float32(1e9), "1e9", 10**9])
def test_a_claim_is_one_number_in_any_form(number: Any) -> None:
    def claims(task: Task) -> Moves:
        yield task.sample(4)
        return task.lo, number

    assert run(claims).status is Status.stopped_early
