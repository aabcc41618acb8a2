"""The motion between given waypoint states: where the relaxation is tight, the fastest motion of all.

In each segment, each joint moves by a mixture of the two motions that go farthest forwards and farthest
backwards (``switches``), with the least share of its acceleration and jerk limits that suffices. The
mixture keeps every limit, as both motions do, and it starts and ends in the same states.

Position limits are kept at the waypoints, by the rows, and mostly between them, since the motion is a
gentle one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array, Truths
from formulations.problem.problem import Problem
from formulations.proofs.every_motion.attaining_motion.states import WaypointStates
from formulations.proofs.every_motion.relaxation.reach import distance_coefficients, speed_coefficients
from formulations.proofs.every_motion.relaxation.switches import (
    farthest,
    farthest_without_jerk,
    fastest,
)

_STEPS = 60  # of Newton's method: enough for the last digit
_CLOSE = 1e-12  # breaks closer than this, in normalised time, are one
_BISECTIONS = 20  # for the least share of the limits

# between the switches: jerk in units of its limit; acceleration in units of its limit without one
_JERKS = (1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0)
_ACCELERATIONS = (0.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0)


def connect(problem: Problem, durations: Array, states: WaypointStates) -> Trajectory | None:
    """Connect waypoint states by a motion, which is still to be checked.

    Parameters
    ----------
    problem : Problem
    durations : Array, shape (K,) [s]
        Of the segments that move.
    states : WaypointStates

    Returns
    -------
    Trajectory or None
        None if a joint moves that has a velocity limit only (its velocity would jump), or if the
        numbers overflow.
    """
    relaxed, v, a = states.relaxed, states.velocities, states.accelerations
    if set(problem.moving_joints) != set(relaxed.joints.tolist()):
        return None
    T = durations[:, None]
    ends = _Ends(
        *(v[:-1] * T, a[:-1] * T**2, v[1:] * T, a[1:] * T**2),
        *(relaxed.velocity * T, relaxed.acceleration * T**2, relaxed.jerk * T**3),
    )
    ways = _ways(ends, relaxed.displacements)
    lengths, pieces, passages = [], [], np.zeros(problem.n_segments + 1)
    for row, k in enumerate(relaxed.segments):
        breaks, values = _mixed([(switches[row], bends[row]) for switches, bends in ways])
        h = np.diff(breaks)
        coefficients = np.zeros((len(h), problem.dof, 4))
        coefficients[:, :, 0] = problem.waypoints[k]
        moved = _integrated(h, problem.waypoints[k, relaxed.joints], ends.of(row), values)
        coefficients[:, relaxed.joints] = moved / durations[row] ** np.arange(4)
        lengths.append(h * durations[row])
        pieces.append(coefficients)
        passages[k + 1] = lengths[-1].sum()
    moves = np.concatenate(pieces)
    if not np.isfinite(moves).all():
        return None
    return Trajectory(np.concatenate(lengths), moves, np.cumsum(passages))


def connecting_arcs(
    durations: Array, v: Array, a: Array, displacements: Array, limits: tuple[Array, Array, Array]
) -> tuple[Array, Array]:
    """Connect waypoint states joint by joint.

    Parameters
    ----------
    durations : Array, shape (K,) [s]
    v, a : Array, shape (K + 1, n)
        States at the waypoints [rad/s, rad/s^2].
    displacements : Array, shape (K, n) [rad]
    limits : tuple of Array, shape (K, n)
        Of velocity, acceleration and jerk on each segment; jerk is 0 where unlimited.

    Returns
    -------
    times : Array, shape (K, n, 13) [s]
        Of the arcs of each joint.
    tops : Array, shape (K, n, 13)
        Their jerk, or acceleration where jerk is unlimited.
    """
    T = durations[:, None]
    V, A, J = limits
    ends = _Ends(v[:-1] * T, a[:-1] * T**2, v[1:] * T, a[1:] * T**2, V * T, A * T**2, J * T**3)
    ways = _ways(ends, displacements)
    inner = np.sort(np.concatenate([switches[..., 1:-1] for switches, _ in ways], axis=-1), axis=-1)
    outer = np.zeros((*inner.shape[:-1], 1))
    breaks = np.clip(np.concatenate([outer, inner, outer + 1.0], axis=-1), 0.0, 1.0)
    middles = 0.5 * (breaks[..., :-1] + breaks[..., 1:])
    tops = np.zeros(middles.shape)
    for switches, values in ways:
        piece = (middles[..., None] > switches[..., None, 1:-1]).sum(axis=-1)
        tops += np.take_along_axis(values, piece, axis=-1)
    order = np.where(J > 0.0, 3, 2)[..., None]
    return np.diff(breaks, axis=-1) * T[..., None], tops / T[..., None] ** order


@dataclass(frozen=True)
class _Ends:
    """States and limits of all joints in normalised time, (n,) or (K, n); J is 0 where unlimited."""

    v0: Array
    W0: Array
    v1: Array
    W1: Array
    V: Array
    A: Array
    J: Array

    @property
    def limited(self) -> Truths:
        return self.J > 0.0

    def of(self, row: int) -> _Ends:
        """The states and limits of one segment."""
        return _Ends(*(end[row] for end in vars(self).values()))

    def farthest(self, sign: float, share: Array) -> tuple[Array, Truths, Array]:
        """Switches (..., 6), whether the joint cruises, and its distance, with a share of A and J."""
        A, J = share * self.A, np.where(self.limited, share * self.J, 1.0)
        ends = (sign * end for end in (self.v0, self.W0, self.v1, self.W1))
        v0, W0, v1, W1, V, A, J = (x.ravel() for x in (*ends, self.V, A, J))
        six, cruises = farthest(v0, W0, v1, W1, V, A, J, _STEPS)
        plain, plainly = farthest_without_jerk(v0, v1, V, A)
        limited = self.limited.ravel()
        six, cruises = np.where(limited[:, None], six, plain), np.where(limited, cruises, plainly)
        point = [v0, W0, v1, W1, V, A, np.where(limited, J, 0.0)]
        turns, stays = (_sum(distance_coefficients(six, which), point) for which in (False, True))
        shape = share.shape
        distance = np.where(cruises, stays, turns).reshape(shape)
        return six.reshape(*shape, 6), cruises.reshape(shape), distance

    def can(self, d: Array, share: Array) -> Truths:
        """Whether a share of A and J suffices for a displacement d."""
        A, J = share * self.A, np.where(self.limited, share * self.J, 1.0)
        can = np.maximum(np.abs(self.W0), np.abs(self.W1)) <= A
        for v, W in ((self.v0, self.W0), (self.v1, self.W1)):
            can &= np.abs(v) + np.where(self.limited, W**2 / (2.0 * J), 0.0) <= self.V
        for sign in (1.0, -1.0):
            W0, W1, A_, J_ = (x.ravel() for x in (sign * self.W0, sign * self.W1, A, J))
            gain = _sum(speed_coefficients(fastest(W0, W1, A_, J_)), [W0, W1, A_, J_])
            gain = np.where(self.limited, gain.reshape(A.shape), A)
            can &= sign * (self.v1 - self.v0) <= gain
            can &= sign * d <= self.farthest(sign, share)[2]
        return can

    def gentlest(self, d: Array) -> Array:
        """The least share of A and J that suffices for displacements d."""
        low, high = np.zeros_like(d), np.ones_like(d)
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            can = self.can(d, middle)
            low, high = np.where(can, low, middle), np.where(can, middle, high)
        return high


def _sum(coefficients: tuple[Array, ...], point: list[Array]) -> Array:
    return np.asarray(sum(c * x for c, x in zip(coefficients, point, strict=True)))


def _ways(ends: _Ends, d: Array) -> list[tuple[Array, Array]]:
    """The motions farthest forwards and backwards, weighted so that their sum covers d.

    Each has breaks (K, n, 8) and jerks, or accelerations, between them (K, n, 7).
    """
    share = ends.gentlest(d)
    found, covered = [], []
    for sign in (1.0, -1.0):
        six, cruises, _ = ends.farthest(sign, share)
        pattern = np.where(ends.limited[..., None], _JERKS, _ACCELERATIONS)
        pattern[..., 3] = np.where(cruises | ~ends.limited, 0.0, -1.0)
        size = sign * share * np.where(ends.limited, ends.J, ends.A)
        outer = np.zeros((*share.shape, 1))
        breaks = np.concatenate([outer, six, outer + 1.0], axis=-1)
        found.append((breaks, pattern * size[..., None]))
        covered.append(_covered(ends, *found[-1]))
    most, least = covered
    spread = np.where(most > least, most - least, 1.0)
    ahead = np.where(most > least, (d - least) / spread, 0.5)
    weights = (ahead, 1.0 - ahead)
    return [(b, w * part[..., None]) for (b, w), part in zip(found, weights, strict=True)]


def _mixed(ways: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    """Breaks (m + 1,) common to all joints of a segment, and the sum of both motions, (m, n)."""
    breaks = np.unique(np.concatenate([switches.ravel() for switches, _ in ways]))
    breaks = breaks[np.diff(breaks, prepend=-1.0) > _CLOSE]
    breaks = np.append(breaks[breaks < 1.0 - _CLOSE], 1.0)
    total = np.zeros((len(breaks) - 1, len(ways[0][0])))
    for switches, values in ways:
        # means between the common breaks, some of which replace several close ones
        sums = np.cumsum(values * np.diff(switches), axis=1)
        for j in range(total.shape[1]):
            total[:, j] += np.diff(np.interp(breaks, switches[j], np.append(0.0, sums[j])))
    return breaks, total / np.diff(breaks)[:, None]


def _covered(ends: _Ends, breaks: Array, values: Array) -> Array:
    """Displacement (K, n) due to the jerks, or accelerations, between the breaks."""
    x, v, W = np.zeros_like(ends.v0), ends.v0, ends.W0
    for i in range(values.shape[-1]):
        h, value = breaks[..., i + 1] - breaks[..., i], values[..., i]
        W, bend = np.where(ends.limited, W, value), np.where(ends.limited, value, 0.0)
        x = x + h * (v + h * (W / 2.0 + h * bend / 6.0))
        v, W = v + h * (W + h * bend / 2.0), W + h * bend
    return x


def _integrated(h: Array, x: Array, ends: _Ends, values: Array) -> Array:
    """Coefficients (m, n, 4) of pieces of durations h (m,) that start at x (n,)."""
    found = np.zeros((*values.shape, 4))
    v, W = ends.v0, ends.W0
    for i, (step, value) in enumerate(zip(h, values, strict=True)):
        W, bend = np.where(ends.limited, W, value), np.where(ends.limited, value, 0.0)
        found[i] = np.stack([x, v, W / 2.0, bend / 6.0], axis=1)
        x = x + step * (v + step * (W / 2.0 + step * bend / 6.0))
        v, W = v + step * (W + step * bend / 2.0), W + step * bend
    return found
