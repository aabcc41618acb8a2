"""What the chart of motions shows of conditions: zones, times, limits of segments, torques, the tool."""

from __future__ import annotations

import numpy as np
import pytest

from compare.report.charts.motions import ShownMotion, arm_chart, motions_chart
from compare.report.view_answers import what_is_wrong
from compare.report.view_page import view_page
from compare.report.viewed import Viewed
from formulations import Conditions, Limits, Problem, Trajectory, ladder, plan
from formulations.arms import load_arm
from formulations.assessment import assess
from formulations.problem.torque import TorqueLimits

DEG = np.pi / 180.0
POINTS = np.array([[0.0, 0.0], [60.0, 20.0], [20.0, 60.0], [70.0, 10.0]]) * DEG
LIMITS = Limits.of([1.0, 1.2], [3.0, 4.0], [20.0, 25.0], dof=2)
ROD = """<robot name="pendulum"><link name="base"/>
<link name="rod"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
  <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" velocity="5" effort="30"/><dynamics damping="0" friction="2"/></joint></robot>"""


def shown(problem: Problem) -> tuple[dict, Trajectory]:
    motion = plan(problem, bound=False).found.trajectory
    assert motion is not None
    kept = ShownMotion("fastest", "it", motion)
    return motions_chart(problem, [kept], problem.conditions), motion


def test_without_conditions_nothing_is_added() -> None:
    problem = Problem.of(POINTS, LIMITS)
    motion = plan(problem, bound=False).found.trajectory
    assert motion is not None
    chart = motions_chart(problem, [ShownMotion("fastest", "it", motion)], problem.conditions)
    assert "windows" not in chart
    assert "zones" not in chart["joints"][0]


def test_zones_windows_waits_and_limits_of_segments_are_in_the_units_of_the_problem() -> None:
    slow = Limits.of([0.5, 1.2], [3.0, 4.0], [20.0, 9.0], dof=2)
    asked = Conditions(
        tolerance={1: np.array([0.1, 0.0])},
        windows={1: (1.5, np.inf)},
        passage={3: 9.0},
        waits={2: 0.4},
        segment_limits={1: slow},
    )
    problem = Problem(POINTS, LIMITS, display_unit="deg", conditions=asked)
    chart, motion = shown(problem)
    one, two = chart["joints"]
    assert one["zones"][1] == pytest.approx([60.0 - 0.1 / DEG, 60.0 + 0.1 / DEG], rel=1e-5)
    assert [one["zones"][k] for k in (0, 2, 3)] == [None] * 3
    assert two["zones"] == [None] * 4
    assert chart["windows"] == [None, [1.5, None], None, [9.0, 9.0]]
    assert chart["waits"] == [0.0, 0.0, 0.4, 0.0]
    assert one["segments"][0] is None
    assert one["segments"][2] is None
    velocity = np.array([1.0, 0.5, 1.0]) / DEG
    assert [pair[1] for pair in one["segments"][1]] == pytest.approx(velocity, rel=1e-5)
    assert [pair[0] for pair in one["segments"][1]] == pytest.approx(-velocity, rel=1e-5)
    assert two["segments"][1] is None
    assert two["segments"][3][1] == pytest.approx([-9.0 / DEG, 9.0 / DEG], rel=1e-5)
    assert chart["panels"] == []
    # the motion stands still at the waypoint for as long as the grey band says
    arrival = motion.passage_times[2]
    assert motion.at(arrival + np.linspace(0.0, 0.4, 5)) == pytest.approx(
        np.tile(POINTS[2], (5, 1)), abs=1e-6
    )


def test_the_torque_of_a_pendulum_is_that_of_its_closed_form() -> None:
    pytest.importorskip("pinocchio")
    asked = Conditions(torque=TorqueLimits(ROD, ("hinge",)))
    limits = {"velocity": 3.0, "acceleration": 50.0, "jerk": 60.0}
    problem = Problem([[0.0], [1.2]], limits, names=["hinge"], conditions=asked)
    chart, motion = shown(problem)
    (panel,) = chart["panels"]
    assert panel["quantity"] == "torque"
    assert panel["joints"] == [{"unit": "N m", "limits": [-28.0, 28.0], "segments": None}]
    times, torques = np.array(panel["curves"][0][0])
    assert times[0] == 0.0
    assert times[-1] == pytest.approx(motion.seconds, rel=1e-5)
    times = np.minimum(times, motion.seconds)  # rounded
    q, a = motion.at(times)[:, 0], motion.at(times, 2)[:, 0]
    inertia = 0.1 + 2.0 * 0.5**2
    expected = inertia * a - 2.0 * 9.81 * 0.5 * np.cos(q)  # the rod sinks as q grows
    assert torques == pytest.approx(expected, abs=2e-3)


def test_the_speed_of_the_tool_is_that_of_its_path() -> None:
    arm = load_arm("ur5")
    points = np.array([[0, -60, 60, 0, 30, 0], [35, -40, 35, 10, 5, 25], [65, -70, 75, -15, 10, 5]])
    asked = Conditions(segment_tool_speed={1: 0.25}, tool_zones={1: 0.05})
    limits = {"velocity": 3.0, "acceleration": 10.0, "jerk": 100.0}
    problem = Problem(points * DEG, limits, tool=arm.tool, conditions=asked)
    still = Problem(points * DEG, limits, tool=arm.tool)
    motion = plan(still, bound=False).found.trajectory  # of another task: only drawn here
    assert motion is not None
    given = ShownMotion("given", "it", motion)
    chart = motions_chart(problem, [given], asked)
    (panel,) = chart["panels"]
    assert panel["quantity"] == "tool speed"
    assert panel["joints"] == [
        {"unit": "m/s", "limits": [None, None], "segments": [[None, None], [None, 0.25]]}
    ]
    times, speeds = np.array(panel["curves"][0][0])
    step = 1e-5
    inside = (times > 2 * step) & (times < motion.seconds - 2 * step)
    ahead, behind = (arm.tool.forward(motion.at(times[inside] + sign * step)) for sign in (1, -1))
    path = (ahead - behind)[:, :3, 3] / (2 * step)
    assert speeds[inside] == pytest.approx(np.linalg.norm(path, axis=-1), abs=1e-3)
    assert speeds.max() > 0.5
    picture = arm_chart(arm, [given], problem, asked)
    assert picture["balls"] == [[1, 0.05]]


def test_a_motion_that_breaks_a_time_alone_is_not_said_to_keep_everything() -> None:
    asked = Conditions(segment_times={1: (5.0, np.inf)})
    problem = Problem(POINTS, LIMITS, conditions=asked)
    hasty = plan(Problem(POINTS, LIMITS), bound=False).found.trajectory
    assert hasty is not None
    given = assess(problem, hasty, conditions=asked, bound=False)
    assert what_is_wrong(given) == "1 unkept condition"
    viewed = Viewed(ladder(problem, rungs=["displacement"]), None, asked, None, given, "hasty.csv")
    page = view_page(viewed)
    assert "hasty.csv breaks what problem asks for: 1 unkept condition" in page
    assert "condition that is not kept" in page
    assert given.judgement.unkept[0] in page
    assert "Position, velocity, acceleration and jerk</h2>" in page
