"""``timebound speed --files``: the motion of the study is what it says, and every step is timed."""

from __future__ import annotations

import numpy as np
import pytest

from compare.__main__ import main
from compare.studies.speed_files import FILES, costs, long_motion


def test_the_motion_stands_at_its_waypoints_and_uses_its_limits() -> None:
    problem, motion = long_motion(8.0, 3)
    times = np.arange(5) * 2.0
    np.testing.assert_allclose(motion.at(times), problem.waypoints, atol=1e-12)
    for order in (1, 2):
        np.testing.assert_allclose(motion.at(times, order), 0.0, atol=1e-12)
    # four phases of constant jerk: the acceleration is piecewise linear, so its samples hold the extremes
    dense = np.abs(motion.at(np.linspace(0.0, 8.0, 1601), 2)).max(axis=0)
    np.testing.assert_allclose(dense * 1.001, problem.limits.acceleration, rtol=1e-9)


def test_every_format_is_timed_and_keeps_the_limits() -> None:
    rows = costs(4.0, 1)
    assert [row.suffix for row in rows] == [".csv", ".json", ".yaml", ".npz"]
    for row in rows:
        assert row.feasible
        assert row.n_points == 4001
        assert row.size > 4001 * 22 * 8 * 0.9
        assert min(row.encode, row.decode, row.judge, row.store) > 0.0
        assert row.total == pytest.approx(row.encode + row.decode + row.judge + row.store)
    text = FILES.text(rows, FILES.summarise(rows))
    assert "4 s of 7 joints at 1000 points per second, 4001 points" in text
    assert len(text.splitlines()) == 3 + 4


def test_two_studies_at_once_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["speed", "--files", "--swarms"]) == 2
    assert "--files: given beside --swarms" in capsys.readouterr().err
