"""Problems are equal by what they hold; messages name joints, and speak in the unit that was written."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

from formulations import CASES, InputError, Limits, Problem, load, plan

DEG = math.pi / 180.0
NAMES = ("shoulder", "elbow")


@pytest.mark.parametrize("case", CASES)
def test_a_problem_equals_itself_read_again(case: str) -> None:
    assert load(case) == load(case)
    assert load(case).limits == load(case).limits
    assert pickle.loads(pickle.dumps(load(case))) == load(case)


def test_every_part_counts_for_equality() -> None:
    one = Problem([[0, 0], [1, 1]], Limits.of(1.0, 2.0, dof=2), names=NAMES)
    others = [
        Problem([[0, 0], [1, 2]], one.limits, names=NAMES),
        Problem([[0, 0], [1, 1], [0, 0]], one.limits, names=NAMES),
        Problem([[0, 0], [1, 1]], Limits.of(1.0, 2.0, 3.0, dof=2), names=NAMES),
        Problem([[0, 0], [1, 1]], one.limits, names=("shoulder", "wrist")),
        Problem([[0, 0], [1, 1]], one.limits, names=NAMES, units=("rad", "m")),
        replace(one, family="quintic"),
        replace(one, name="another"),
    ]
    assert all(one != other for other in others)
    assert replace(one) == one
    assert one != "problem"
    assert one.limits != "limits"


def test_waypoints_and_limits_suffice_and_degrees_are_an_argument() -> None:
    problem = Problem([[0, 10], [90, 20]], limits=Limits.of(1.0, dof=2), unit="deg")
    np.testing.assert_allclose(problem.waypoints, np.deg2rad([[0, 10], [90, 20]]))
    assert problem.display_unit == "deg"
    both = Problem([[0, 10], [90, 20]], {"velocity": [90, 45], "jerk": 180}, unit="deg")
    np.testing.assert_allclose(both.limits.velocity, np.deg2rad([90, 45]))
    np.testing.assert_allclose(both.limits.jerk, math.pi)
    assert np.isinf(both.limits.acceleration).all()
    assert replace(both, name="x").waypoints.tolist() == both.waypoints.tolist()  # not converted twice


def test_a_prismatic_joint_stays_in_metres() -> None:
    limits = Limits.of(
        [90, 0.5], position=[[-180, 180], [0, 0.2]], dof=2, unit="deg", units=("rad", "m")
    )
    np.testing.assert_allclose(limits.velocity, [math.pi / 2, 0.5])
    np.testing.assert_allclose(limits.position, [[-math.pi, math.pi], [0, 0.2]])
    problem = Problem([[0, 0.1], [90, 0.2]], limits, unit="deg")
    np.testing.assert_allclose(problem.waypoints[1], [math.pi / 2, 0.2])
    assert problem.units == ("rad", "m")
    with pytest.raises(
        InputError, match=r"row 2, joint 2: 0\.3 m lies outside limits\.position \[0, 0\.2\] m"
    ):
        Problem([[0, 0.1], [90, 0.3]], limits, unit="deg")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Problem([[0, 0], [1, math.nan]], {"velocity": 1}, names=NAMES), "joint elbow: nan"),
        (lambda: Problem([[0, 0], [1, 1]], {"velocity": [1, -2]}, names=NAMES), "joint elbow: -2"),
        (
            lambda: Problem([[0, 0], [90, 1]], {"velocity": 1, "position": [-45, 45]}, names=NAMES, unit="deg"),
            "row 2, joint shoulder: 90 deg lies outside limits.position [-45, 45] deg",
        ),
        (lambda: Problem([[0, 0], [1, 1]], {"velocity": 1}, names=("a",)), "names: 1 names for 2 joints"),
        (lambda: Problem([[0, 0], [1, 1]], {"velocity": 1}, names=("a", "a")), "names: 'a' is given twice"),
        (lambda: Problem([[0, 0], [1, 1]], {"velocity": 1}, names="ab"), "names: expected a list"),
        (lambda: Problem([[0, 0], [1, 1]], {"velocity": 1}, units=("rad", "mm")), "units: 'mm' is not one of"),
        (lambda: Problem([[0, 0], [1, 1]], {"velocity": 1}, family="5-3"), "family: '5-3' is not one of 3-5-3"),
        (lambda: Problem([[0, 0], [1, 1]], {"velocity": 1}, name=3), "name: expected text, got 3"),
        (lambda: plan("sr4c"), "problem: expected a Problem (load reads one), got 'sr4c'"),
        (lambda: plan(load("sr4c"), gap=0), "gap: 0 is not positive"),
        (lambda: Problem([[0, 0], [1, 1]], {"velocity": 1}, unit="grad"), "unit: 'grad' is not one of"),
        (lambda: Problem([[0, 0], [1, 1]], {"velocty": 1}), "did you mean velocity"),
        (lambda: Problem([[0, 0], [1, 1]], {"jerk": 1}), "limits.velocity: missing"),
        (lambda: Problem([[0, 0], [1, 1]], 3.0), "limits: expected Limits"),
        (lambda: Problem([[0, 0], [1e300, 1]], {"velocity": 1}), "row 2, joint 1: 1e+300 rad is beyond"),
        (lambda: Limits.of(1.0, [1, 0], dof=2, unit="deg", names=NAMES), "elbow: 0 deg/s² is not positive"),
    ],
)  # fmt: skip
def test_a_message_names_the_argument_the_joint_and_the_unit(make: object, words: str) -> None:
    with pytest.raises(InputError) as caught:
        make()  # type: ignore[operator]
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_degrees_read_as_radians_get_a_hint() -> None:
    limits = Limits.of(1.0, dof=2)
    assert Problem([[0, 0], [3, -3]], limits).hints == ()
    (hint,) = Problem([[0, 0], [90, -3]], limits, names=NAMES).hints
    assert "joint shoulder: 90 rad" in hint
    assert "14.3 turns" in hint
    assert 'unit="deg"' in hint
    assert Problem([[0, 0], [90, -3]], limits, unit="deg").hints == ()
    assert Problem([[0, 0], [90, -3]], limits, units=("m", "rad")).hints == ()
    (hint,) = Problem([[-10, 0], [10, 0]], limits).hints  # a displacement of 3.2 turns
    assert "3.18 turns" in hint


def test_a_problem_and_its_limits_print_short() -> None:
    problem = load("sr4c")
    assert str(problem) == repr(problem) == "Problem('sr4c': 4 waypoints of 6 joints, family 3-5-3)"


def test_one_joint_alone_keeps_its_name() -> None:
    problem = Problem([[0, 0], [1, 1]], Limits.of(1.0, dof=2), names=NAMES, units=("rad", "m"))
    alone = problem.joint(1)
    assert alone.names == ("elbow",)
    assert alone.units == ("m",)
    assert "joint elbow alone" in alone.title
