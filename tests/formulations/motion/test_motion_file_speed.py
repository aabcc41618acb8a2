"""Five minutes of seven joints at 1 kHz are written and read in seconds of one core."""

from __future__ import annotations

import time

import numpy as np
import pytest

from formulations.motion.files.motion_file import decode_motion, encode_motion
from formulations.motion.files.motion_points import MotionPoints


@pytest.mark.parametrize("suffix", [".csv", ".json", ".yaml", ".npz"])
def test_long_motions_are_written_and_read_at_once(suffix: str) -> None:
    times = np.arange(300_001) / 1000.0
    phases = times[:, None] * np.linspace(0.5, 2.0, 7)
    motion = MotionPoints(times, np.sin(phases), np.cos(phases), -np.sin(phases))
    short = MotionPoints(times[:2], *(x[:2] for x in (np.sin(phases), np.cos(phases), -np.sin(phases))))
    decode_motion(f"m{suffix}", encode_motion(f"m{suffix}", short))  # compiles
    started = time.process_time()
    back = decode_motion(f"m{suffix}", encode_motion(f"m{suffix}", motion))
    assert time.process_time() - started < 6.0  # 1.5 s where nothing else runs
    assert isinstance(back, MotionPoints)
    assert np.array_equal(back.times, times)
    np.testing.assert_allclose(back.positions, np.sin(phases), rtol=0.0, atol=2.3e-16)
