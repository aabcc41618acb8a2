"""What is asked for beyond waypoints and limits is drawn where it holds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from report_in_browser import Open

from compare.report.view_page import view_page
from compare.report.viewed import Viewed
from formulations import Conditions, Limits, Problem, Trajectory, ladder, plan
from formulations.arms import load_arm
from formulations.assessment import assess

DEG = np.pi / 180.0
POINTS = DEG * np.array(
    [
        [0, -60, 60, 0, 30, 0],
        [35, -40, 35, 10, 5, 25],
        [65, -70, 75, -15, 10, 5],
        [0, -60, 60, 0, 30, 0],
    ]
)
LIMITS = Limits.of(np.pi, 10.0, 100.0, dof=6)
SLOW = Limits.of(1.0, 10.0, 50.0, dof=6)
ASKED = Conditions(
    tolerance={1: np.full(6, 0.1), 2: np.full(6, 0.05)},
    windows={1: (1.0, 1.5)},
    waits={2: 0.3},
    segment_limits={1: SLOW},
    segment_tool_speed={1: 0.25},
    tool_zones={1: 0.05},
)


def drawn(
    path: Path, open_page: Open, asked: Conditions, given: Trajectory | None = None
) -> tuple[dict[str, Any], Any]:
    """The chart of joint 2 of a motion under all of these, and the motion."""
    arm = load_arm("ur5")
    problem = Problem(POINTS, LIMITS, tool=arm.tool, display_unit="deg", conditions=asked)
    planned = plan(problem, bound=False)
    climbed = ladder(problem, rungs=["displacement"])
    judged = None if given is None else assess(problem, given, conditions=asked)
    page = view_page(Viewed(climbed, None, asked, planned, judged, "given.csv", arm))
    path.write_text(page, "utf-8")
    shown = open_page(path)
    shown.draw_everything()
    figure = shown.figure("view", "motion")
    figure.locator("select").select_option("1")
    chart = shown.drawn("view", "motion")
    assert shown.faults == []
    return chart, planned.found.trajectory


@pytest.mark.long
def test_zones_windows_waits_limits_and_tool_are_drawn(open_page: Open, tmp_path: Path) -> None:
    chart, motion = drawn(tmp_path / "view.html", open_page, ASKED)
    boxes = {shape["name"]: shape for shape in chart["layout"]["shapes"] if shape["type"] == "rect"}
    assert set(boxes) == {"waypoint 2", "waypoint 3", "wait"}
    second, third, wait = boxes["waypoint 2"], boxes["waypoint 3"], boxes["wait"]
    assert (second["x0"], second["x1"]) == (1.0, 1.5)
    half = 0.1 / DEG
    assert (second["y0"], second["y1"]) == pytest.approx((-40 - half, -40 + half), rel=1e-5)
    assert third["x0"] < motion.passage_times[2] < third["x1"]
    assert third["y1"] - third["y0"] == pytest.approx(0.1 / DEG, rel=1e-5)
    assert (wait["x0"], wait["x1"]) == pytest.approx(motion.passage_times[2] + np.array([0, 0.3]))
    steps = [
        trace for trace in chart["data"] if trace.get("name") == "limit" and trace["yaxis"] == "y2"
    ]
    assert len(steps) == 2
    for trace, sign in zip(steps, (-1, 1), strict=True):
        assert trace["x"] == pytest.approx(np.repeat(motion.passage_times, 2)[1:-1], rel=1e-6)
        assert trace["y"] == pytest.approx(sign * np.repeat([180.0, 1.0 / DEG, 180.0], 2), rel=1e-5)
    (curve,) = [
        t for t in chart["data"] if t["yaxis"] == "y5" and t.get("name", "").startswith("fastest")
    ]
    assert "tool speed" in chart["layout"]["yaxis5"]["title"]["text"]
    times, speeds = np.array(curve["x"]), np.array(curve["y"])
    inside = (times > motion.passage_times[1]) & (times < motion.passage_times[2])
    assert 0.24 < speeds[inside].max() < 0.2501
    assert not [t for t in chart["data"] if t["mode"] == "lines" and t["line"]["width"] == 6]
    words = chart["layout"]["xaxis"]["title"]["text"].replace("<br>", " ")
    assert "boxes: zones and windows of waypoints" in words
    assert "grey: waits" in words


@pytest.mark.long
def test_what_is_over_the_limit_of_its_segment_is_thick(open_page: Open, tmp_path: Path) -> None:
    careless = plan(Problem(POINTS, LIMITS), bound=False).found.trajectory
    assert careless is not None
    asked = Conditions(segment_limits={1: SLOW}, segment_tool_speed={1: 0.25})
    chart, _ = drawn(tmp_path / "view.html", open_page, asked, careless)
    thick = [t for t in chart["data"] if t["mode"] == "lines" and t["line"]["width"] == 6]
    (fast,) = [trace for trace in thick if trace["yaxis"] == "y2"]
    times = np.array([t for t, y in zip(fast["x"], fast["y"], strict=True) if y is not None])
    assert len(times)
    first, last = careless.passage_times[[1, 2]]
    assert times.min() >= first - 1e-6
    assert times.max() <= last + 1e-6
    assert np.abs(careless.at(times, 1)[:, 1]).min() > 1.0  # the limit of that segment
