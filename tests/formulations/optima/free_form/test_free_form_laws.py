"""Laws of free-form motions: checked answers between their bounds, two solvers, hard problems, options."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from conftest import powers_of_ten, problems
from free_form_helpers import SR4C, UR5, drawn, motion, seconds_of
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.studies import free_form_study
from formulations import (
    REFERENCES,
    Conditions,
    InputError,
    Limits,
    Problem,
    check,
    family_optimum,
    free_form,
)


@given(
    problem=problems(
        segments=st.integers(1, 4),
        max_dof=3,
        limited=("v", "va", "vj", "vaj"),
        reach=(-2.0, 1.0),
        position=True,
    )
)
@settings(max_examples=30)
def test_answers_pass_the_check_and_lie_between_the_bounds(problem: Problem) -> None:
    found = free_form(problem)
    if found.trajectory is None:
        assert not problem.moving_joints
        return
    verdict = check(problem, found.trajectory)
    assert verdict.feasible, verdict.faults
    np.testing.assert_allclose(found.durations, np.diff(found.trajectory.passage_times), rtol=0, atol=0)
    assert found.seconds <= seconds_of("ruckig_stop_and_go", problem)
    assert found.seconds >= seconds_of("displacement", problem) * (1.0 - 1e-12)
    if problem.limits.has_acceleration:
        assert found.seconds >= seconds_of("ruckig_end_to_end", problem) * (1.0 - 1e-9)


@given(seed=st.integers(0, 1000), factor=powers_of_ten(-2.0, 2.0), jerk=st.booleans())
@settings(max_examples=3)
def test_faster_limits_scale_the_time_and_order_does_not_matter(
    seed: int, factor: float, jerk: bool
) -> None:
    v, a, j = 2.0, 5.0, 20.0 if jerk else math.inf
    problem = drawn(seed, 3, Limits.of(v, a, j, dof=3))
    seconds = free_form(problem, tolerance=1e-5).seconds
    faster = Limits.of(v * factor, a * factor**2, j * factor**3, dof=3)
    backwards = problem.waypoints[::-1, ::-1]
    for other, expected in (
        (Problem.of(problem.waypoints, faster), seconds / factor),
        (Problem.of(backwards, problem.limits), seconds),
        (Problem.of(1e-3 * problem.waypoints, Limits.of(1e-3 * v, 1e-3 * a, 1e-3 * j, dof=3)), seconds),
    ):
        assert free_form(other, tolerance=1e-5).seconds == pytest.approx(expected, rel=2e-5)


def test_a_motion_of_the_family_is_never_faster() -> None:
    for problem in (UR5, SR4C):
        assert free_form(problem).seconds < family_optimum(problem, starts=3).seconds


@pytest.mark.parametrize(
    "problem", [UR5, SR4C, drawn(3, 3, Limits.of(2.0, 5.0, 20.0, dof=4))], ids=["ur5", "sr4c", "drawn"]
)
def test_sequential_linear_programs_agree_with_ipopt(problem: Problem) -> None:
    fallback = free_form(problem, solver="highs")
    assert check(problem, motion(fallback)).feasible
    assert fallback.seconds == pytest.approx(free_form(problem).seconds, rel=1e-4)
    assert all("arcs" not in s.name or s.seconds < math.inf for s in fallback.stages)


@pytest.mark.parametrize(
    ("waypoints", "limits"),
    [
        # one joint, many waypoints; twelve joints
        (np.random.default_rng(0).uniform(-2.5, 2.5, (30, 1)), Limits.of(2, 5, 20, dof=1)),
        (np.random.default_rng(0).uniform(-2.5, 2.5, (4, 12)), Limits.of(2, 5, 20, dof=12)),
        # joints that stand still, equal waypoints at the start, inside and at the end
        ([[0, 1], [0, 1], [1, 1], [1, 1], [1, 1], [-1, 1], [-1, 1]], Limits.of(1, 2, 5, dof=2)),
        # limits 1e4 apart, displacements from 1e-6 to 1e3
        ([[0, 0], [1, 1], [-1, 2]], Limits.of([1e-2, 1e2], [1e2, 1e-2], [1.0, 1e4], dof=2)),
        ([[0, 0], [1e-6, 1e3], [2e-6, 1e3 + 1e-6], [1, 0]], Limits.of(1, 2, [5.0, math.inf], dof=2)),
        # a joint with a velocity limit alone beside others
        (
            [[0, 0, 0], [1, 1, 1], [0, 2, 0]],
            Limits.of(1, [2, math.inf, 3], [9, math.inf, math.inf], dof=3),
        ),
    ],
)
def test_hard_problems_are_answered(waypoints: Any, limits: Limits) -> None:
    problem = Problem.of(waypoints, limits)
    found = free_form(problem)
    verdict = check(problem, motion(found))
    assert verdict.feasible, verdict.faults
    assert found.seconds <= found.stages[0].seconds
    assert found.seconds <= seconds_of("ruckig_stop_and_go", problem)
    still = ~np.diff(problem.waypoints, axis=0).any(axis=1)
    assert (found.durations[still] == 0.0).all()


def test_nothing_moves() -> None:
    problem = Problem.of([[1.0, 2.0]] * 3, Limits.of(1.0, 1.0, 1.0, dof=2))
    found = free_form(problem)
    assert (found.seconds, found.trajectory, found.status) == (0.0, None, "ok")
    waiting = free_form(problem, conditions=Conditions(total=2.0))
    assert waiting.seconds == 2.0
    assert check(problem, motion(waiting), conditions=Conditions(total=2.0)).feasible


def test_ruckigs_own_failures_are_a_status() -> None:
    # its answer is a result that its enumeration does not have
    problem = Problem.of([[0.0], [1e6]], Limits.of(1e-5, 1e-3, 1e-3, dof=1))
    assert REFERENCES["ruckig_stop_and_go"](problem).status == "failed"
    assert check(problem, motion(free_form(problem))).feasible


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"mesh": 1}, "mesh: 1 arcs"),
        ({"tolerance": -1.0}, "tolerance: -1 is not positive"),
        ({"tolerance": math.nan}, "tolerance: nan"),
        ({"solver": "snopt"}, "solver: 'snopt' is not known"),
    ],
)
def test_options_that_make_no_sense(options: dict[str, Any], line: str) -> None:
    with pytest.raises(InputError, match=line):
        free_form(UR5, **options)


def test_progress_and_stages_tell_the_same_story() -> None:
    told: list[tuple[str, float]] = []
    found = free_form(SR4C, progress=lambda name, seconds: told.append((name, seconds)))
    assert told == [(stage.name, stage.seconds) for stage in found.stages]
    assert found.seconds == min(seconds for _, seconds in told)
    assert found.method in {name for name, _ in told}


@pytest.mark.parametrize("arm", ["panda", "xarm6"])
def test_two_real_arms(arm: str) -> None:
    problem = drawn(11, 3, free_form_study.ARMS[arm])
    found = free_form(problem)
    refined = free_form(problem, tolerance=1e-5)
    assert found.status == "ok"
    assert check(problem, motion(found)).feasible
    assert found.seconds < seconds_of("ruckig_stop_and_go", problem)
    assert refined.seconds * (1.0 - 1e-12) <= found.seconds <= refined.seconds * (1.0 + 1e-3)
