"""Paths timed under limits that differ between the directions."""

from __future__ import annotations

import numpy as np

from formulations import Limits
from formulations.retiming.retime import retime


def test_each_direction_has_its_own_limits_on_the_path() -> None:
    limits = Limits.of([[-1.0, 0.5]], [[-2.0, 4.0]], 100.0, dof=1)
    to_and_fro = np.concatenate([np.linspace(0.0, 1.0, 40), np.linspace(1.0, 0.0, 40)[1:]])[:, None]
    there = {way.key: way for way in retime(to_and_fro[:40], limits)}
    back = {way.key: way for way in retime(to_and_fro[39:], limits)}
    assert "differ between the two directions" in there["copp"].reason
    for ways, low, high, least, most in ((there, 0.0, 0.5, -2.0, 4.0), (back, -1.0, 0.0, -2.0, 4.0)):
        motion = ways["toppra"].judgement.motion  # type: ignore[union-attr]
        times = np.linspace(0.0, motion.seconds, 4001)
        speeds, accelerations = motion.at(times, 1), motion.at(times, 2)
        assert low - 0.02 <= speeds.min()
        assert speeds.max() <= high + 0.02
        assert 0.95 * max(-low, high) <= np.abs(speeds).max()  # the limit of this direction is used
        inner = accelerations[40:-40]
        assert np.quantile(inner, 0.01) >= least * 1.05
        assert np.quantile(inner, 0.99) <= most * 1.05
    assert there["toppra"].judgement.seconds > back["toppra"].judgement.seconds  # type: ignore[union-attr]
    assert there["free_form"].judgement.feasible  # type: ignore[union-attr]
