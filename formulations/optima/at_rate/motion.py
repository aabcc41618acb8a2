"""The fastest motion again, such that the points of a file describe it exactly.

A controller joins the points of a file by quintics. Between two points where the jerk of the motion
switches, that quintic overshoots: at 125 points per second up to 1.7 times the jerk limit. The motion of
this module switches its jerk at points of the file only. Then each quintic *is* the cubic between two
points, and the file keeps the limits that the motion keeps.

The passage times are rounded up to points of the file first. With these fixed, the joints no longer
depend on each other, and each of them is a linear program: its jerk is constant on cells, its states
(position, velocity, acceleration) at the ends of the cells are variables, and the least share of the jerk
limit is asked for. Cells are one point wide where the jerk of the given motion switches, and wide elsewhere.
Velocities and positions inside a cell are bounded by their Bernstein coefficients.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import factorial

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import check
from formulations.optima.at_rate.joint_program import JointBounds, integrated, least_jerk
from formulations.optima.at_rate.points import SwitchPoints
from formulations.optima.at_rate.requests import require_exportable, require_kept
from formulations.optima.at_rate.rounding import margins
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.demands import Demands
from formulations.problem.errors import NoFeasibleMotion
from formulations.problem.problem import Problem

_EXTRA = (0, 1, 2, 4, 8, 16, 32)  # further periods per segment, tried in this order
_STRETCHES = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)  # the same where points are not tied to a rate


@dataclass(frozen=True)
class AtPoints:
    """A motion whose jerk switches at the points of a file only.

    Attributes
    ----------
    trajectory : Trajectory
        The motion; cubic on every piece.
    times : Array, shape (n_points,) [s]
        The points of the file, whole nanoseconds, the end included.
    margin : float
        Largest share of a limit that is left free for the rounding of positions and times.
    """

    trajectory: Trajectory
    times: Array
    margin: float


def at_rate(
    problem: Problem,
    trajectory: Trajectory,
    rate: float | None,
    *,
    conditions: Conditions | None = None,
) -> AtPoints:
    """Compute the motion near a given one that a file with points at a rate describes exactly.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits that the motion keeps.
    trajectory : Trajectory
        A motion that keeps them, usually the fastest one. Its passage times and switching times are the
        starting point.
    rate : float or None [1/s]
        Points per second. None: points where the jerk switches, at least so far apart that rounding does
        not matter.
    conditions : Conditions, optional
        What else was asked of the given motion.

    Returns
    -------
    AtPoints
        The motion and the times of its points. It was judged by ``check``.

    Raises
    ------
    InputError
        The rate is not positive, or asks for more than 5,000,000 points, or is so high that the
        rounding of positions hides the jerk; a moving joint has no acceleration limit; a passage time
        that was asked for lies between two points.
    NoFeasibleMotion
        No motion was found even with 32 further periods per segment.
    """
    asked = problem.conditions if conditions is None else conditions
    require_kept(asked)
    require_exportable(problem, trajectory.seconds, rate)
    if asked.ties_joints:
        return _under_tied_limits(problem, trajectory, rate, asked)
    verdict = None
    for patience in _EXTRA if rate is not None else _STRETCHES:
        grid = (
            SwitchPoints.at_rate(problem, trajectory, rate, int(patience), asked)
            if rate is not None
            else SwitchPoints.at_switches(problem, trajectory, patience, asked)
        )
        found = _solve(problem, trajectory, grid, asked)
        if found is None:
            continue
        verdict = check(problem, found.trajectory, conditions=asked)
        if verdict.feasible:
            return found
    raise _none(rate, "" if verdict is None else f"; the last one: {verdict.faults[0]}")


def _none(rate: float | None, reason: str = "") -> NoFeasibleMotion:
    points = "at the switching times" if rate is None else f"at {rate:g} points per second"
    return NoFeasibleMotion(
        f"no motion with its jerk constant between points {points} was found{reason}"
    )


def _under_tied_limits(
    problem: Problem, trajectory: Trajectory, rate: float | None, asked: Conditions
) -> AtPoints:
    """Limits on tool and torques tie the joints together: one program for all of them."""
    from formulations.optima.shared_steps.at_points import at_points

    least = 1.0 / rate if rate is not None else float(trajectory.durations.min())
    shares = margins(problem, trajectory.seconds, least)
    found = at_points(problem, trajectory, rate, asked, shares)
    if found is None:
        raise _none(rate)
    return AtPoints(*found, float(shares[:, problem.moving_joints].max(initial=0.0)))


def _solve(
    problem: Problem, trajectory: Trajectory, grid: SwitchPoints, asked: Conditions
) -> AtPoints | None:
    """All joints on one grid; None where one of them has no motion."""
    times = grid.times
    if len(times) < 2:
        return None
    shares = margins(problem, float(times[-1]), float(np.diff(times).min()))
    bounds = _Bounds.of(Demands.of(problem, asked), trajectory, shares)
    jerks = np.zeros((len(times) - 1, problem.dof))
    starts = np.zeros((3, problem.dof))
    starts[0] = bounds.waypoints[0]
    used = {0, len(times) - 1, *grid.waypoints.tolist()}
    passed = trajectory.passage_times
    for joint in range(problem.dof):
        if not np.ptp(bounds.waypoints[:, joint]) > 0.0 and not bounds.ends[:, :, joint].any():
            continue
        cells = grid.cells(_switches(trajectory, joint), passed)
        found = least_jerk(times[cells], np.searchsorted(cells, grid.waypoints), bounds.of_joint(joint))
        if found is None:
            return None
        values, starts[:, joint] = found
        jerks[:, joint] = np.repeat(values, np.diff(cells))
        used.update(cells.tolist())
    breaks = np.array(sorted(used))
    lengths = np.diff(times[breaks])
    states = integrated(lengths, jerks[breaks[:-1]], starts)[:, :-1]
    coefficients = np.stack([states[0], states[1], states[2] / 2.0, jerks[breaks[:-1]] / 6.0], axis=-1)
    motion = Trajectory(lengths, coefficients, times[grid.waypoints])
    return AtPoints(motion, times, float(shares[:, problem.moving_joints].max(initial=0.0)))


def _switches(trajectory: Trajectory, joint: int) -> Array:
    """Times at which acceleration or jerk of one joint jumps, both ends included [s]."""
    inner = trajectory.breaks[1:-1]
    own = np.zeros(len(inner), dtype=bool)
    c = trajectory.coefficients[:, joint]
    for order in (2, 3):
        powers = np.arange(order, c.shape[1])
        factors = factorial(powers) / factorial(powers - order)
        if not len(powers):
            continue
        ends = (factors * c[:, powers] * trajectory.durations[:, None] ** (powers - order)).sum(axis=1)
        starts = factors[0] * c[:, order]
        size = max(np.abs(starts).max(), np.abs(ends).max())
        own |= np.abs(starts[1:] - ends[:-1]) > 1e-6 * size
    return np.concatenate([[0.0], inner[own], [trajectory.seconds]])


@dataclass(frozen=True)
class _Bounds:
    """Limits less the margins, places and end states of the given motion, for all joints."""

    demands: Demands
    waypoints: Array  # (n_waypoints, dof), where the given motion passes them
    ends: Array  # (2 orders, 2 ends, dof): velocities and accelerations
    left: Array  # (3, dof): share of the limits

    @staticmethod
    def of(demands: Demands, trajectory: Trajectory, shares: Array) -> _Bounds:
        low, high = np.moveaxis(demands.waypoints, -1, 0)
        both = np.array([0.0, trajectory.seconds])
        ends = np.stack([trajectory.at(both, order) for order in (1, 2)])
        given = np.stack([demands.end_velocity, demands.end_acceleration])
        ends = np.clip(ends, given[..., 0], given[..., 1])  # exact where they are asked for
        if demands.cyclic:
            ends[:, 1] = ends[:, 0]
        return _Bounds(
            demands,
            np.clip(trajectory.at(trajectory.passage_times), low, high),
            ends,
            1.0 - np.minimum(shares, 0.5),
        )

    def of_joint(self, joint: int) -> JointBounds:
        demands, left, ends = self.demands, self.left[:, joint], self.ends[:, :, joint]
        velocity, acceleration = (
            demands.velocity[:, joint] * left[0],
            demands.acceleration[:, joint] * left[1],
        )
        for state, limits in zip(ends, (velocity, acceleration), strict=True):
            for end in (0, -1):  # a state that is asked for may lie on a limit
                limits[end] = min(limits[end, 0], state[end]), max(limits[end, 1], state[end])
        return JointBounds(
            waypoints=self.waypoints[:, joint],
            velocity=velocity,
            acceleration=acceleration,
            jerk=demands.jerk[:, joint] * left[2],
            position=demands.position[:, joint],
            end_velocity=ends[0],
            end_acceleration=ends[1],
            smooth=bool(np.isfinite(demands.problem.limits.jerk[joint])),
            stops=tuple(sorted(demands.conditions.stops)),
        )
