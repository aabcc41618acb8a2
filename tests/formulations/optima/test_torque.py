"""The fastest motion within torque limits: closed forms, laws, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from small_arms import SIX, VERTICAL, pendulum, six_axes, two_links

from formulations import (
    Conditions,
    InputError,
    Limits,
    Problem,
    check,
    free_form,
    free_form_bound,
    plan,
)
from formulations.problem.torque import TorqueLimits

pytest.importorskip("pinocchio", reason="pin is not installed (extra dynamics)")
pytest.importorskip("yourdfpy", reason="yourdfpy is not installed (extra robot)")

INERTIA = 0.1 + 2.0 * 0.5**2  # of the pendulum about its hinge [kg m^2]


def hinged(limit: float, **others: object) -> Conditions:
    return Conditions(torque=TorqueLimits(pendulum(VERTICAL), ("hinge",), (limit,)), **others)  # type: ignore[arg-type]


def turning(acceleration: float = 1e3, jerk: float = 60.0) -> Problem:
    limits = Limits.of(velocity=3.0, acceleration=acceleration, jerk=jerk, dof=1)
    return Problem([[0.0], [0.5], [1.2]], limits, names=["hinge"])


def test_about_a_vertical_axis_a_torque_limit_is_an_acceleration_limit() -> None:
    """tau = I a: the optimum is that of the acceleration limit tau / I."""
    exact = free_form(turning(acceleration=2.4 / INERTIA))
    found = free_form(turning(), conditions=hinged(2.4))
    assert found.verdict is not None
    assert found.verdict.feasible
    assert exact.seconds * (1.0 - 1e-5) <= found.seconds <= exact.seconds * 1.003
    peak = next(peak for peak in found.verdict.peaks if peak.quantity == "torque")
    assert peak.factor == pytest.approx(1.0, abs=1e-3)


def test_a_limit_that_does_not_bind_changes_nothing() -> None:
    free = free_form(turning(acceleration=4.0))
    found = free_form(turning(acceleration=4.0), conditions=hinged(4.0 * INERTIA * 1.01))
    assert found.seconds == free.seconds
    assert found.method == free.method


def test_looser_limits_never_make_it_slower_and_the_bound_is_below() -> None:
    limits = Limits.of(velocity=3.0, acceleration=20.0, jerk=200.0, dof=2)
    problem = Problem([[-1.2, 0.3], [-0.4, 1.0], [0.3, -0.5]], limits, names=["one", "two"])
    torque = TorqueLimits(two_links(), ("one", "two"))
    seconds = []
    for factor in (0.8, 0.9, 1.0, 10.0):
        asked = Conditions(torque=replace(torque, limits=(33.0 * factor, 11.0 * factor)))
        motion = plan(problem, conditions=asked)
        assert motion.bound is not None
        assert motion.bound <= motion.seconds
        assert check(problem, motion.trajectory, conditions=asked).feasible
        seconds.append(motion.seconds)
    assert (np.diff(seconds) <= 2e-3 * np.array(seconds[1:])).all(), seconds
    assert seconds[0] > 1.02 * seconds[-1]  # the limits did bind
    assert any("without torques" in note for note in motion.found.notes)
    plain = free_form_bound(problem).seconds
    assert motion.bound == pytest.approx(plain, rel=1e-6)


@pytest.mark.slow
def test_six_axes_beat_the_motion_that_is_only_slowed_down() -> None:
    points = np.array(
        [[0.0, -1.2, 1.0, 0.0, 0.5, 0.0], [0.9, -0.6, 0.3, 0.4, 0.0, 1.0], [-0.3, -1.5, 1.6, 1, 1, 0]]
    )
    limits = Limits.of(velocity=3.0, acceleration=15.0, jerk=150.0, dof=6)
    problem = Problem(points, limits, names=list(SIX))
    efforts = 0.55 * np.array([120.0, 120.0, 70.0, 20.0, 20.0, 20.0])
    asked = Conditions(torque=TorqueLimits(six_axes(), SIX, tuple(efforts)))
    found = free_form(problem, conditions=asked)
    assert found.verdict is not None
    assert found.verdict.feasible
    slowed = next(
        stage for stage in found.stages if stage.name.startswith("without limits on tool and torques")
    )
    assert found.seconds < 0.99 * slowed.seconds


def test_other_demands_are_kept_beside_torques() -> None:
    """A zone, a wait, a window and a start that moves; the check judges all of them."""
    asked = hinged(
        2.4,
        tolerance={1: np.array([0.1])},
        waits={1: 0.3},
        windows={1: (1.0, np.inf)},
        start_velocity=np.array([0.2]),
    )
    found = free_form(turning(), conditions=asked)
    assert found.verdict is not None
    assert found.verdict.feasible, found.verdict
    assert found.trajectory is not None
    assert found.trajectory.passage_times[1] >= 1.0 - 1e-9


def test_a_waypoint_that_the_motor_cannot_hold_is_refused() -> None:
    problem = Problem(
        [[-1.5], [0.0]], {"velocity": 1.0, "acceleration": 1.0, "jerk": 9.0}, names=["hinge"]
    )
    weight = 2.0 * 9.81 * 0.5
    asked = Conditions(torque=TorqueLimits(pendulum(), ("hinge",), (weight - 0.1,)))
    with pytest.raises(InputError) as caught:
        free_form(problem, conditions=asked)
    assert "waypoint 2, joint hinge: holding the arm takes 9.81 N m, 9.71 N m are available" in str(
        caught.value
    )


def test_a_time_limit_ends_the_search_with_a_motion_that_keeps_all() -> None:
    found = free_form(turning(), conditions=hinged(2.4), time_limit=1.0)
    assert found.verdict is not None
    assert found.verdict.feasible


def test_a_problem_carries_its_torque_limits_and_the_gap_is_that_of_its_motion() -> None:
    given = plan(turning(), conditions=hinged(2.4))
    carried = plan(replace(turning(), conditions=hinged(2.4)))
    assert carried.seconds == given.seconds
    assert carried.proof is not None
    assert carried.proof.gap == pytest.approx(carried.gap)
    assert carried.gap > 0.01  # the bound knows no torque
