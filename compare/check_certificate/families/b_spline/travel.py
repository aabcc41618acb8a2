"""What holds for every motion cuts boxes of waypoint times: how far a joint gets in a segment.

Lemma. A motion of duration T whose acceleration stays within A and whose speed is at most V, v0 at its start
and v1 at its end (positive in its direction), covers at most

    G(v0, v1, T) = int_0^T min(V, v0 + A t, v1 + A (T - t)) dt,

which grows with v0 and v1. With s = v0 + v1 and z = |v0 - v1|, G is
    V T - ((V - v0)^2 + (V - v1)^2) / (2 A)     if 2 V - s <= A T,
    min(v0, v1) T + A T^2 / 2                   if A T <= z,
    s T / 2 + A T^2 / 4 - z^2 / (4 A)           between.
G is convex in T, since its slope V, min(v0, v1) + A T or (s + A T) / 2 grows and does not jump; and G = 0 at
T = 0. So if G < d at T, every shorter duration is too short for the displacement d; and if G < d at both
ends of an interval of durations, d is out of reach in all of them.

Rounding. Every intermediate value is at most 2 V T where the case applies, and cases that rounding confuses
differ by at most (8 u V)^2 / A. So ``_reach`` adds 2^-47 V (T + 2^-50 V / A). Roots are computed anyhow,
moved inward, and used only if G, rounded up, is below d there.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

_MORE = 1.0 + 2.0**-50


class Travel(NamedTuple):
    """The task: least, sign (n, joints) of the displacements; speed, acceleration (joints,), bounds."""

    least: Any
    sign: Any
    speed: Any
    acceleration: Any


# no number comes of a root that is not there: it fails every comparison
@np.errstate(all="ignore")
def cut(task: Travel, lo: Any, hi: Any) -> Any:
    """Cut boxes by what every joint can cover in every segment.

    Parameters
    ----------
    task : Travel
        Displacements and bounds, rounded outward.
    lo, hi : ndarray, shape (n+1, boxes) [s]
        Ends of the boxes; are cut.

    Returns
    -------
    ndarray of bool, shape (boxes,)
        Whether anything is left.
    """
    n, joints = task.least.shape
    shortest = np.maximum(_down(lo[1:] - hi[:-1]), 0.0)
    longest = _up(hi[1:] - lo[:-1])
    left = ~(longest <= 0.0).any(axis=0)  # what is no number proves nothing
    longest = np.maximum(longest, 0.0)
    for j in range(joints):
        most = np.full_like(lo, task.speed[j])
        most[0] = most[-1] = 0.0
        velocities = [-most, most]
        for k in (*range(n), *range(n - 1, -1, -1)):
            left &= _cut_segment(task, j, k, shortest, longest, velocities)
    for k in range(1, n):
        lo[k] = np.maximum(lo[k], _down(lo[k - 1] + shortest[k - 1]))
    for k in range(n - 1, 0, -1):
        hi[k] = np.minimum(hi[k], _up(hi[k + 1] - shortest[k]))
    return left & ~(lo > hi).any(axis=0) & ~(_down(lo[n - 1] + shortest[n - 1]) > hi[n])


def _down(x: Any) -> Any:
    return x - np.abs(x) * 2.0**-52


def _up(x: Any) -> Any:
    return x + np.abs(x) * 2.0**-52


def _cut_segment(task: Travel, j: int, k: int, shortest: Any, longest: Any, velocities: Any) -> Any:
    """Cut duration k and both its end velocities for one joint; returns which boxes may hold a motion."""
    v_lo, v_hi = velocities
    V, A, d = task.speed[j], task.acceleration[j], task.least[k, j]
    change = A * longest[k] * _MORE
    for i, o in ((k, k + 1), (k + 1, k)):
        v_lo[i] = np.maximum(v_lo[i], _down(v_lo[o] - change))
        v_hi[i] = np.minimum(v_hi[i], _up(v_hi[o] + change))
    left = ~(v_lo[k] > v_hi[k]) & ~(v_lo[k + 1] > v_hi[k + 1])
    if not d > 0.0:
        return left
    # in the direction of the displacement
    slow, fast = (v_lo, v_hi) if task.sign[k, j] > 0.0 else (-v_hi, -v_lo)
    for i, o in ((k, k + 1), (k + 1, k)):
        slow[i] = _slowest(d, slow[i], fast[o], (shortest[k], longest[k]), V, A)
        left &= ~(slow[i] > fast[i])
    left &= ~(_reach(fast[k], fast[k + 1], longest[k], V, A) < d)
    shortest[k] = _shortest(d, fast[k], fast[k + 1], shortest[k], V, A)
    velocities[:] = (slow, fast) if task.sign[k, j] > 0.0 else (-fast, -slow)
    return left


def _reach(v0: Any, v1: Any, T: Any, V: float, A: float) -> Any:
    """G, rounded up."""
    if np.isinf(A):
        return V * T * _MORE
    s, apart = v0 + v1, np.abs(v0 - v1)
    full = V * T - ((V - v0) ** 2 + (V - v1) ** 2) / (2.0 * A)
    steep = (np.minimum(v0, v1) + 0.5 * A * T) * T
    between = (0.5 * s + 0.25 * A * T) * T - apart * apart / (4.0 * A)
    G = np.where(2.0 * V - s <= A * T, full, np.where(apart >= A * T, steep, between))
    return G + 2.0**-47 * V * (T + 2.0**-50 * V / A)


def _shortest(d: float, v0: Any, v1: Any, lo: Any, V: float, A: float) -> Any:
    """A duration that T exceeds, at least lo."""
    if np.isinf(A):
        T = np.full_like(lo, d / V)
    else:
        s, apart, slow = v0 + v1, np.abs(v0 - v1), np.minimum(v0, v1)
        far = d + apart * apart / (4.0 * A)
        steep = 2.0 * d / (slow + np.sqrt(slow * slow + 2.0 * A * d))
        between = 2.0 * far / (0.5 * s + np.sqrt(0.25 * s * s + A * far))
        full = (d + ((V - v0) ** 2 + (V - v1) ** 2) / (2.0 * A)) / V
        T = np.where(A * steep <= apart, steep, np.where(A * between <= 2.0 * V - s, between, full))
    T = T * (1.0 - 2.0**-44 * (1.0 + V * T / d))
    return np.where((lo < T) & (_reach(v0, v1, T, V, A) < d), T, lo)


def _slowest(d: float, v: Any, other: Any, durations: tuple[Any, Any], V: float, A: float) -> Any:
    """A velocity that v0 exceeds if v1 <= other and T is between two durations; v0 >= v is known."""
    if np.isinf(A):  # velocities do not matter
        return np.where(_reach(v, other, durations[1], V, A) < d, V, v)
    root = np.full_like(v, V)
    for T in durations:
        steep = (d - 0.5 * A * T * T) / T
        room = 2.0 * (A * T) ** 2 - 4.0 * A * (d - other * T)
        between = other + A * T - np.sqrt(np.maximum(room, 0.0))
        rest = 2.0 * A * (V * T - d) - (V - other) ** 2
        full = V - np.sqrt(np.maximum(rest, 0.0))
        best = np.where(2.0 * V - between - other >= A * T, between, full)
        best = np.where((T > 0.0) & (steep <= other - A * T), steep, np.where(room > 0.0, best, V))
        root = np.minimum(root, best)
    for margin in (0.0, 2.0**-44 * V, np.sqrt(2.0**-44 * A * V * durations[1])):
        found = root - margin
        sure = found > v
        for T in durations:
            sure &= _reach(found, other, T, V, A) < d
        v = np.where(sure, found, v)
    return v
