"""Ruckig (Berscheid & Kroeger 2021): the fastest jerk-limited motion between two states of rest.

From the first waypoint to the last, without those between, it solves a relaxed problem: a lower bound. With
a stop at every waypoint it is a feasible motion: an upper bound, and what an engineer has offline today.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import ruckig

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import check
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.rest_to_rest import end_to_end_bound
from formulations.references.reference import Outcome, Rung, RungKind


def ruckig_end_to_end(problem: Problem) -> Outcome:
    """Time the motion from the first waypoint to the last, without those between.

    Parameters
    ----------
    problem : Problem
        Every joint needs an acceleration limit.

    Returns
    -------
    Outcome
        Its number is the proved closed form (``proofs.rest_to_rest``), which Ruckig has to confirm.
    """
    outcome = _through(problem, problem.waypoints[[0, -1]])
    if outcome.seconds is None:
        return outcome
    # Ruckig computes in floating point, so the number is that of the proved closed form
    proved = end_to_end_bound(problem)
    if abs(outcome.seconds - proved) > 1e-9 * proved:
        return Outcome.failed(f"Ruckig says {outcome.seconds:.12g} s, the closed form {proved:.12g} s")
    return replace(outcome, seconds=proved)


def ruckig_stop_and_go(problem: Problem) -> Outcome:
    """Time the motion that stops at each waypoint.

    Parameters
    ----------
    problem : Problem
        Every joint needs an acceleration limit.

    Returns
    -------
    Outcome
        With the motion, which has passed the check.
    """
    return _through(problem, problem.waypoints)


def _through(problem: Problem, points: Array) -> Outcome:
    problem.require_plain("Ruckig")
    if not np.isfinite(problem.limits.acceleration).all():
        return Outcome.not_applicable("Ruckig needs an acceleration limit on every joint")
    durations: list[float] = []
    pieces: list[tuple[Array, Array]] = []
    for start, end in pairwise(points):
        if np.array_equal(start, end):
            durations.append(0.0)
            continue
        motion = _rest_to_rest(problem, start, end)
        if isinstance(motion, str):
            return Outcome.failed(motion)
        durations.append(float(motion[0].sum()))
        pieces.append(motion)
    seconds = np.array(durations)
    if not pieces:
        return Outcome.ok(0.0, durations=seconds, note="nothing moves")
    trajectory = Trajectory(
        np.concatenate([d for d, _ in pieces]),
        np.concatenate([c for _, c in pieces]),
        np.concatenate([[0.0], np.cumsum(seconds)]),
    )
    verdict = check(problem, trajectory, through=len(points) == len(problem.waypoints))
    if not verdict.feasible:
        return Outcome.failed(f"Ruckig's motion did not pass the check: {verdict.faults[0]}")
    return Outcome.ok(verdict.seconds, durations=seconds, trajectory=trajectory)


def _rest_to_rest(problem: Problem, start: Array, end: Array) -> tuple[Array, Array] | str:
    """Compute durations (m,) and coefficients (m, dof, 4) of one motion, or say what went wrong."""
    limits = problem.limits
    task = ruckig.InputParameter(problem.dof)
    task.current_position, task.target_position = start.tolist(), end.tolist()
    task.max_velocity = limits.velocity.tolist()
    task.max_acceleration = limits.acceleration.tolist()
    task.max_jerk = limits.jerk.tolist()
    answer = ruckig.Trajectory(problem.dof)
    try:
        result = ruckig.Ruckig(problem.dof).calculate(task, answer)
    except (ruckig.RuckigError, ValueError) as refusal:  # also a result that its enumeration lacks
        return f"Ruckig: {first_line(refusal)}"
    if result not in (ruckig.Result.Working, ruckig.Result.Finished):
        return f"Ruckig returned {result.name}"
    return pieces_of(answer, start)


def first_line(refusal: Exception) -> str:
    """Extract Ruckig's objection from its message, which repeats the whole input.

    Parameters
    ----------
    refusal : Exception
        As Ruckig raised it.

    Returns
    -------
    str
        One line.
    """
    lines = [line.strip() for line in str(refusal).splitlines() if line.strip()]
    return lines[0].removesuffix(" input:") if lines else type(refusal).__name__


def pieces_of(answer: ruckig.Trajectory, start: Array) -> tuple[Array, Array]:
    """Convert a Ruckig trajectory to polynomial pieces that are common to all joints.

    Only the phase times and the jerks (without a jerk limit: the accelerations) are taken from Ruckig.
    Velocities and positions are integrated here, so that the pieces fit together exactly.

    Parameters
    ----------
    answer : ruckig.Trajectory
        A motion of one section, from rest.
    start : Array, shape (dof,)
        Its first position [rad].

    Returns
    -------
    durations : Array, shape (m,)
        [s].
    coefficients : Array, shape (m, dof, 4)
        Ascending, of the local time [rad/s^k].
    """
    profiles = answer.profiles[0]
    phase_ends = [np.cumsum(profile.t) for profile in profiles]
    end = float(answer.duration)
    breaks = np.unique(np.concatenate([[0.0, end], *phase_ends]))
    breaks = breaks[breaks <= end]
    # times that differ by no more than rounding are one break
    breaks = np.append(breaks[:-1][np.diff(breaks) > 1e-12 * end], end)
    durations = np.diff(breaks)
    middles = breaks[:-1] + 0.5 * durations
    coefficients = np.zeros((len(durations), len(profiles), 4))
    for joint, (profile, ends) in enumerate(zip(profiles, phase_ends, strict=True)):
        phase = np.minimum(np.searchsorted(ends, middles), len(ends) - 1)
        moving = middles < ends[-1]
        jerk = np.where(moving, np.array(profile.j)[phase], 0.0)
        # without a jerk limit the acceleration is set at the start of each phase
        jumps = not np.any(profile.j)
        x, v, a = float(start[joint]), 0.0, 0.0
        for k, h in enumerate(durations):
            if jumps:
                a = float(profile.a[phase[k]]) if moving[k] else 0.0
            j = float(jerk[k])
            coefficients[k, joint] = (x, v, a / 2.0, j / 6.0)
            x += h * (v + h * (a / 2.0 + h * j / 6.0))
            v += h * (a + h * j / 2.0)
            a += h * j
    return durations, coefficients


RUCKIG_END_TO_END = Rung(
    key="ruckig_end_to_end",
    kind=RungKind.LOWER,
    name="Ruckig, end to end",
    meaning="no motion is faster: Ruckig, inner waypoints ignored",
    find=ruckig_end_to_end,
    certified=True,
)
RUCKIG_STOP_AND_GO = Rung(
    key="ruckig_stop_and_go",
    kind=RungKind.UPPER,
    name="Ruckig, stop and go",
    meaning="Ruckig with a full stop at each waypoint",
    find=ruckig_stop_and_go,
    certified=True,
)
