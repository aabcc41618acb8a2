"""Displacement bound: no motion is faster than its largest displacement at top speed.

    T >= sum over segments k of max over joints j of |d_jk| / V_j

Each segment must be crossed, and its crossing takes at least that long. With a velocity limit alone
it is also the infimum over all motions.
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.references.reference import Outcome


def displacement_segments(problem: Problem) -> Array:
    """The bound per segment, (n_segments,) [s]."""
    return np.asarray((np.abs(problem.displacements) / problem.limits.velocity).max(axis=1))


def displacement(problem: Problem) -> Outcome:
    """Lower bound on every motion through the waypoints."""
    segments = displacement_segments(problem)
    return Outcome.ok(float(segments.sum()), durations=segments, note="displacement over top speed")
