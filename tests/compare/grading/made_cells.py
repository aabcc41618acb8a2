"""Cells of made runs for the tests of grading: losses drawn from known distributions."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.grading.cells import Cell

TARGETS = np.array([10.0, 1.0, 1e-3, 1e-7])


def cell(losses: Any) -> Cell:
    """A cell whose runs have these losses, logarithms of gaps; infinite: a miss."""
    listed = np.asarray(losses, dtype=np.float64)
    gaps = 10.0**listed
    hits = np.where(gaps[:, None] <= TARGETS, 100.0, np.inf)
    rows: Any = tuple(range(len(listed)))
    return Cell(listed, gaps, hits, np.full(len(listed), 0.5), TARGETS, rows)


def flock(seed: int, *, ahead: float = 0.0, instances: int = 36, runs: int = 31) -> dict[str, Cell]:
    """Runs of a swarm: each instance has its own level and spread; ``ahead`` is in deviations."""
    rng, made = np.random.default_rng([seed, 5]), {}
    for k in range(instances):
        level, spread = -1.0 - 0.12 * k, 0.2 + 0.05 * (k % 7)
        made[f"i{k:02d}"] = cell(level + spread * (rng.standard_normal(runs) - ahead))
    return made
