"""``free_form``: the fastest motion through the waypoints, and what is known of it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Literal

import casadi
import numpy as np

from formulations.deadlines import Deadline
from formulations.deadlines.deadline import Stop
from formulations.motion.verdict import check
from formulations.optima.free_form.answer import FreeForm
from formulations.optima.free_form.ending import SearchStatus
from formulations.optima.free_form.many_waypoints import (
    FoundInLinearTime,
    found_in_linear_time,
    has_many_waypoints,
    is_final,
)
from formulations.optima.free_form.mesh_refinement import MeshRefinement
from formulations.optima.free_form.nlp.assembly import RAMP
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.optima.free_form.stage import VerifiedMotion
from formulations.optima.free_form.vanishing import searched
from formulations.optima.free_form.why_not import named, why_not
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.errors import InputError, NoFeasibleMotion, NotFoundInTime
from formulations.problem.problem import Problem
from formulations.problem.size import require_moderate
from formulations.references.ruckig_ import ruckig_stop_and_go

Solver = Literal["ipopt", "highs"]
_LEAST_ARCS, _MOST_ARCS = 3, 100


def free_form(
    problem: Problem,
    *,
    conditions: Conditions | None = None,
    mesh: int = 7,
    tolerance: float = 1e-3,
    solver: Solver = "ipopt",
    time_limit: float | None = None,
    stop: Stop | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> FreeForm:
    """Find the fastest motion through the waypoints, of all with bounded velocity, acceleration and jerk.

    The motion passes all waypoints in order, from rest to rest unless the conditions say otherwise, and
    the passage times are free. It belongs to no spline family. The search starts from stop and go in
    closed form [1]_. It then solves a nonlinear program on even time steps with IPOPT [2]_, retimes the
    segments between the waypoint states of the solution with Ruckig [3]_, and from there solves a
    program in which every joint crosses every segment on arcs of constant jerk with durations of their
    own. Such arcs can represent the optimum exactly.

    Through many waypoints (40 segments, and 200 segments times joints) a search over durations and waypoint
    states takes over, in time proportional to the number of waypoints; it has no ``sensitivity``. It knows
    zones, stops, waits, free ends, least times and limits of single segments; other conditions, and limits
    that differ by direction, are left to the programs.

    The returned motion is verified: an independent check, which computes exact extremes of all
    polynomials, confirms its waypoints, limits and conditions. So its time is an upper bound on the
    least time. It is the best local optimum found and no proof of optimality; ``free_form_bound`` proves
    a lower bound for the same problem, often equal to six digits. Where there is a gap, ``proved_motion``
    searches once more from the waypoint states of the relaxation behind the bound.

    With ``conditions.total`` the motion takes this time, and it is the smoothest one on even steps of
    constant jerk: it minimises the integral over time of the sum over joints of (jerk / limit)^2, or of
    (acceleration / limit)^2 for joints without a jerk limit.

    Parameters
    ----------
    problem : Problem
        Waypoints, shape (n_waypoints, dof) [rad], and limits per joint.
    conditions : Conditions, optional
        Zones, times, stops, waits, states at the ends, cycles, limits of single segments. Those of the
        problem if left out.
    mesh : int, default 7
        Arcs per segment and joint to begin with, 3 to 100. The profiles of Ruckig have seven, and few
        optima need more.
    tolerance : float, default 1e-3
        Relative tolerance of the total time. Below 1e-3 the mesh is refined until a finer one gains less
        than a tenth of the tolerance; below 1e-4 the best solution is also solved to the last digits.
        It is an aim and not a proof.
    solver : {"ipopt", "highs"}, default "ipopt"
        "highs" solves the programs by sequential linear programming, without IPOPT.
    time_limit : float, optional [s]
        The search ends after this time, and the best verified motion so far is the answer; its status is
        then "time limit". IPOPT is stopped between two iterations, each of which takes about 10 ms per
        thousand variables.
    stop : callable, optional
        Asked again and again whether to end now; the status is then "interrupted". Without it Ctrl-C
        raises KeyboardInterrupt, between two iterations as well.
    progress : callable, optional
        Called after each stage as ``progress(name, seconds)``, with infinite seconds if the check
        refused its motion.

    Returns
    -------
    FreeForm
        The motion ``trajectory``, its time ``seconds`` and ``durations``, shape (n_segments,) [s], what
        each limit costs (``sensitivity``), and the ``stages`` of the search.

    Raises
    ------
    UnsupportedProblem
        If there are more than 2000 waypoints.
    InputError
        If the conditions do not fit the problem, or an option is out of its range.
    NoFeasibleMotion
        If no motion was found that keeps the conditions. Without conditions this happens only where the
        problem's numbers are too far apart for double precision.
    NotFoundInTime
        A ``NoFeasibleMotion``: the time was over before a motion was found that keeps the conditions.
        Without conditions there is always one, stop and go.

    See Also
    --------
    free_form_bound : a certified lower bound on the time of every motion.
    proved_motion : both, and a faster motion where the bound shows the way.
    formulations.diagnosis.diagnose : which limits hold the motion up.

    Notes
    -----
    Without conditions the answer is never slower than stop and go. With velocity limits only, no motion
    attains the infimum; the one returned is within 3e-6 of it, relative.

    The program stands in ``formulations.optima.free_form.nlp.equations``. Where a motion leaves the
    position limits between waypoints, constraints on its Bernstein coefficients are added and the program
    is solved again.

    References
    ----------
    .. [1] Biagiotti & Melchiorri 2008, "Trajectory Planning for Automatic Machines and Robots", sec. 3.4,
       Springer.
    .. [2] Wächter & Biegler 2006, "On the implementation of an interior-point filter line-search
       algorithm for large-scale nonlinear programming", Mathematical Programming 106, pp. 25-57.
    .. [3] Berscheid & Kroeger 2021, "Jerk-limited real-time trajectory generation with arbitrary target
       states", Robotics: Science and Systems XVII.

    Examples
    --------
    A joint that moves 1 rad from rest to rest at 4 rad/s^2 takes 2 sqrt(1 / 4) = 1 s:

    >>> from formulations import Limits, Problem, free_form
    >>> problem = Problem.of([[0.0], [0.4], [1.0]], Limits.of(velocity=10.0, acceleration=4.0, dof=1))
    >>> found = free_form(problem, tolerance=1e-6)
    >>> round(found.seconds, 5)
    1.0
    >>> found.verdict.feasible
    True
    >>> found.trajectory.at(found.trajectory.passage_times).round(6).tolist()  # the waypoints
    [[0.0], [0.4], [1.0]]
    """
    begun = time.perf_counter()
    deadline = Deadline(time_limit, stop)
    require_moderate(problem)
    asked = problem.conditions if conditions is None else conditions
    asked.validate(problem)
    if not (_LEAST_ARCS <= mesh <= _MOST_ARCS):
        raise InputError(f"mesh: {mesh} arcs per segment, expected {_LEAST_ARCS} to {_MOST_ARCS}")
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise InputError(f"tolerance: {tolerance:g} is not positive")
    if solver not in ("ipopt", "highs"):
        raise InputError(f"solver: {solver!r} is not known (known: highs, ipopt)")
    if asked.ties_joints:
        from formulations.optima.shared_steps import fastest_within  # it starts from what is found here

        return fastest_within(
            Demands.of(problem, asked),
            partial(
                free_form,
                replace(problem, conditions=asked.without_torque().without_tool(problem.dof)),
                mesh=mesh,
                tolerance=tolerance,
                solver=solver,
                stop=stop,
                progress=progress,
            ),
            mesh=mesh,
            tolerance=tolerance,
            deadline=deadline,
            progress=progress,
        )
    notes = []
    if solver == "ipopt" and not casadi.has_nlpsol("ipopt"):
        solver = "highs"
        notes.append("this CasADi has no IPOPT: solved by sequential linear programs")
    task = ConditionedProblem(problem, asked)
    if not task.n_segments:
        return _nothing_moves(problem, asked, begun)
    many = None
    if has_many_waypoints(task):
        many = found_in_linear_time(task, tolerance, deadline, progress)
        if many is not None and is_final(many, task):
            return _of_many(problem, asked, many, begun)

    def run(task: ConditionedProblem) -> MeshRefinement:
        search = MeshRefinement(task, solver, progress, deadline)
        if task.timed:
            notes.extend(note for note in search.run_timed(mesh) if note not in notes)
        else:
            search.run(mesh, tolerance)
        return search

    with np.errstate(all="ignore"):  # what overflows is not finite, and the check refuses it
        search = searched(task, run)
    best = search.best
    if many is not None and (best is None or many.verdict.seconds < best.verdict.seconds):
        return _of_many(problem, asked, many, begun)
    status = search.status(tolerance)
    if best is None and search.ended:
        raise NotFoundInTime(f"{status}: no motion was found yet that keeps {named(asked)}")
    if best is None:
        raise NoFeasibleMotion(why_not(search))
    if (
        asked.none
        and problem.limits.symmetric
        and best.verdict.seconds > 0.999 * search.stages[0].seconds
    ):
        best = _or_ruckig(replace(problem, conditions=asked), best)
    if task.group(1):
        notes.append(
            "joints without an acceleration limit have no fastest motion, only an infimum: they change "
            f"their velocity within {RAMP:g} of each segment"
        )
    return FreeForm(
        problem,
        asked,
        np.diff(best.trajectory.passage_times),
        best.trajectory,
        best.verdict,
        best.name,
        status,
        _reason(status, search),
        tuple(notes),
        search.sensitivity,
        tuple(search.stages),
        time.perf_counter() - begun,
    )


def _nothing_moves(problem: Problem, asked: Conditions, begun: float) -> FreeForm:
    return FreeForm(
        problem,
        asked,
        np.zeros(problem.n_segments),
        None,
        None,
        "nothing moves",
        SearchStatus.OK,
        "",
        (),
        None,
        (),
        time.perf_counter() - begun,
    )


def _of_many(problem: Problem, asked: Conditions, found: FoundInLinearTime, begun: float) -> FreeForm:
    converged = found.status is not SearchStatus.NOT_CONVERGED
    return FreeForm(
        problem,
        asked,
        np.diff(found.trajectory.passage_times),
        found.trajectory,
        found.verdict,
        found.stages[-1].name,
        found.status,
        "" if converged else "the steps still gained time when their number was reached",
        (),
        None,
        found.stages,
        time.perf_counter() - begun,
    )


def _or_ruckig(problem: Problem, best: VerifiedMotion) -> VerifiedMotion:
    """Take Ruckig's own stop and go where rounding makes it the faster one."""
    outcome = ruckig_stop_and_go(problem)
    if outcome.trajectory is None or outcome.trajectory.seconds >= best.verdict.seconds:
        return best
    verdict = check(problem, outcome.trajectory)
    name = "stop and go, by Ruckig"
    return replace(best, name=name, trajectory=outcome.trajectory, verdict=verdict)


def _reason(status: SearchStatus, search: MeshRefinement) -> str:
    if status is SearchStatus.NOT_CONVERGED:
        return search.reason or "the local solve converged to a slower motion"
    return ""
