"""A motion from durations: where the relaxation is tight, the fastest one there is.

With durations fixed everything else is convex. States at the waypoints come from the program with boxes
of no width; between them each joint moves by a mixture of the two motions that go farthest forwards and
farthest backwards (``switches``) with the least share of its acceleration and jerk limits that does: it
keeps every limit as both do, and starts and ends in the same states.

Nothing rests on this: whoever uses the motion has it checked. Position limits are kept at the waypoints,
by the rows, and mostly between them, as the motion is a gentle one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from formulations.problem import Problem
from formulations.relaxation.cuts import Cuts
from formulations.relaxation.program import Program
from formulations.relaxation.reach import distance_coefficients, speed_coefficients
from formulations.relaxation.rows import Frame
from formulations.relaxation.switches import farthest, farthest_without_jerk, fastest
from formulations.relaxation.task import Task
from formulations.trajectory import Trajectory

Array = NDArray[Any]  # of floats, indices or truth values

_MARGIN = 1e-8  # by which the program's limits are shrunk, for what its tolerance leaves
_ROUNDS, _TOLERANCE = 60, 1e-9
_BISECTIONS = 20  # for the gentlest share


def motion_through(
    problem: Problem, durations: Array, cuts: Cuts, deadline: float = math.inf
) -> Trajectory | None:
    """A motion with these durations of the segments that move [s], None if there seems to be none.

    cuts: good ones for a start. deadline: of ``time.perf_counter``.
    """
    limits = problem.limits
    v, a, j = limits.derivatives * (1.0 - _MARGIN)
    shrunk = replace(problem, limits=replace(limits, velocity=v, acceleration=a, jerk=j))
    horizon = float(durations.sum()) * (1.0 + _MARGIN)
    task = Task.of(shrunk, horizon, 0.0)
    if set(problem.moving_joints) != set(task.joints.tolist()):
        return None  # a joint without a limit on acceleration or jerk would jump from speed to speed
    limit = np.broadcast_to(task.acceleration, (len(durations) + 1, len(task.joints)))
    box = np.stack([durations, durations], axis=1)
    frame = Frame(task, box, np.stack([-limit, limit], axis=-1), durations)
    program = Program(frame, cuts)
    point = program.solve(np.zeros(frame.size), rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
    if not point.converged:
        return None
    cost, box = _calmer(problem, task, frame, durations, point.x)
    program.confine(box)
    calmer = program.solve(cost, rounds=_ROUNDS, tolerance=_TOLERANCE, deadline=deadline)
    point = calmer if calmer.converged else point
    speeds, accelerations = point.x[frame.v] * task.velocity, point.x[frame.a] * task.acceleration
    return _assembled(problem, Task.of(problem, horizon), durations, speeds, accelerations)


def _calmer(
    problem: Problem, task: Task, frame: Frame, durations: Array, x: Array
) -> tuple[Array, Array]:
    """Cost and boxes that draw x, as far as the rows allow, to the speeds of a monotone interpolant.

    Between x and the wanted value the distance to it is linear.
    """
    times = np.concatenate([[0.0], np.cumsum(durations)])
    passed = np.append(task.segments, task.segments[-1] + 1)
    points = problem.waypoints[np.ix_(passed, task.joints)]
    wanted = np.zeros(frame.size)
    if len(times) > 2:
        slopes = PchipInterpolator(times, points).derivative()(times[1:-1]) / task.velocity
        wanted[frame.v[1:-1]] = slopes.clip(-1.0, 1.0)
    cost, box = np.zeros(frame.size), frame.box.copy()
    for columns in (frame.v, frame.a):
        box[columns] = np.sort(np.stack([x[columns], wanted[columns]], axis=-1), axis=-1)
        cost[columns] = np.sign(x[columns] - wanted[columns])
    return cost, box


@dataclass(frozen=True)
class _Ends:
    """All segments of all joints, (m,) each, in normalised time; jerk 0 where unlimited."""

    v0: Array
    W0: Array
    v1: Array
    W1: Array
    V: Array
    A: Array
    J: Array

    def farthest(self, sign: float, share: Array) -> tuple[Array, Array, Array]:
        """Switches (m, 6), whether it cruises, how far it goes, with a share of A and J."""
        limited = self.J > 0.0
        A, J = share * self.A, np.where(limited, share * self.J, 1.0)
        v0, W0, v1, W1 = (sign * end for end in (self.v0, self.W0, self.v1, self.W1))
        six, cruises = farthest(v0, W0, v1, W1, self.V, A, J)
        plain, cruises_plainly = farthest_without_jerk(v0, v1, self.V, A)
        six = np.where(limited[:, None], six, plain)
        cruises = np.where(limited, cruises, cruises_plainly)
        J = np.where(limited, J, 0.0)
        point = (v0, W0, v1, W1, self.V, A, J)
        both = [_dot(distance_coefficients(six, which), point) for which in (False, True)]
        return six, cruises, np.where(cruises, both[1], both[0])

    def can(self, d: Array, share: Array) -> Array:
        """Whether a displacement d can be had with a share of A and J."""
        limited = self.J > 0.0
        A, J = share * self.A, np.where(limited, share * self.J, 1.0)
        steep = np.maximum(np.abs(self.W0), np.abs(self.W1)) <= A
        for v, W in ((self.v0, self.W0), (self.v1, self.W1)):
            steep &= np.abs(v) + np.where(limited, W**2 / (2.0 * J), 0.0) <= self.V
        for sign in (1.0, -1.0):
            W0, W1 = sign * self.W0, sign * self.W1
            two = np.where(limited[:, None], fastest(W0, W1, A, J), [0.0, 1.0])
            gain = _dot(speed_coefficients(two), (W0, W1, A, np.where(limited, J, 0.0)))
            steep &= sign * (self.v1 - self.v0) <= gain
            steep &= sign * d <= self.farthest(sign, share)[2]
        return np.asarray(steep)

    def gentlest(self, d: Array) -> Array:
        """The least share of A and J with which a displacement d can be had, (m,)."""
        low, high = np.zeros_like(d), np.ones_like(d)
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            can = self.can(d, middle)
            low, high = np.where(can, low, middle), np.where(can, middle, high)
        return high


def _dot(coefficients: tuple[Array, ...], point: tuple[Array, ...]) -> Array:
    return np.asarray(sum(c * p for c, p in zip(coefficients, point, strict=True)))


def _assembled(problem: Problem, task: Task, durations: Array, v: Array, a: Array) -> Trajectory:
    K, n = task.displacements.shape
    T = np.repeat(durations, n)
    limits = [np.tile(limit, K) for limit in (task.velocity, task.acceleration, task.jerk)]
    v0, a0, v1, a1 = (part.ravel() for part in (v[:-1], a[:-1], v[1:], a[1:]))
    V, A, J = limits[0] * T, limits[1] * T**2, limits[2] * T**3
    ends = _Ends(v0 * T, a0 * T**2, v1 * T, a1 * T**2, V, A, J)
    d = task.displacements.ravel()
    share = ends.gentlest(d)
    ways = [_way(ends, sign, share) for sign in (1.0, -1.0)]
    lengths, pieces, passages = [], [], np.zeros(problem.n_segments + 1)
    for row, k in enumerate(task.segments):
        mine = slice(row * n, (row + 1) * n)
        start = problem.waypoints[k]
        breaks, values = _mixed([(b[mine], w[mine]) for b, w in ways], ends, mine, d[mine])
        h = np.diff(breaks) * durations[row]
        coefficients = np.zeros((len(h), problem.dof, 4))
        coefficients[:, :, 0] = start
        for i, j in enumerate(task.joints):
            limited = task.jerk[i] > 0.0
            value = values[:, i] / durations[row] ** (3 if limited else 2)
            coefficients[:, j] = _integrated(h, start[j], v[row, i], a[row, i], value, limited)
        lengths.append(h)
        pieces.append(coefficients)
        passages[k + 1] = h.sum()
    return Trajectory(np.concatenate(lengths), np.concatenate(pieces), np.cumsum(passages))


def _way(ends: _Ends, sign: float, share: Array) -> tuple[Array, Array]:
    """Breaks (m, 8) of the farthest motion, and its jerks, or accelerations, between them (m, 7)."""
    six, cruises, _ = ends.farthest(sign, share)
    limited = ends.J > 0.0
    pattern = np.where(
        limited[:, None], [1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0]
    )
    pattern[:, 3] = np.where(cruises | ~limited, 0.0, -1.0)
    m = len(share)
    breaks = np.concatenate([np.zeros((m, 1)), six, np.ones((m, 1))], axis=1)
    return breaks, pattern * (sign * share * np.where(limited, ends.J, ends.A))[:, None]


def _mixed(ways: list[tuple[Array, Array]], ends: _Ends, mine: slice, d: Array) -> tuple[Array, Array]:
    """Breaks (m + 1,) common to all joints, and the mixture that covers d, (m, n)."""
    limited = ends.J[mine] > 0.0
    most, least = (_covered(b, w, ends.v0[mine], ends.W0[mine], limited) for b, w in ways)
    spread = most - least
    share = np.where(spread > 0.0, (d - least) / np.where(spread > 0.0, spread, 1.0), 0.5)
    breaks = np.unique(np.concatenate([b.ravel() for b, _ in ways]))
    breaks = np.append(breaks[:-1][np.diff(breaks) > 1e-12], 1.0)
    middles = 0.5 * (breaks[1:] + breaks[:-1])
    found = np.zeros((len(middles), len(d)))
    for (b, w), part in zip(ways, (share, 1.0 - share), strict=True):
        for j in range(len(d)):
            which = np.clip(np.searchsorted(b[j], middles) - 1, 0, 6)
            found[:, j] += part[j] * w[j, which]
    return breaks, found


def _covered(breaks: Array, values: Array, v: Array, a: Array, limited: Array) -> Array:
    """Displacement from jerks, or accelerations, between breaks: (m,)."""
    x = np.zeros_like(v)
    for h, value in zip(np.diff(breaks).T, values.T, strict=True):
        a = np.where(limited, a, value)
        j = np.where(limited, value, 0.0)
        x = x + h * (v + h * (a / 2.0 + h * j / 6.0))
        v, a = v + h * (a + h * j / 2.0), a + h * j
    return x


def _integrated(h: Array, x: float, v: float, a: float, values: Array, limited: bool) -> Array:
    """Coefficients (m, 4) of one joint from its jerks, or accelerations."""
    found = np.zeros((len(h), 4))
    for i, (step, value) in enumerate(zip(h, values, strict=True)):
        a, j = (a, value) if limited else (value, 0.0)
        found[i] = x, v, a / 2.0, j / 6.0
        x += step * (v + step * (a / 2.0 + step * j / 6.0))
        v += step * (a + step * j / 2.0)
        a += step * j
    return found
