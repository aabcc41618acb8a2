"""Variants of the shipped 3-5-3 cases, for tests of many runs: limits scaled joint by joint."""

from __future__ import annotations

import numpy as np

from formulations import Problem, load


def variants(count: int) -> dict[str, Problem]:
    """So many problems, always the same."""
    bases, made = [load(case) for case in ("sr4c", "cobot", "ur5")], {}
    for k in range(count):
        base = bases[k % len(bases)]
        scale = np.random.default_rng(k).uniform(0.5, 1.5, base.limits.derivatives.shape)
        velocity, acceleration, jerk = base.limits.derivatives * scale
        limits = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk}
        made[f"p{k:02d}"] = Problem(base.waypoints, limits, family=base.family)
    return made
