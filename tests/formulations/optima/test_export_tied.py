"""Files of points under limits on tool and torques: what a controller makes of them keeps both."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from small_arms import two_links
from tool_problems import planar

from formulations import Conditions, Limits, Problem, check, free_form
from formulations.optima.at_rate.export import Export, export_motion
from formulations.problem.torque import TorqueLimits

pytest.importorskip("pinocchio", reason="pin is not installed (extra dynamics)")
pytest.importorskip("yourdfpy", reason="yourdfpy is not installed (extra robot)")


@pytest.mark.long  # searches
@pytest.mark.parametrize("speed", [None, 1.5])
@pytest.mark.parametrize("rate", [None, 250.0])
def test_the_points_keep_torques_and_the_tool_s_speed(
    rate: float | None, speed: float | None, tmp_path: Path
) -> None:
    torque = TorqueLimits(two_links(), ("one", "two"), (30.0, 10.0))
    limits = Limits.of(velocity=3.0, acceleration=20.0, jerk=200.0, dof=2)
    points = [[-1.2, 0.3], [-0.4, 1.0], [0.3, -0.5]]
    asked = Conditions(torque=torque, tool_speed=speed)
    problem = Problem(points, limits, names=["one", "two"], tool=planar([0.6, 0.5]), conditions=asked)
    motion = free_form(problem).trajectory
    assert motion is not None
    file = export_motion(tmp_path / "motion.csv", problem, motion, rate)
    assert file.verdict.feasible
    assert motion.seconds <= file.seconds <= 1.02 * motion.seconds
    if rate is not None:
        steps = np.diff(read_points(tmp_path / "motion.csv"))
        assert np.abs(steps - 1.0 / rate).max() < 1e-9
    used = {peak.quantity: peak.factor for peak in check(problem, file.motion).peaks}
    assert 0.95 < used["torque"] <= 1.0 + 1e-6
    said = file.lines()[1]
    assert f"torque {file_factor(file, 'torque'):.9g}" in said
    assert (speed is not None) == ("tool speed" in said)


def file_factor(file: Export, quantity: str) -> float:
    """How much of a limit a file uses."""
    return max(peak.factor for peak in file.verdict.peaks if peak.quantity == quantity)


def read_points(path: Path) -> np.ndarray:
    """Times of the points of a file [s]."""
    return np.loadtxt(path, delimiter=",", skiprows=1)[:, 0]
