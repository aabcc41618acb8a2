"""``proved_motion``: the bound of a motion that was found, and a faster motion where the bound shows the way.

The search for the fastest motion is local. It may end in a slower local optimum, or in an even slower point
where arcs vanish. Where the bound leaves a gap, the search begins again at the waypoint states of the
relaxation behind the bound, which has no local optima.
"""

from __future__ import annotations

import time
from dataclasses import replace

import casadi
import numpy as np

from formulations.deadlines import Deadline
from formulations.deadlines.deadline import Stop
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.free_form.answer import FreeForm
from formulations.optima.free_form.ending import SearchStatus
from formulations.optima.free_form.many_waypoints import has_many_waypoints
from formulations.optima.free_form.mesh_refinement import MeshRefinement
from formulations.optima.free_form.nlp.arcs import ArcMotion, Arcs
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.optima.free_form.vanishing import searched
from formulations.proofs.every_motion.attaining_motion.relaxed_motion import RelaxedMotion
from formulations.proofs.every_motion.bound import FreeFormBound, free_form_bound

_ARCS = 7  # per segment and joint, as Ruckig's profiles have
_SHORTEST = 1e-3  # of the mean segment: shorter ones begin with this duration


def proved_motion(
    found: FreeForm,
    *,
    gap: float = 1e-3,
    upper: float | None = None,
    time_limit: float = 60.0,
    stop: Stop | None = None,
    record: bool = False,
) -> tuple[FreeForm, FreeFormBound]:
    """Prove a lower bound on the time of all motions, and find a faster motion where one is missing.

    Parameters
    ----------
    found : FreeForm
        What ``free_form`` found.
    gap : float, default 1e-3
        Relative gap at which the search ends.
    upper : float, optional [s]
        Time of another verified motion, where one is known that is faster.
    time_limit : float, default 60 [s]
        The search ends after this time; the first linear program is solved in any case.
    stop : callable, optional
        Asked again and again whether to end now.
    record : bool, default False
        Whether to keep the proof in the bound's ``certificate``.

    Returns
    -------
    found : FreeForm
        The motion given, or a faster one, with the stages that led to it.
    bound : FreeFormBound
        Under the same conditions, a fixed total time aside; ``upper`` is the time of the fastest motion known.

    See Also
    --------
    free_form_bound : the bound alone.

    Notes
    -----
    Nothing is searched where the first motion is within the gap, where a tool speed or torques tie the joints
    to each other, where the total time is fixed, and through many waypoints. Else the bound calls for at most
    four searches, when its boxes no longer get narrower; each takes about as long as ``free_form``.

    Examples
    --------
    >>> from formulations import Limits, Problem, free_form, proved_motion
    >>> problem = Problem.of([[0.0], [0.4], [1.0]], Limits.of(velocity=10.0, acceleration=4.0, dof=1))
    >>> motion, bound = proved_motion(free_form(problem, tolerance=1e-5), gap=1e-4)
    >>> round(motion.seconds, 4), round(bound.seconds, 4)
    (1.0, 1.0)
    """
    problem, asked, deadline = found.problem, found.conditions, Deadline(time_limit, stop)
    task = ConditionedProblem(problem, asked)
    local = not (asked.ties_joints or has_many_waypoints(task))
    known = None if found.trajectory is None else min(found.seconds, upper or np.inf)
    best = found

    def near(point: RelaxedMotion) -> float:
        nonlocal best
        best = _faster(best, point, gap, deadline)
        return best.seconds

    bound = free_form_bound(
        problem,
        conditions=asked.without_total(problem),
        gap=gap,
        upper=known,
        time_limit=time_limit,
        stop=stop,
        record=record,
        near=near if local and not task.timed and known is not None else None,
    )
    if bound.motion is not None and bound.motion.seconds < best.seconds and not task.timed:
        verdict = check(problem, bound.motion, conditions=asked)
        best = _replaced(best, "attains the bound", bound.motion, verdict)
    if best is not found and best.seconds <= bound.seconds * (1.0 + gap):
        best = replace(best, status=SearchStatus.OK, reason="")
    return best, bound


def _replaced(found: FreeForm, method: str, motion: Trajectory, verdict: Verdict) -> FreeForm:
    durations = np.diff(motion.passage_times)
    return replace(found, durations=durations, trajectory=motion, verdict=verdict, method=method)


def _faster(found: FreeForm, point: RelaxedMotion, tolerance: float, deadline: Deadline) -> FreeForm:
    """Search near a point of the relaxation; the motion given is the answer where none is faster."""
    begun = time.perf_counter()
    solver = "ipopt" if casadi.has_nlpsol("ipopt") else "highs"

    def run(task: ConditionedProblem) -> MeshRefinement:
        search = _SearchNear(task, solver, None, deadline)
        search.start = as_start(task, point)
        search.run(_ARCS, tolerance)
        return search

    with np.errstate(all="ignore"):  # what overflows is not finite, and the check refuses it
        search = searched(ConditionedProblem(found.problem, found.conditions), run)
    stages = (*found.stages, *search.stages)
    found = replace(found, stages=stages, runtime=found.runtime + time.perf_counter() - begun)
    best = search.best
    if best is None or best.verdict.seconds >= found.seconds:
        return found
    status = search.status(tolerance)
    return replace(
        _replaced(found, best.name, best.trajectory, best.verdict),
        status=status,
        reason=search.reason if status is SearchStatus.NOT_CONVERGED else "",
        sensitivity=search.sensitivity or found.sensitivity,
    )


class _SearchNear(MeshRefinement):
    """The search that begins at a motion from elsewhere."""

    start: ArcMotion | None = None

    def _run(self, mesh: int, tolerance: float) -> None:
        if self.start is not None:
            self.second = float(self.start.times.mean())
            self._between_states(self.start, mesh, " near the relaxation")
            self._finish(tolerance)


def as_start(task: ConditionedProblem, point: RelaxedMotion) -> ArcMotion | None:
    """Make a start for the programs of waypoint states.

    Parameters
    ----------
    task : ConditionedProblem
    point : RelaxedMotion

    Returns
    -------
    ArcMotion or None
        The gentlest arcs between these states, whatever limits they break. None where a waypoint or a joint
        of the task is missing.
    """
    numbers, first = np.unique(task.waypoint_of[point.waypoints], return_index=True)
    column = {int(j): i for i, j in enumerate(point.joints)}
    if len(numbers) <= task.n_segments or not set(task.moving) <= set(column):
        return None
    places = task.waypoints.copy()
    places[:, point.joints] = point.positions[first]
    places = np.clip(places, task.boxes[..., 0], task.boxes[..., 1])
    arrivals = np.concatenate([[0.0], np.cumsum(point.durations)])[first]
    times = np.maximum(np.diff(arrivals), _SHORTEST * arrivals[-1] / task.n_segments)
    lengths = np.repeat(times[:, None] / _ARCS, _ARCS, axis=1)
    joints = {}
    for j in [*task.group(2), *task.group(3)]:
        i, order = column[j], int(task.order[j])
        states = np.stack([point.velocities[first, i], point.accelerations[first, i]], axis=1)
        states[:, 1] *= order == 3
        arcs = Arcs(order, lengths, np.zeros_like(lengths), states)
        joints[j] = arcs.projected(np.diff(places[:, j]))
    return ArcMotion(times, joints, places)
