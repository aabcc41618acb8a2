"""Three ways to time a path, against closed forms and Ruckig on a straight line."""

from __future__ import annotations

import numpy as np
import pytest
import ruckig

from formulations import InputError, Limits
from formulations.motion.files.motion_points import MotionPoints
from formulations.retiming.retime import Retimed, retime

V, A, J = 1.0, 2.0, 12.0


def by_key(ways: list[Retimed]) -> dict[str, Retimed]:
    return {way.key: way for way in ways}


def test_a_straight_line_is_timed_as_the_closed_form_and_ruckig_say() -> None:
    length = 1.7
    points = np.linspace(0.0, length, 40)[:, None] * np.array([1.0, -0.5])
    found = by_key(retime(points, Limits.of(V, A, J, dof=2), tolerance=1e-3))
    assert list(found) == ["toppra", "copp", "free_form"]  # no times came with it
    task = ruckig.InputParameter(1)
    task.current_position, task.target_position = [0.0], [length]
    task.max_velocity, task.max_acceleration, task.max_jerk = [V], [A], [J]
    answer = ruckig.Trajectory(1)
    ruckig.Ruckig(1).calculate(task, answer)
    free = found["free_form"]
    assert free.kept is not None
    assert free.kept.seconds == pytest.approx(answer.duration, rel=1e-6)
    assert free.judgement is not None
    assert free.judgement.feasible
    copp = found["copp"]
    assert copp.kept is not None
    assert answer.duration <= copp.kept.seconds <= 1.03 * answer.duration
    # without a jerk limit: a trapezoid of the velocity
    toppra = found["toppra"]
    assert toppra.judgement is not None
    assert toppra.judgement.seconds == pytest.approx(length / V + V / A, rel=2e-3)
    assert toppra.judgement.violations[0].quantity == "jerk"
    assert toppra.kept is not None
    assert toppra.kept.seconds > copp.kept.seconds


def test_a_bend_is_kept_to_within_the_tolerance_and_costs_time() -> None:
    u = np.linspace(0.0, 1.0, 120)
    points = np.stack([np.sin(2.0 * u), 0.4 * np.cos(5.0 * u)], axis=1)
    limits = Limits.of([1.0, 1.5], [3.0, 4.0], [20.0, 30.0], (-2.0, 2.0), dof=2)
    dense = np.linspace(0.0, 1.0, 20_000)
    curve = np.stack([np.interp(dense, u, points[:, k]) for k in range(2)], axis=1)
    seconds = []
    for tolerance in (5e-2, 5e-3):
        found = by_key(retime(points, limits, tolerance=tolerance))["free_form"]
        assert found.kept is not None
        assert found.deviation is not None
        assert found.deviation <= tolerance
        # seen from the motion, sampled here, no place is farther from the polyline
        at = found.kept.at(np.linspace(0.0, found.kept.seconds, 300))
        away = np.sqrt(((at[:, None] - curve[None]) ** 2).sum(axis=2).min(axis=1))
        assert away.max() <= found.deviation + 1e-4
        seconds.append(found.kept.seconds)
    assert seconds[0] < seconds[1]


def test_a_motion_with_times_is_judged_beside_the_ways() -> None:
    t = np.linspace(0.0, 1.0, 11)
    points = MotionPoints(t, np.stack([t, t**2], axis=1))
    ways = by_key(retime(points, Limits.of(V, A, dof=2), tolerance=1e-2))
    given = ways["given"].judgement
    assert given is not None
    assert not given.feasible  # straight lines
    assert ways["given"].kept is None
    assert ways["copp"].reason == "no jerk limit: TOPP-RA is the optimum on this path"
    assert ways["toppra"].kept is not None


def test_what_cannot_be_timed_is_refused() -> None:
    points = np.linspace(0.0, 3.0, 20)[:, None]
    with pytest.raises(InputError, match="waypoints: row 20, joint 1: 3 rad lies outside"):
        retime(points, Limits.of(V, A, J, (-1.0, 1.0), dof=1))
    with pytest.raises(InputError, match="tolerance: 0 rad"):
        retime(points, Limits.of(V, A, J, dof=1), tolerance=0.0)
