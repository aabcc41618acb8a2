"""``free_form_bound``: the certified lower bound of every motion through the waypoints."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from formulations.deadlines import Deadline
from formulations.deadlines.deadline import Stop
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import TOLERANCE
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem
from formulations.problem.size import require_moderate
from formulations.proofs.certificate import certificate_of
from formulations.proofs.every_motion.attaining_motion.hunt import MotionHunt
from formulations.proofs.every_motion.attaining_motion.relaxed_motion import SearchNear
from formulations.proofs.every_motion.horizons import HorizonSearch
from formulations.proofs.every_motion.recorded import proved_again
from formulations.proofs.every_motion.zones import ZoneSearch
from formulations.proofs.status import BoundStatus
from formulations.proofs.tool.least_times import with_tool_times

__all__ = ["BoundStatus", "FreeFormBound", "free_form_bound"]


@dataclass(frozen=True)
class FreeFormBound:
    """A lower bound on the total time of every motion, and what is known about it.

    Attributes
    ----------
    problem : Problem
        The problem that the bound is for.
    seconds : float [s]
        The bound: no motion takes less.
    method : str
        What proved it: "displacement", "ruckig_end_to_end", "segment" or "relaxation".
    bounds : dict of str to float [s]
        The bound by each of these methods.
    upper : float or None [s]
        Time of the fastest motion known, given or found; None if there is none.
    status : BoundStatus
        How the search ended: "proved" (the gap asked for is reached), "tight as it gets" (narrower
        boxes would prove no more), "time limit", "interrupted", "simple bounds only" or "solver failed".
    runtime : float [s]
        Time of the search on this machine.
    rows : int
        Number of rows of the last linear program.
    motion : Trajectory or None
        The fastest motion, if it was found here; verified.
    durations : Array or None, shape (n_segments,) [s]
        Segment durations at the relaxation's optimum.
    savings : Array or None, shape (3, n_segments, dof) [s]
        Seconds saved per relative increase of a joint's velocity, acceleration or jerk limit in a
        segment, to first order; None without a relaxation.
    certificate : dict or None
        The proof as plain data, for ``formulations.proofs.certificate.write_certificate``.
    reason : str
        Why the search ended with "simple bounds only" or "solver failed".
    """

    problem: Problem
    seconds: float
    method: str
    bounds: dict[str, float]
    upper: float | None
    status: BoundStatus
    runtime: float
    rows: int = 0
    motion: Trajectory | None = field(default=None, repr=False)
    durations: Array | None = field(default=None, repr=False)
    savings: Array | None = field(default=None, repr=False)
    certificate: dict[str, Any] | None = field(default=None, repr=False)
    reason: str = ""

    @property
    def gap(self) -> float | None:
        """Relative gap upper / seconds - 1; None if no motion is known, 0 if nothing moves."""
        if self.upper is None:
            return None
        if self.seconds > 0.0:
            return max(self.upper / self.seconds - 1.0, 0.0)
        return 0.0 if self.upper == 0.0 else float("inf")

    @property
    def least_verified(self) -> float:
        """No motion that passes the independent check is faster than this [s].

        The check allows limits, waypoints, rest and continuity a relative tolerance; ten times this
        tolerance covers what all of them can save.
        """
        return self.seconds * (1.0 - 10.0 * TOLERANCE)

    @property
    def ending(self) -> str:
        """The status and its reason in one line."""
        return f"{self.status}: {self.reason}" if self.reason else str(self.status)


def free_form_bound(
    problem: Problem,
    *,
    conditions: Conditions | None = None,
    gap: float = 1e-3,
    upper: float | None = None,
    time_limit: float = 60.0,
    stop: Stop | None = None,
    record: bool = False,
    progress: Callable[[float, float | None], None] | None = None,
    near: SearchNear | None = None,
) -> FreeFormBound:
    """Prove a lower bound on the total time of all motions through the waypoints.

    The bound holds for every motion from rest to rest (unless the conditions say otherwise) that passes all
    waypoints in order, keeps the conditions, keeps the
    velocity, acceleration and jerk limits exactly, and keeps the position limits to within
    ``problem.position_slack``. Where jerk is limited, the acceleration starts and ends at 0; the jerk
    need only be measurable. The splines of every family are such motions, so the bound holds for every
    family as well.

    It is the best of four bounds: displacement at top speed; rest to rest between the first and the last
    waypoint; each segment by itself; and a linear relaxation of the whole problem. The relaxation
    consists of inequalities that every motion satisfies, generated where the current point violates
    them [1]_. Its optimum is bounded from the multipliers in rounded arithmetic [2]_, so the bound does
    not depend on the solver's accuracy. For most problems the relaxation is tight; where it is not, the
    intervals of its variables are narrowed to the motions that are faster than the fastest one known
    [3]_.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    conditions : Conditions, optional
        In place of the problem's own; the bound is that of the motions that keep them. Torque limits are
        not used, so that the bound holds with them and without.
    gap : float, default 1e-3
        Relative gap between bound and fastest known motion at which the search ends.
    upper : float, optional [s]
        Total time of a verified motion, if one is known. The bound is valid whatever is given. Without
        it a motion is searched for.
    time_limit : float, default 60 [s]
        The search ends after this time; the first linear program is solved in any case.
    stop : callable, optional
        Asked between two linear programs whether to end now.
    record : bool, default False
        Whether to keep the proof in ``certificate``. Where narrow boxes were needed, the certificate
        may prove slightly less.
    progress : callable, optional
        Called as ``progress(bound, upper)`` [s] whenever the bound may have grown.
    near : callable, optional
        Called with a point of the relaxation where narrower boxes do not reach the gap. It searches for motions
        near that point, and returns the time of the fastest one that is verified [s]: ``proved_motion`` does.

    Returns
    -------
    FreeFormBound
        The bound ``seconds``, its ``gap``, the certificate, and what each limit costs (``savings``).

    Raises
    ------
    UnsupportedProblem
        If there are more than 2000 waypoints.
    InputError
        If ``gap``, ``upper`` or ``time_limit`` is not a number in its range.

    See Also
    --------
    free_form : the fastest motion that was found, an upper bound.

    Notes
    -----
    A motion that passes the independent check may exceed the limits by the check's relative tolerance,
    and it is then faster than the bound by as little: see ``FreeFormBound.least_verified``.

    The inequalities and their proofs stand in ``formulations.proofs.every_motion.relaxation.reach``.

    References
    ----------
    .. [1] Kelley 1960, "The cutting-plane method for solving convex programs", Journal of the Society
       for Industrial and Applied Mathematics 8, pp. 703-712.
    .. [2] Neumaier & Shcherbina 2004, "Safe bounds in linear and mixed-integer linear programming",
       Mathematical Programming 99, pp. 283-296.
    .. [3] Gleixner, Berthold, Mueller & Weltge 2017, "Three enhancements for optimization-based bound
       tightening", Journal of Global Optimization 67, pp. 731-757.

    Examples
    --------
    A joint that moves 1 rad from rest to rest at 2 rad/s^2, by way of 0.3 rad:

    >>> from formulations import Limits, Problem, free_form_bound
    >>> limits = Limits.of(velocity=10.0, acceleration=2.0, dof=1)
    >>> bound = free_form_bound(Problem.of([[0.0], [0.3], [1.0]], limits), gap=1e-6)
    >>> round(bound.seconds, 5)  # 2 sqrt(1 / 2)
    1.41421
    >>> print(bound.status)
    proved
    """
    started = time.perf_counter()
    if not (gap > 0.0 and np.isfinite(gap)):
        raise InputError(f"gap: {gap!r} is not a positive number")
    if upper is not None and not (upper >= 0.0 and np.isfinite(upper)):
        raise InputError(f"upper: {upper!r} s is not a time")
    require_moderate(problem)
    # no inequality here knows of torques: the bound is that of all motions that keep the rest
    given = problem.conditions if conditions is None else conditions
    asked_for = given.without_torque()
    problem = replace(problem, conditions=problem.conditions.without_torque())
    stated = Demands.of(problem, asked_for)
    demands = with_tool_times(stated)
    deadline = Deadline(time_limit, stop)
    zones = (demands.waypoints[..., 0] < demands.waypoints[..., 1]).any()
    search = (ZoneSearch if zones else HorizonSearch)(
        demands, MotionHunt(problem, upper, near), progress
    )
    ending = search.run(gap, deadline)
    certificate = None
    if record and search.seconds > 0.0:
        left = max(2.0 * time_limit - (time.perf_counter() - started), 0.0)
        seconds, horizon, events = proved_again(search, Deadline(left, stop))
        asked = None if search.plain else stated
        certificate = certificate_of(problem, seconds, events, horizon=horizon, demands=asked)
        if asked is not None:
            certificate["without"] = sorted(search.without)
    method = max(search.bounds, key=lambda key: search.bounds[key])
    # a motion that attains the bound may exceed the torques that were left out
    torques = given.torque is not None
    return FreeFormBound(
        problem,
        search.bounds[method],
        method,
        search.bounds,
        upper if torques else search.upper,
        ending.status,
        time.perf_counter() - started,
        search.rows,
        None if torques else search.motion,
        None if torques else search.durations,
        search.savings,
        certificate,
        ending.reason,
    )
