"""Motions from elsewhere under balls of the tool: the passage is found where both box and ball are kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planted_motions import rest_to_rest
from tool_problems import planar

from compare.__main__ import main
from formulations import Conditions, Problem, write_motion
from formulations.assessment import assess
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.judgement import Judgement, judge
from formulations.motion.trajectory import Trajectory

POINTS = np.array([[0.0, 0.3], [0.8, 1.0], [1.5, 0.2]])
WIDE = {"velocity": 50.0, "acceleration": 500.0, "jerk": 5000.0}
BOX = 0.1


def problem(radius: float, at: int = 1) -> Problem:
    """Two links of 0.5 and 0.4 m that pass a waypoint within a box and a ball of the tool."""
    zone = {at: np.full(2, BOX)}
    asked = Conditions(tolerance=zone, tool_zones={at: radius})
    return Problem(POINTS, WIDE, tool=planar([0.5, 0.4]), conditions=asked)


def passing(off: np.ndarray, at: int = 1) -> Trajectory:
    """A motion from rest to rest through the waypoints, one of them missed by this much."""
    points = POINTS.copy()
    points[at] += off
    return rest_to_rest(points, np.array([1.0, 1.0]))


def tool(q: np.ndarray) -> np.ndarray:
    """The tool point (..., 2)."""
    a, b = q[..., 0], q[..., 0] + q[..., 1]
    return np.stack([0.5 * np.cos(a) + 0.4 * np.cos(b), 0.5 * np.sin(a) + 0.4 * np.sin(b)], axis=-1)


def nearest(motion: Trajectory) -> float:
    """The least distance of the tool to that of waypoint 1 while the joints are within the box [m]."""
    q = motion.at(np.linspace(0.0, motion.seconds, 200_001))
    inside = (np.abs(q - POINTS[1]) <= BOX).all(axis=1)
    return float(np.linalg.norm(tool(q[inside]) - tool(POINTS[1]), axis=1).min())


def said(found: Judgement) -> list[str]:
    return [line for line in found.unkept if "tool" in line]


@given(st.floats(-0.09, 0.09), st.floats(-0.09, 0.09))
@settings(max_examples=25, deadline=None)
def test_a_ball_is_kept_exactly_where_the_tool_comes_near_enough(a: float, b: float) -> None:
    motion = passing(np.array([a, b]))
    away = nearest(motion)
    if away < 2e-3:
        return
    kept = judge(problem(away * 1.001), motion, tolerance=1e-6)
    assert kept.feasible, kept.unkept
    missed = judge(problem(away * 0.99), motion, tolerance=1e-6)
    assert not missed.feasible
    (line,) = said(missed)
    assert line.startswith("passes waypoint 2 with the tool ")
    assert float(line.split("tool ")[1].split(" mm")[0]) == pytest.approx(1e3 * away, rel=2e-3)
    # nearest to both together may be a little outside of the box
    assert all(abs(miss.distance) < 1e-3 for miss in missed.missed)
    # the tolerance of files is one of the tool too
    assert judge(problem(away * 0.99), motion, tolerance=0.011 * away).feasible


def test_a_fast_passage_between_two_samples_of_the_search_is_found() -> None:
    """The ball is passed within two thousandths of the motion."""
    joint = Problem(
        [[0.0], [1.0], [3.0]],
        WIDE,
        tool=planar([0.5]),
        conditions=Conditions(tolerance={1: np.array([0.3])}, tool_zones={1: 2e-3}),
    )
    through = rest_to_rest(np.array([[0.0], [3.0]]), np.array([1.0]))
    assert judge(joint, through, tolerance=1e-6).feasible


@pytest.mark.parametrize("at", [0, 2])
def test_balls_at_the_ends_are_judged_there(at: int) -> None:
    motion = passing(np.array([0.05, 0.05]), at)
    ends = tool(np.stack([POINTS[at], POINTS[at] + 0.05]))
    away = float(np.linalg.norm(ends[1] - ends[0]))
    assert judge(problem(away * 1.001, at), motion, tolerance=1e-6).feasible
    assert len(said(judge(problem(away * 0.999, at), motion, tolerance=1e-6))) == 1


def test_points_of_a_file_are_judged_as_a_controller_joins_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """UR5: the third joint passes 4 degrees off, within its zone, and the tool comes no nearer than 20.6 mm."""
    text = """
arm = "ur5"
unit = "deg"
waypoints = [[0, -60, 60, 0, 30, 0], [35, -40, 35, 10, 5, 25], [65, -70, 75, -15, 10, 5]]
[limits]
velocity = 180
acceleration = 3000
jerk = 60000
[[conditions.waypoint]]
at = 1
tool_radius = {radius}
tolerance = 10
"""
    degrees = [[0, -60, 60, 0, 30, 0], [35, -40, 39, 10, 5, 25], [65, -70, 75, -15, 10, 5]]
    motion = rest_to_rest(np.deg2rad(np.array(degrees, dtype=float)), np.array([1.0, 1.0]))
    write_motion(tmp_path / "mine.csv", motion, rate=100.0)
    for radius, code in ((0.06, 0), (0.02, 3)):
        (tmp_path / "arm.toml").write_text(text.format(radius=radius))
        argv = ["check", str(tmp_path / "arm.toml"), str(tmp_path / "mine.csv"), "--no-bound"]
        assert main(argv) == code
    out = capsys.readouterr().out
    assert "passes waypoint 2 with the tool" in out
    assert "20 mm allowed" in out
    assert "no uniform stretch mends it: something that is asked for is not kept" in out


def test_no_ball_is_looked_for_where_none_is_asked_for() -> None:
    motion = passing(np.array([0.05, -0.02]))
    plain = Problem(POINTS, WIDE, conditions=Conditions(tolerance={1: np.full(2, BOX)}))
    times = np.linspace(0.0, motion.seconds, 41)
    points = MotionPoints(times, motion.at(times), motion.at(times, 1), motion.at(times, 2))
    assert assess(plain, points, bound=False).judgement.feasible
