"""The data of the interactive charts: what they hold is what the motions, runs and bounds are."""

from __future__ import annotations

import numpy as np
import pytest

from compare.benchmark.grade import Trace
from compare.benchmark.ladders import ladder_record
from compare.report.charts.case_motions import motions_of_case, published_motion
from compare.report.charts.ladder import ladder_chart
from compare.report.charts.motions import ShownMotion, arm_chart, motions_chart
from compare.report.charts.progress import _reached
from compare.report.charts.seeds import seeds_chart
from formulations import FAMILIES, check, ladder, load
from formulations.arms import load_arm


@pytest.fixture(scope="module")
def climbed() -> object:
    keys = ("free_form_lower", "free_form", "family", "family_lower")
    return ladder_record(ladder(load("sr4c"), rungs=keys))


def test_the_ladder_is_sorted_and_says_what_is_proved(climbed) -> None:
    chart = ladder_chart(climbed)
    times = [line["seconds"] for line in chart["lines"]]
    assert times == sorted(times)
    assert len(times) == 3  # the bound of the family is its zone, not a line
    assert chart["proved"] is True
    assert chart["barrier"] <= min(times)
    assert f"no motion is faster than {chart['barrier']:.4f} s" in chart["alt"]


def test_the_pieces_are_the_motion_in_the_problems_units(climbed) -> None:
    problem = load("sr4c")
    shown = motions_of_case(problem, climbed)
    assert [motion.kind for motion in shown] == ["published", "family", "fastest"]
    assert "keeps its limits within the rounding" in shown[0].title
    assert check(problem, shown[2].trajectory).feasible  # stored and read back
    chart = motions_chart(problem, shown)
    degrees = np.rad2deg(1.0)
    for motion, data in zip(shown, chart["motions"], strict=True):
        start = 0.0
        for duration, piece in zip(data["durations"], data["pieces"], strict=True):
            # within rounding of a jump the side is not decided
            for share in (0.1, 0.7) if duration > 1e-6 else ():
                for order in range(4):
                    for j, coefficients in enumerate(piece):
                        value = np.polynomial.Polynomial(coefficients).deriv(order)(share * duration)
                        truth = motion.trajectory.at(start + share * duration, order)[j] * degrees
                        assert value == pytest.approx(truth, rel=1e-5, abs=1e-5)
            start += duration
    joint = chart["joints"][5]
    assert joint["units"] == ["deg", "deg/s", "deg/s²", "deg/s³"]
    assert joint["limits"][1] == pytest.approx(np.array([-1, 1]) * problem.limits.velocity[5] * degrees)
    assert joint["waypoints"] == pytest.approx(problem.waypoints[:, 5] * degrees)


def test_frames_of_the_arm_end_at_the_tool_and_start_together(climbed) -> None:
    problem, arm = load("sr4c"), load_arm("sr4c")
    shown = motions_of_case(problem, climbed)
    chart = arm_chart(arm, shown, problem)
    for motion, data in zip(shown, chart["motions"], strict=True):
        frames = np.array(data["frames"])
        times = np.linspace(0.0, motion.trajectory.seconds, len(frames))
        tool = arm.chain.forward(motion.trajectory.at(times))[:, :3, 3]
        np.testing.assert_allclose(frames[:, -1], tool, atol=6e-4)
        assert data["seconds"] == motion.trajectory.seconds
    stops = arm.chain.forward(problem.waypoints)[:, :3, 3]
    np.testing.assert_allclose(chart["stops"], stops, atol=6e-4)


def test_a_motion_that_is_published_for_other_waypoints_is_not_drawn() -> None:
    assert published_motion(load("z1")) is None
    bad = published_motion(load("ur5"))
    assert bad is not None
    assert "breaks limits" in bad.title
    assert bad.trajectory.seconds == pytest.approx(8.053, abs=2e-3)


def test_shares_of_targets_are_counted_over_all_runs_that_started() -> None:
    # one run reaches a gap of 1 after 10 evaluations and of 0 after 100; another has no trace
    runs = [[Trace(-1, [10, 100], [4.0, 2.0])]]
    at, goals = np.array([1.0, 10.0, 99.0, 100.0]), np.array([1.0, 1e-3])
    found = _reached(runs, 2, {-1: 2.0}, at, goals)
    assert found.tolist() == [0.0, 0.25, 0.25, 0.5]


def test_seeds_without_rows_say_so() -> None:
    assert seeds_chart([])["alt"] == "No run has a verified motion."


def test_what_is_over_a_limit_by_less_than_the_slack_is_not_marked() -> None:
    problem = load("sr4c")
    motion = FAMILIES["3-5-3"].trajectory(problem, [2.0, 2.0, 2.0])
    chart = motions_chart(problem, [ShownMotion("given", "a", motion, 0.25)])
    assert chart["motions"][0]["slack"] == 0.25
