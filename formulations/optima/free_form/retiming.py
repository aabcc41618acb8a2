"""Retiming: each segment's least time between given waypoint states, exactly, by Ruckig.

The waypoint states of a program on a coarse mesh are much more accurate than its segment times. This
keeps the states and computes the times without a mesh.

References
----------
Berscheid & Kroeger 2021, "Jerk-limited real-time trajectory generation with arbitrary target states",
Robotics: Science and Systems XVII.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import ruckig

from formulations.optima.free_form.nlp.arcs import ArcMotion, Arcs
from formulations.optima.free_form.nlp.assembly import least_times
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.problem.arrays import Array
from formulations.references.ruckig_ import first_line

_PHASES = 9  # Ruckig's seven, and up to two that brake before them
# limits of velocity, acceleration, jerk that no motion over displacement 1 in time 1 reaches
_OUT_OF_REACH = np.array([1e3, 1e4, 1e5])
_INSIDE = 1.0 - 1e-9  # of a limit: Ruckig refuses states on it, because of rounding


@dataclass(frozen=True)
class Refusal:
    """Why there is no motion."""

    reason: str


def retime(
    task: ConditionedProblem, motion: ArcMotion, *, by_speed: bool = False
) -> ArcMotion | Refusal:
    """Compute the fastest motion through the waypoint states of a motion.

    Parameters
    ----------
    task : ConditionedProblem
    motion : ArcMotion
    by_speed : bool
        Pose the problem to Ruckig in units of top speeds in place of displacements. Ruckig fails on
        some problems in either units.

    Returns
    -------
    ArcMotion or Refusal
    """
    joints = list(motion.joints)
    states = {j: _kept_inside(task, j, arcs.states) for j, arcs in motion.joints.items()}
    for j, own in states.items():
        for derivative, given in enumerate((task.ends[:, j], task.end_accelerations[:, j])):
            own[[0, -1], derivative] = np.where(np.isnan(given), own[[0, -1], derivative], given)
    least = np.maximum(least_times(task, motion.places), motion.times if task.paced else 0.0)
    if not joints:  # velocity limits only: the places say how long each segment takes
        return ArcMotion(least, {}, motion.places)
    times = np.zeros(task.n_segments)
    durations = np.zeros((len(joints), task.n_segments, _PHASES))
    tops = np.zeros_like(durations)
    for k in range(task.n_segments):
        ends = np.stack([states[j][k : k + 2] for j in joints])
        pose = _Segment(task, k, joints, ends, float(motion.times[k]), motion.displacements[k, joints])
        found = pose.retimed(float(least[k]), by_speed)
        if isinstance(found, Refusal):
            return found
        times[k], durations[:, k], tops[:, k] = found
    return ArcMotion(
        times,
        {j: Arcs(int(task.order[j]), durations[i], tops[i], states[j]) for i, j in enumerate(joints)},
        motion.places,
    )


def _kept_inside(task: ConditionedProblem, j: int, states: Array) -> Array:
    """States (S + 1, 2) from which the acceleration can fall to zero: |v| + a^2 / 2J <= V."""
    n = task.n_segments
    (low_v, high_v), (low_a, high_a) = (both[:, j].T for both in task.intervals)

    def least(of: Array) -> Array:
        """A waypoint between two segments keeps the limits of both, (S + 1,)."""
        return np.minimum(of[[0, *range(n)]], of[[*range(n), -1]])

    acceleration = np.clip(states[:, 1], -least(-low_a) * _INSIDE, least(high_a) * _INSIDE)
    needed = acceleration**2 / (2.0 * least(task.limits[2, :, j]))
    down, up = (np.maximum(least(side) * _INSIDE - needed, 0.0) for side in (-low_v, high_v))
    return np.stack([np.clip(states[:, 0], -down, up), acceleration], axis=1)


@dataclass(frozen=True)
class _Segment:
    """One segment of several joints between given states.

    Attributes
    ----------
    task : ConditionedProblem
    k : int
    joints : list of int
    ends : Array, shape (n, 2, 2)
        Velocity and acceleration of each joint at the start and the end.
    scale : float [s]
        A time of the size that is expected.
    displacements : Array, shape (n,) [rad]
    """

    task: ConditionedProblem
    k: int
    joints: list[int]
    ends: Array
    scale: float
    displacements: Array

    def retimed(self, least: float, by_speed: bool) -> tuple[float, Array, Array] | Refusal:
        """Time, phases (n, 9) and tops (n, 9), of at least a time.

        Ruckig's tolerances are absolute. So the segment is posed in units of its time and of each joint's
        own displacement, and limits that are out of reach in these units are lowered.
        """
        joints, scale, n = self.joints, self.scale, len(self.joints)
        velocity, acceleration = (both[self.k, joints] for both in self.task.intervals)
        jerk = self.task.limits[2, self.k, joints]
        speed = np.abs(self.ends[:, :, 0]).max(axis=1)
        fastest = np.abs(velocity).max(axis=1)
        length = np.maximum.reduce([np.abs(self.displacements), speed * scale, 1e-6 * fastest * scale])
        if by_speed:
            length = fastest * scale
        v, a = self.ends[:, :, 0].T / length * scale, self.ends[:, :, 1].T / length * scale**2
        pose = ruckig.InputParameter(n)
        pose.current_position = [0.0] * n
        pose.target_position = (self.displacements / length).tolist()
        pose.current_velocity, pose.target_velocity = v.tolist()
        pose.current_acceleration, pose.target_acceleration = a.tolist()
        units = scale ** np.arange(1, 4)[:, None] / length
        up = np.stack([velocity[:, 1], acceleration[:, 1], jerk]) * units
        down = np.stack([-velocity[:, 0], -acceleration[:, 0], jerk]) * units
        if not by_speed:
            up, down = _lowered(up, v, a), _lowered(down, v, a)
        pose.max_velocity, pose.max_acceleration, pose.max_jerk = up.tolist()
        if not np.array_equal(up, down):
            pose.min_velocity, pose.min_acceleration, _ = (-down).tolist()
            pose.max_jerk = np.maximum(up, down)[2].tolist()
        if least > 0.0:
            pose.minimum_duration = least / scale
        answer = ruckig.Trajectory(n)
        try:
            result = ruckig.Ruckig(n).calculate(pose, answer)
        except (ruckig.RuckigError, ValueError) as error:  # ValueError: a result its enumeration lacks
            return Refusal(f"Ruckig refuses segment {self.k + 1}: {first_line(error)}")
        if result not in (ruckig.Result.Working, ruckig.Result.Finished):
            return Refusal(f"Ruckig refuses segment {self.k + 1}: {result.name}")
        return self._read(answer, length)

    def _read(self, answer: ruckig.Trajectory, length: Array) -> tuple[float, Array, Array] | Refusal:
        """Time, phases and tops of what Ruckig found in units of lengths (n,)."""
        seconds, scale = float(answer.duration), self.scale
        phases, tops = np.zeros((2, len(self.joints), _PHASES))
        for i, (j, profile) in enumerate(zip(self.joints, answer.profiles[0], strict=True)):
            third = self.task.order[j] == 3
            brake = profile.brake
            phases[i, :2], phases[i, 2:] = brake.t, profile.t
            tops[i, :2], tops[i, 2:] = (brake.j, profile.j) if third else (brake.a, profile.a[:7])
            tops[i] *= length[i] / np.float64(scale) ** (3 if third else 2)
        phases[:, -1] += seconds - phases.sum(axis=1)
        if not (phases >= -1e-9 * seconds).all():
            return Refusal(f"Ruckig's phases of segment {self.k + 1} do not add up")
        return seconds * scale, np.maximum(phases, 0.0) * scale, tops


def _lowered(limits: Array, v: Array, a: Array) -> Array:
    """Limits (3, n) that are out of reach, lowered; but the states (2, n) themselves must be allowed."""
    reach = np.minimum(limits, _OUT_OF_REACH[:, None])
    reach[1] = np.maximum(reach[1], np.abs(a).max(axis=0) / _INSIDE)
    room = np.maximum(limits[0] - np.abs(v), 1e-300)  # |v| + a^2 / 2J <= V
    reach[2] = np.maximum(reach[2], (a**2 / (2.0 * room)).max(axis=0) / _INSIDE)
    reach[0] = np.maximum(reach[0], (np.abs(v) + a**2 / (2.0 * reach[2])).max(axis=0) / _INSIDE)
    return np.where(np.isfinite(limits), np.minimum(reach, limits), np.inf)
