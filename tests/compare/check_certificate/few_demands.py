"""Demands that a test writes down by hand."""

from __future__ import annotations

from typing import Any

import numpy as np

FREE = [-np.inf, np.inf]


def demands(
    zones: list[list[list[float]]], speeds: list[float], steep: float = np.inf, jerk: float = np.inf
) -> dict[str, Any]:
    """Waypoints as intervals per joint, and a velocity limit per segment that all joints share."""
    x, n, dof = np.array(zones), len(speeds), len(zones[0])
    V = np.broadcast_to(np.array(speeds)[:, None, None] * [-1.0, 1.0], (n, dof, 2))
    A = np.broadcast_to(np.array([-steep, steep]), (n, dof, 2))
    return {
        "waypoints": x,
        "velocity": V,
        "acceleration": A,
        "jerk": np.full((n, dof), jerk),
        "position": np.broadcast_to(np.array(FREE), (n, dof, 2)),
        "end_velocity": V[[0, -1]],
        "end_acceleration": A[[0, -1]],
        "stops": [False] * (n + 1),
        "waits": np.zeros(n + 1),
        "durations": np.tile([0.0, np.inf], (n, 1)),
        "passages": np.tile([0.0, np.inf], (n + 1, 1)),
        "cyclic": False,
    }
