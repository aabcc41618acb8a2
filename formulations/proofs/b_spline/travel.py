"""What holds for every motion cuts a box of durations: how far a joint gets in a segment.

Lemma. A motion of duration T with |acceleration| <= A, speed <= V and end velocities at most v0, v1 <= V
(positive in its direction) covers at most R, the integral of min(V, v0 + A t, v1 + A (T - t)):

    V T - ((V - v0)^2 + (V - v1)^2) / (2 A)                     if it can reach the speed V,
    (v0 + v1) T / 2 + A T^2 / 4 - (v1 - v0)^2 / (4 A)           if 2 V - v0 - v1 > A T >= |v1 - v0|,
    min(v0, v1) T + A T^2 / 2                                   if |v1 - v0| > A T: the faster end is out of
                                                                reach of the slower one.

R is convex in T (its slope grows from one case to the next) with R = 0 at T = 0, and it grows with
v0 and v1. So if R < d at T = t, every T <= t is too short for the displacement d; and if R < d at both
ends of an interval of T, then d is out of reach for all of it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.arithmetic.outward import down, up

_SWEEPS = 2  # forth and back along the segments
_HALVINGS = 10  # of the interval in which a root is looked for


@compiled
def reach(v0: float, v1: float, T: float, V: float, A: float) -> float:
    """How far a joint gets at most.

    Parameters
    ----------
    v0, v1 : float [rad/s]
        End velocities, at most V.
    T : float [s]
        Duration.
    V, A : float
        Bounds of speed and acceleration.

    Returns
    -------
    float [rad]
        R, rounded up.
    """
    if np.inf == A:
        return up(V * T)
    u0, u1 = max(down(V - v0), 0.0), max(down(V - v1), 0.0)
    if up(up(V - v0) + up(V - v1)) <= down(A * T):
        lost = down(down(u0 * u0) + down(u1 * u1))
        return up(up(V * T) - down(lost / up(2.0 * A)))
    apart = max(down(abs(v1 - v0)), 0.0)
    if apart > up(A * T):
        return min(up(V * T), up(up(min(v0, v1) * T) + up(up(0.5 * A * T) * T)))
    lost = max(down(down(apart * apart) / up(4.0 * A)), 0.0)
    gained = up(up(0.5 * up(v0 + v1) * T) + up(up(0.25 * A * T) * T))
    return min(up(V * T), up(gained - lost))


@compiled
def _slowest(d: float, v: float, other: float, lo: float, hi: float, V: float, A: float) -> float:
    """A velocity that v0 exceeds if v1 <= other and T is in [lo, hi]; v0 >= v is known."""
    if max(reach(v, other, lo, V, A), reach(v, other, hi, V, A)) >= d:
        return v
    top = V
    for _ in range(_HALVINGS):
        middle = 0.5 * (v + top)
        if max(reach(middle, other, lo, V, A), reach(middle, other, hi, V, A)) < d:
            v = middle
        else:
            top = middle
    return v


@compiled
def _shortest(d: float, v0: float, v1: float, lo: float, hi: float, V: float, A: float) -> float:
    """A duration that T exceeds; T >= lo is known, and hi is long enough."""
    if reach(v0, v1, lo, V, A) >= d:
        return lo
    for _ in range(_HALVINGS):
        middle = 0.5 * (lo + hi)
        if reach(v0, v1, middle, V, A) < d:
            lo = middle
        else:
            hi = middle
    return lo


@compiled
def cut_by_travel(
    lo: Any, hi: Any, shortest: Any, longest: Any, data: Any, v_lo: Any, v_hi: Any
) -> bool:
    """Cut a box of waypoint times by what every joint can cover in every segment.

    Parameters
    ----------
    lo, hi : ndarray, shape (n+1,) [s]
        The box; is cut.
    shortest, longest : ndarray, shape (n,) [s]
        Are filled: the durations that are left.
    data : SplineData
        The task.
    v_lo, v_hi : ndarray, shape (n+1,)
        Scratch.

    Returns
    -------
    bool
        False if nothing is left.
    """
    n, dof = data.least.shape
    for k in range(n):
        shortest[k], longest[k] = max(down(lo[k + 1] - hi[k]), 0.0), up(hi[k + 1] - lo[k])
        if not longest[k] > 0.0:
            return False
    for j in range(dof):
        for i in range(n + 1):
            v_hi[i] = 0.0 if i == 0 or i == n else data.speed[j]
            v_lo[i] = -v_hi[i]
        for sweep in range(_SWEEPS):
            for step in range(n):
                k = step if sweep % 2 == 0 else n - 1 - step
                if not _cut_segment(j, k, shortest, longest, data, v_lo, v_hi):
                    return False
    for k in range(1, n):
        lo[k] = max(lo[k], down(lo[k - 1] + shortest[k - 1]))
    for k in range(n - 1, 0, -1):
        hi[k] = min(hi[k], up(hi[k + 1] - shortest[k]))
    for k in range(1, n):
        if not lo[k] <= hi[k]:
            return False
    return bool(down(lo[n - 1] + shortest[n - 1]) <= hi[n])


@compiled
def _cut_segment(j: int, k: int, shortest: Any, longest: Any, data: Any, v_lo: Any, v_hi: Any) -> bool:
    """Cut duration k and both its end velocities for one joint."""
    V, A = data.speed[j], data.acceleration[j]
    change = up(A * longest[k])
    for side in range(2):
        i, o = k + side, k + 1 - side
        v_lo[i], v_hi[i] = max(v_lo[i], down(v_lo[o] - change)), min(v_hi[i], up(v_hi[o] + change))
        if v_lo[i] > v_hi[i]:
            return False
    d, onward = data.least[k, j], data.sign[k, j] > 0.0
    if not d > 0.0:
        return True
    for side in range(2):
        i, o = k + side, k + 1 - side
        if onward:
            v_lo[i] = _slowest(d, v_lo[i], v_hi[o], shortest[k], longest[k], V, A)
        else:
            v_hi[i] = -_slowest(d, -v_hi[i], -v_lo[o], shortest[k], longest[k], V, A)
        if v_lo[i] > v_hi[i]:
            return False
    a, b = (v_hi[k], v_hi[k + 1]) if onward else (-v_lo[k], -v_lo[k + 1])
    if reach(a, b, longest[k], V, A) < d:
        return False
    shortest[k] = _shortest(d, a, b, shortest[k], longest[k], V, A)
    return True
