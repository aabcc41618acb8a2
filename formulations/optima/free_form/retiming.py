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
    for j, given in states.items():
        given[[0, -1], 0] = task.ends[:, j]
    least = np.maximum(least_times(task), motion.times if task.times else 0.0)
    times = np.zeros(task.n_segments)
    durations = np.zeros((len(joints), task.n_segments, _PHASES))
    tops = np.zeros_like(durations)
    for k in range(task.n_segments):
        ends = np.stack([states[j][k : k + 2] for j in joints])
        scale = float(motion.times[k])
        found = _segment(task, k, joints, ends, scale, float(least[k]), by_speed)
        if isinstance(found, Refusal):
            return found
        times[k], durations[:, k], tops[:, k] = found
    return ArcMotion(
        times,
        {j: Arcs(int(task.order[j]), durations[i], tops[i], states[j]) for i, j in enumerate(joints)},
    )


def _kept_inside(task: ConditionedProblem, j: int, states: Array) -> Array:
    """States (S + 1, 2) from which the acceleration can fall to zero: |v| + a^2 / 2J <= V."""
    limits = task.limits[:, :, j]
    # a waypoint between two segments keeps the limits of both
    v, a, jerk = np.minimum(
        limits[:, [0, *range(task.n_segments)]], limits[:, [*range(task.n_segments), -1]]
    )
    acceleration = np.clip(states[:, 1], -a * _INSIDE, a * _INSIDE)
    room = np.maximum(v * _INSIDE - acceleration**2 / (2.0 * jerk), 0.0)
    velocity = np.clip(states[:, 0], -room, room)
    return np.stack([velocity, acceleration], axis=1)


def _segment(
    task: ConditionedProblem,
    k: int,
    joints: list[int],
    ends: Array,
    scale: float,
    least: float,
    by_speed: bool,
) -> tuple[float, Array, Array] | Refusal:
    """Time, phases (n, 9) and tops (n, 9) of one segment.

    Ruckig's tolerances are absolute. So the segment is posed in units of its time and of each joint's
    own displacement, and limits that are out of reach in these units are lowered.
    """
    velocity, acceleration, jerk = task.limits[:, k, joints]
    distance = np.abs(task.displacements[k, joints])
    speed = np.abs(ends[:, :, 0]).max(axis=1)
    length = np.maximum.reduce([distance, speed * scale, 1e-6 * velocity * scale])
    if by_speed:
        length = velocity * scale
    v, a = ends[:, :, 0].T / length * scale, ends[:, :, 1].T / length * scale**2
    pose = ruckig.InputParameter(len(joints))
    pose.current_position = [0.0] * len(joints)
    pose.target_position = (task.displacements[k, joints] / length).tolist()
    pose.current_velocity, pose.target_velocity = v.tolist()
    pose.current_acceleration, pose.target_acceleration = a.tolist()
    units = scale ** np.arange(1, 4)[:, None] / length
    limits = np.stack([velocity, acceleration, jerk]) * units
    highest = limits.copy()
    if not by_speed:
        reach = np.minimum(limits, _OUT_OF_REACH[:, None])
        # but the states themselves must be allowed: |v| + a^2 / 2J <= V
        reach[1] = np.maximum(reach[1], np.abs(a).max(axis=0) / _INSIDE)
        room = np.maximum(limits[0] - np.abs(v), 1e-300)
        reach[2] = np.maximum(reach[2], (a**2 / (2.0 * room)).max(axis=0) / _INSIDE)
        reach[0] = np.maximum(reach[0], (np.abs(v) + a**2 / (2.0 * reach[2])).max(axis=0) / _INSIDE)
        highest = np.where(np.isfinite(limits), np.minimum(reach, limits), np.inf)
    pose.max_velocity, pose.max_acceleration, pose.max_jerk = highest.tolist()
    if least > 0.0:
        pose.minimum_duration = least / scale
    answer = ruckig.Trajectory(len(joints))
    try:
        result = ruckig.Ruckig(len(joints)).calculate(pose, answer)
    except (ruckig.RuckigError, ValueError) as error:  # ValueError: a result its enumeration lacks
        return Refusal(f"Ruckig refuses segment {k + 1}: {first_line(error)}")
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        return Refusal(f"Ruckig refuses segment {k + 1}: {result.name}")
    seconds = float(answer.duration)
    phases, tops = np.zeros((2, len(joints), _PHASES))
    for i, (j, profile) in enumerate(zip(joints, answer.profiles[0], strict=True)):
        third = task.order[j] == 3
        brake = profile.brake
        phases[i, :2], phases[i, 2:] = brake.t, profile.t
        tops[i, :2], tops[i, 2:] = (brake.j, profile.j) if third else (brake.a, profile.a[:7])
        tops[i] *= length[i] / np.float64(scale) ** (3 if third else 2)
    phases[:, -1] += seconds - phases.sum(axis=1)
    if not (phases >= -1e-9 * seconds).all():
        return Refusal(f"Ruckig's phases of segment {k + 1} do not add up")
    return seconds * scale, np.maximum(phases, 0.0) * scale, tops
