"""The study of zones: savings of one joint in closed form, its files, and what the report says of it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from compare.report.answers import answers
from compare.studies import study, zones
from formulations import Limits, Problem, load

# up to 1 rad and back at 4 rad/s^2: two halves of 2 sqrt(d / 4) = sqrt(d)
TURN = Problem.of([[0.0], [1.0], [0.0]], Limits.of(100.0, 4.0, dof=1), name="turn")


def truth(zone: float) -> float:
    """The first half speeds up and brakes over d = 1 - zone, the second does the same backwards."""
    return 2.0 * (1.0 - np.sqrt(1.0 - zone))


def test_savings_of_one_joint_in_closed_form() -> None:
    for row in zones.savings(TURN, [0.01, 0.1, 0.5]):
        assert row.saved == pytest.approx(truth(row.zone), abs=1e-4)
        assert row.least <= truth(row.zone) <= row.greatest
        assert row.exact == pytest.approx(2.0, rel=1e-4)
        assert row.bound <= row.seconds


def test_velocity_limits_alone() -> None:
    """There and back at 2 rad/s, 2 (1 - zone) rad. Joint 2 is never late."""
    problem = Problem.of([[0.0, 0.0], [1.0, 0.4], [0.0, 0.8]], Limits.of(2.0, dof=2))
    row = zones.savings(problem, [0.1])[0]
    assert row.saved == pytest.approx(0.1, abs=1e-4)
    assert row.least <= 0.1 <= row.greatest


def test_a_zone_of_a_tenth_of_a_radian_on_ur5() -> None:
    row = zones.savings(load("ur5"), [0.1])[0]
    assert row.saved == pytest.approx(0.7828, abs=2e-4)
    assert row.saved - 2e-4 < row.least <= row.saved <= row.greatest < row.saved + 2e-4


def test_files_and_the_answer_of_the_report(tmp_path: Path) -> None:
    found = study.run(zones.STUDY, [(TURN, (0.1, 0.5))], folder=tmp_path)
    assert (tmp_path / "figures" / "zones.svg").stat().st_size > 1000
    kept = json.loads((tmp_path / "zones.json").read_text())["summary"]
    assert [row["zone"] for row in kept] == [0.1, 0.5]
    other = replace(found.rows[1], case="other", saved=0.2, least=-0.1)
    said = answers({}, [], {}, [], [*found.rows, other])[-1]
    assert said.text == "A zone of 0.5 rad at each inner waypoint saves 0.2 to 0.59 s"
    assert said.detail.startswith("turn 0.5858 of 2.0000 s (proved: 0.585")
    assert "other 0.2000 of 2.0000 s." in said.detail  # nothing proved, and not said to be
    assert said.anchor in study.STUDIES
