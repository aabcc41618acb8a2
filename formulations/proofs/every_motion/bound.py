"""The certified lower bound of every motion there is through the waypoints.

It holds for every motion from rest to rest (where jerk is limited: with an acceleration that starts and
ends at 0) through all waypoints in order, all joints at once, that keeps the velocity, acceleration and
jerk limits exactly and the position limits to within ``problem.position_slack``; the jerk need only be
measurable. Each spline family through the same waypoints is made of such motions, so it is a lower
bound of every family too.

The best of four: displacement at top speed, rest to rest between the first and the last waypoint
(``ruckig_end_to_end``, by its closed form), each segment by itself, and the linear relaxation of
``relaxation``: rows that every motion satisfies, posed where they are needed, whose optimum is bounded
from its multipliers in rounded arithmetic. The relaxation is tight for most tasks; where it is not,
its boxes are narrowed to the motions that are faster than the fastest one known.

What passes the check may exceed the limits by its relative tolerance, and is then faster than the bound
by as little: see ``least_verified``.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import TOLERANCE
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem
from formulations.proofs.certificate import certificate_of
from formulations.proofs.every_motion.search import Search


@dataclass(frozen=True)
class FreeFormBound:
    """No motion takes less than ``seconds``.

    method: "displacement", "ruckig_end_to_end", "segment" or "relaxation", which gave it; bounds: each
    of them [s]. upper: total [s] of the fastest motion known, given or found and verified, None if
    there is none. motion: the one found, if it is that fast. durations: (n_segments,) [s] of the
    relaxation's optimum. savings: (3, n_segments, dof), seconds saved per relative increase of a
    joint's velocity, acceleration, jerk limit in a segment, to first order; None without a relaxation.
    status: "proved" (the gap asked for), "tight as it gets" (narrower boxes would prove no more), "time
    limit", "simple bounds only: reason" or "HiGHS ended with reason". rows: of the last program.
    certificate: plain data for ``bounds.certificate.write_certificate``.
    """

    problem: Problem
    seconds: float
    method: str
    bounds: dict[str, float]
    upper: float | None
    status: str
    runtime: float
    rows: int = 0
    motion: Trajectory | None = field(default=None, repr=False)
    durations: Array | None = field(default=None, repr=False)
    savings: Array | None = field(default=None, repr=False)
    certificate: dict[str, Any] | None = field(default=None, repr=False)

    @property
    def gap(self) -> float | None:
        """Upper / seconds - 1; None if no motion is known, 0 if nothing moves."""
        if self.upper is None:
            return None
        if self.seconds > 0.0:
            return max(self.upper / self.seconds - 1.0, 0.0)
        return 0.0 if self.upper == 0.0 else float("inf")

    @property
    def least_verified(self) -> float:
        """No motion that passes the check is faster than this [s].

        Its tolerance counts for limits, waypoints, rest and continuity: ten times it covers them all.
        """
        return self.seconds * (1.0 - 10.0 * TOLERANCE)


def free_form_bound(
    problem: Problem,
    *,
    gap: float = 1e-3,
    upper: float | None = None,
    time_limit: float = 60.0,
    record: bool = False,
    progress: Callable[[float, float | None], None] | None = None,
) -> FreeFormBound:
    """Prove a lower bound on the total time of all motions through the waypoints.

    gap: relative gap to be content with. upper: total [s] of a verified motion, if one is known; the
    bound is valid whatever is given. time_limit: s, apart from the first program. record: keep the
    certificate, which proves a little less where narrow boxes were needed. progress(seconds,
    upper): called as the bound grows. Raises InputError for a gap or a time that is none.
    """
    started = time.perf_counter()
    if not (gap > 0.0 and np.isfinite(gap)):
        raise InputError(f"gap: {gap!r} is not a positive number")
    if upper is not None and not (upper >= 0.0 and np.isfinite(upper)):
        raise InputError(f"upper: {upper!r} s is not a time")
    if not time_limit >= 0.0:
        raise InputError(f"time_limit: {time_limit!r} s is not a time")
    search = Search(problem, upper, progress)
    status = search.run(gap, started + time_limit)
    certificate = None
    if record and problem.moving_joints:
        seconds, horizon, events = search.recorded(started + 2.0 * time_limit)
        certificate = certificate_of(problem, seconds, events, horizon=horizon)
    method = max(search.bounds, key=lambda key: search.bounds[key])
    return FreeFormBound(
        problem,
        search.bounds[method],
        method,
        search.bounds,
        search.upper,
        status,
        time.perf_counter() - started,
        search.rows,
        search.motion,
        search.durations,
        search.savings,
        certificate,
    )
