"""The papers' rule, the longest time per segment, against the family optimum."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import SOLVED
from family_oracle import (
    KEPT,
    MOVING,
    NO_SHRINKING,
    optimum,
    quick,
)
from hypothesis import given, settings

from formulations import (
    FAMILIES,
    InputError,
    Limits,
    Problem,
    check,
    each_joint_alone,
    load,
    longest_segment,
)

OVERSHOOT = np.array([[0.0], [1.0], [1.1], [0.1]])


def bounded(top: float) -> Problem:
    limits = Limits.of(1.0, 2.0, position=[[-0.5, top]], dof=1)
    return Problem.of(OVERSHOOT, limits)


@pytest.mark.parametrize("case", SOLVED)
def test_the_longest_segment_rule_never_beats_the_optimum(case: str) -> None:
    problem = load(case)
    alone = [optimum(case, joint).durations for joint in problem.moving_joints]
    rule = longest_segment(problem, alone)
    np.testing.assert_array_equal(rule.claimed, np.max(alone, axis=0))
    stretch = FAMILIES[problem.family].stretch(problem, rule.claimed[None])[0]
    assert rule.stretch == stretch
    np.testing.assert_allclose(rule.durations, rule.claimed * max(stretch, 1.0), rtol=1e-14)
    assert rule.durations.sum() >= optimum(case).seconds * (1.0 - 1e-9)
    if rule.position_excess <= KEPT:
        verdict = check(problem, FAMILIES[problem.family].trajectory(problem, rule.durations))
        assert verdict.feasible, verdict.faults


def test_the_rule_breaks_the_limits_of_sr4c() -> None:
    problem = load("sr4c")
    alone = [optimum("sr4c", joint).durations for joint in problem.moving_joints]
    rule = longest_segment(problem, alone)
    assert rule.stretch > 1.1
    claimed = FAMILIES["3-5-3"].trajectory(problem, rule.claimed)
    assert not check(problem, claimed).feasible


@given(problem=MOVING)
@settings(max_examples=4, phases=NO_SHRINKING)
def test_the_rule_never_beats_the_optimum_of_made_up_problems(problem: Problem) -> None:
    alone = [found.durations for found in each_joint_alone(problem, starts=4) if found is not None]
    rule = longest_segment(problem, alone)
    assert rule.durations.sum() >= quick(problem).seconds * (1.0 - 1e-9)
    assert rule.position_excess == 0.0


def test_the_rule_needs_a_joint_that_moves() -> None:
    with pytest.raises(InputError, match="no joint moves"):
        longest_segment(load("sr4c"), [])


def test_the_rule_says_how_far_it_leaves_the_position_limits() -> None:
    rule = longest_segment(bounded(1.2), [np.array([1.0, 2.0, 0.5]), np.array([0.5, 1.0, 1.5])])
    assert rule.claimed.tolist() == [1.0, 2.0, 1.5]
    top = FAMILIES["3-5-3"].trajectory(bounded(1.2), rule.claimed).extremes(0).high.max()
    assert top > 1.5
    assert rule.position_excess == pytest.approx(top - 1.2, rel=1e-9)
    assert longest_segment(bounded(9.0), [rule.claimed]).position_excess == 0.0
