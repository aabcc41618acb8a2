"""Problems as the descent over durations and waypoint states sees them, and its points as verified motions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.free_form.nlp.arcs import ArcMotion, Arcs
from formulations.optima.free_form.nlp.assembly import assemble
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.optima.free_form.stop_and_go import stop_and_go_motion
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.attaining_motion.chain_task import ChainTask
from formulations.proofs.every_motion.attaining_motion.motion import connect, connecting_arcs
from formulations.proofs.every_motion.attaining_motion.reach_rows import ChainPoint
from formulations.proofs.every_motion.attaining_motion.states import MARGIN, WaypointStates
from formulations.proofs.every_motion.closed_forms import stop_and_go_durations
from formulations.proofs.every_motion.relaxation.kept_waypoints import gaps
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem


def is_plain(task: ConditionedProblem) -> bool:
    """Say whether only waypoints are asked for, under limits equal in both directions.

    Parameters
    ----------
    task : ConditionedProblem

    Returns
    -------
    bool
    """
    return task.conditions.none and task.problem.plain


def least_ways(task: ConditionedProblem) -> Array:
    """Compute how far the moving joints have to go at least on each segment.

    Parameters
    ----------
    task : ConditionedProblem

    Returns
    -------
    Array, shape (S, n) [rad]
        0 where the zones of a joint at both ends meet.
    """
    first = np.arange(task.n_segments)
    legs = np.stack([first, first + 1], axis=1)
    return np.asarray(gaps(task.boxes[:, task.moving], legs).max(axis=-1))


class PlainChain:
    """A problem without conditions.

    Attributes
    ----------
    task : ChainTask
    start : ChainPoint
        Stop and go.
    path : Array, shape (K + 1, n) [rad]
        The waypoints.
    waits : float [s]
    """

    waits = 0.0

    def __init__(self, problem: Problem) -> None:
        """Pose the task, with limits lowered by a margin.

        Parameters
        ----------
        problem : Problem
            With an acceleration limit or a jerk limit for each joint that moves.
        """
        self.problem = problem
        v, a, j = problem.limits.derivatives * (1.0 - MARGIN)
        lowered = replace(problem, limits=replace(problem.limits, velocity=v, acceleration=a, jerk=j))
        times = stop_and_go_durations(problem)
        relaxed = RelaxedProblem.of(lowered, 10.0 * float(times.sum()), 0.0)
        self.task = ChainTask.of(relaxed)
        still = np.zeros((len(relaxed.segments) + 1, len(relaxed.joints)))
        self.start = ChainPoint(times[relaxed.segments] * (1.0 + 2.0 * MARGIN), still, still, still)
        self.path = problem.waypoints[np.ix_(relaxed.waypoints, relaxed.joints)]

    def judged(self, point: ChainPoint) -> tuple[Trajectory, Verdict] | None:
        """Connect the states of a point, and check the motion.

        Parameters
        ----------
        point : ChainPoint

        Returns
        -------
        Trajectory, Verdict
            None in place of both where the numbers overflow.
        """
        own = RelaxedProblem.of(self.problem, float(point.T.sum()) * (1.0 + MARGIN))
        task = self.task
        states = WaypointStates(own, point.v * task.velocity, point.a * task.acceleration)
        motion = connect(self.problem, point.T, states)
        return None if motion is None else (motion, check(self.problem, motion))


class ConditionedChain:
    """A problem with zones, stops, waits, free ends, least times or limits of single segments.

    Attributes
    ----------
    task : ChainTask
    start : ChainPoint
        Stop and go.
    path : None
        A dense path under conditions has no smooth timing to begin with.
    waits : float [s]
        The sum of all waits.
    """

    path = None

    def __init__(self, task: ConditionedProblem) -> None:
        """Pose the task, with limits lowered by a margin.

        Parameters
        ----------
        task : ConditionedProblem
            That a motion slowed down as a whole still keeps.
        """
        self.asked, joints = task, task.moving
        v, a, jerk = (limit[:, joints] * (1.0 - MARGIN) for limit in task.limits)
        jerk = np.where(np.isfinite(jerk), jerk, 0.0)
        low, high = np.moveaxis(task.boxes[:, joints], -1, 0)
        self.middles = 0.5 * (low + high)
        least = (least_ways(task) / v).max(axis=1)
        self.task = ChainTask(
            np.diff(self.middles, axis=0),
            np.where(high > low, np.minimum(high - self.middles, self.middles - low), 0.0),
            np.maximum(least, task.durations[:, 0]),
            v,
            a,
            jerk,
            self._boxes(v, task.ends[:, joints]),
            self._boxes(a * (jerk > 0.0), task.end_accelerations[:, joints]),
        )
        motion = stop_and_go_motion(task)
        still = np.zeros(self.middles.shape)
        offsets = (motion.places[:, joints] - self.middles) / self.task.velocity
        self.start = ChainPoint(motion.times * (1.0 + 2.0 * MARGIN), still, still, offsets)
        self.waits = float(task.waits.sum())

    def _boxes(self, limits: Array, given: Array) -> Array:
        """Intervals at the waypoints, (S + 1, n, 2), from limits of segments and what is given at the ends."""
        most = np.minimum(np.concatenate([limits[:1], limits]), np.concatenate([limits, limits[-1:]]))
        most[self.asked.stops] = 0.0
        found: Array = most[..., None] * np.array([-1.0, 1.0])
        for end in (0, -1):
            found[end] = np.where(np.isnan(given[end])[:, None], found[end], given[end][:, None])
        return found

    def judged(self, point: ChainPoint) -> tuple[Trajectory, Verdict] | None:
        """Connect the states of a point by arcs, and check the motion.

        Parameters
        ----------
        point : ChainPoint

        Returns
        -------
        Trajectory, Verdict
            None in place of both where the numbers overflow.
        """
        asked, task = self.asked, self.task
        v, a = point.v * task.velocity, point.a * task.acceleration
        places = asked.waypoints.copy()
        places[:, asked.moving] = self.middles + point.e * task.velocity
        raised = 1.0 / (1.0 - MARGIN)
        own = task.velocities * raised, task.accelerations * raised, task.jerks * raised
        displacements = np.diff(places, axis=0)[:, asked.moving]
        times, tops = connecting_arcs(point.T, v, a, displacements, own)
        joints = {
            j: Arcs(int(asked.order[j]), times[:, i], tops[:, i], np.stack([v[:, i], a[:, i]], axis=-1))
            for i, j in enumerate(asked.moving)
        }
        motion = ArcMotion(point.T, joints, places)
        if not all(np.isfinite(arcs.tops).all() for arcs in joints.values()):
            return None
        whole = assemble(asked, motion)
        return whole, check(asked.problem, whole, conditions=asked.conditions)
