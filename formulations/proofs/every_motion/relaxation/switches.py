"""The motion that goes farthest in one segment: where its jerk switches.

One joint from (v0, W0) to (v1, W1) in unit time, v <= V, -A' <= W <= A, |dW/ds| <= J. Raising W as fast
and lowering it as late as the ends allow puts the largest mean of v at

    W(s) = max(min(W0 + J s, A, J (c - s)), -A', W1 - J (1 - s))                                 (4)

with the unique c for which v ends at v1. If v would exceed V, the joint goes from either end to V in the
quickest way and cruises in between.

Every set of switches makes valid inequalities (``reach``); those found here make the deepest cuts.
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array, Truths

_STEPS = 12  # of Newton's method, enough for a cut


def farthest(
    v0: Array,
    W0: Array,
    v1: Array,
    W1: Array,
    V: Array,
    A: Array,
    J: Array,
    steps: int = _STEPS,
    *,
    down: Array | None = None,
) -> tuple[Array, Truths]:
    """Find the motion that goes farthest.

    Parameters
    ----------
    v0, W0, v1, W1 : Array, shape (m,)
        States at both ends.
    V, A, J : Array, shape (m,)
        Limits in unit time.
    steps : int
        Of Newton's method.
    down : Array, shape (m,), optional
        Greatest acceleration against the motion; A where it is left out.

    Returns
    -------
    switches : Array, shape (m, 6)
        Ascending in [0, 1]; of the nearest c where no motion connects the ends in unit time.
    cruises : Truths, shape (m,)
        Whether there is a piece at top speed.
    """
    both = (A, A if down is None else down)
    c = _end_speed_met(v1 - v0, W0, W1, both, J, steps)
    s1, s2, s5, s6 = _corners(c, W0, W1, both, J)
    peak = v0 + _gains(c, W0, W1, both, J)[0]
    start = _to_top_speed(v0, W0, V, both[0], J)
    end = [1.0 - s for s in _to_top_speed(v1, -W1, V, both[1], J)]
    cruises = (peak > V) & (c > 0.0) & (c < 1.0) & (start[2] <= end[2])
    six = np.where(cruises, [*start, *end[::-1]], [s1, s2, s5, s2, s5, s6])
    six = np.where(np.isfinite(six), six, 0.5).clip(0.0, 1.0).T
    plain = np.maximum.accumulate(six[:, [0, 1, 4, 5]], axis=1)[:, [0, 1, 1, 2, 2, 3]]
    return np.where(cruises[:, None], np.maximum.accumulate(six, axis=1), plain), cruises


def fastest(W0: Array, W1: Array, A: Array, J: Array) -> Array:
    """Find the motion that gains most speed: W rises with J to A, stays there, and falls with J.

    Parameters
    ----------
    W0, W1 : Array, shape (m,)
        At both ends.
    A, J : Array, shape (m,)
        Limits in unit time.

    Returns
    -------
    Array, shape (m, 2)
        Switches, ascending in [0, 1].
    """
    up, down = (A - W0) / J, 1.0 - (A - W1) / J
    middle = 0.5 * (1.0 + (W1 - W0) / J)
    apart = up <= down
    two = np.where(apart, [up, down], [middle, middle])
    two = np.where(np.isfinite(two), two, 0.5).clip(0.0, 1.0).T
    return np.maximum.accumulate(two, axis=1)


def farthest_without_jerk(
    v0: Array, v1: Array, V: Array, A: Array, *, down: Array | None = None
) -> tuple[Array, Truths]:
    """Find the motion that goes farthest without a jerk limit: accelerate, cruise, brake.

    Parameters
    ----------
    v0, v1 : Array, shape (m,)
        Velocities at both ends.
    V, A : Array, shape (m,)
        Limits in unit time.
    down : Array, shape (m,), optional
        Greatest acceleration against the motion; A where it is left out.

    Returns
    -------
    switches : Array, shape (m, 6)
        Ascending in [0, 1].
    cruises : Truths, shape (m,)
        Whether there is a piece at top speed.
    """
    B = A if down is None else down
    up, fall = (V - v0) / A, 1.0 - (V - v1) / B
    middle = (B + (v1 - v0)) / (A + B)
    middle = np.where(np.isfinite(middle), middle, 0.5)
    cruises = up < fall
    up = np.where(cruises, up, middle).clip(0.0, 1.0)
    fall = np.maximum(np.where(cruises, fall, middle).clip(0.0, 1.0), up)
    zero, one = np.zeros_like(up), np.ones_like(up)
    return np.stack([zero, up, up, fall, fall, one], axis=1), cruises


def soonest_stop(v0: Array, W0: Array, A: Array, J: Array) -> Array:
    """Find the soonest stop: W falls with J to -A and stays there until v = 0.

    Parameters
    ----------
    v0, W0 : Array, shape (m,)
        The state to stop from.
    A, J : Array, shape (m,)
        Limits in unit time, A of the acceleration against the motion; with an infinite J, W is -A at once.

    Returns
    -------
    Array, shape (m, 2)
        Switches, ascending in [0, 1].
    """
    speed, plain = np.maximum(v0, 0.0), np.isinf(J)
    J = np.where(plain, 1.0, J)
    stop, at_limit = (W0 + np.sqrt(W0**2 + 2.0 * J * speed)) / J, (W0 + A) / J
    left = speed + (W0**2 - A**2) / (2.0 * J)
    s1 = np.where(plain, 0.0, np.minimum(stop, at_limit))
    s2 = np.where(stop > at_limit, at_limit + np.maximum(left, 0.0) / A, stop)
    s2 = np.where(plain, speed / A, s2)
    return np.maximum.accumulate(np.stack([s1, s2], axis=1).clip(0.0, 1.0), axis=1)


def _end_speed_met(
    gain: Array, W0: Array, W1: Array, both: tuple[Array, Array], J: Array, steps: int
) -> Array:
    """The c of (4) that gains this much speed: Newton's method, and bisection outside its bracket."""
    low = W0 / J
    high = np.maximum(1.0 + W1 / J, low)
    c = 0.5 * (low + high)
    for _ in range(steps):
        s2, s5 = _corners(c, W0, W1, both, J)[1:3]
        excess = _gains(c, W0, W1, both, J)[1] - gain
        low, high = np.where(excess < 0.0, c, low), np.where(excess > 0.0, c, high)
        step = c - excess / np.maximum(J * (s5 - s2), 1e-300)
        c = np.where((step >= low) & (step <= high), step, 0.5 * (low + high))
    return c


def _corners(
    c: Array, W0: Array, W1: Array, both: tuple[Array, Array], J: Array
) -> tuple[Array, Array, Array, Array]:
    """Breaks of (4): W is A from s1 to s2 and -A' from s5 to s6; both: A and A'."""
    A, B = both
    s1, s2, middle = (A - W0) / J, c - A / J, 0.5 * (c - W0 / J)
    s1, s2 = np.where(s2 < s1, middle, s1), np.where(s2 < s1, middle, s2)
    s5, s6, middle = c + B / J, 1.0 - (B + W1) / J, 0.5 * (c + 1.0 - W1 / J)
    return s1, s2, np.where(s5 > s6, middle, s5), np.where(s5 > s6, middle, s6)


def _gains(c: Array, W0: Array, W1: Array, both: tuple[Array, Array], J: Array) -> tuple[Array, Array]:
    """Integral of (4) up to its zero at c, and up to 1."""
    s1, s2, s5, s6 = _corners(c, W0, W1, both, J)
    high, low = W0 + J * s1, W1 - J * (1.0 - s6)
    first = 0.5 * (W0 + high) * s1 + high * (s2 - s1)
    to_zero = first + 0.5 * high * (c - s2)
    rest = 0.5 * (high + low) * (s5 - s2) + low * (s6 - s5) + 0.5 * (low + W1) * (1.0 - s6)
    return to_zero, first + rest


def _to_top_speed(v: Array, W: Array, V: Array, A: Array, J: Array) -> list[Array]:
    """Ends of the pieces of jerk J, 0, -J of the quickest way from (v, W) to (V, 0)."""
    peak = np.maximum(np.sqrt(np.maximum(J * (V - v) + 0.5 * W * W, 0.0)), np.maximum(W, 0.0))
    at_limit = peak > A
    peak = np.minimum(peak, A)
    hold = np.where(at_limit, (V - v - (A * A - 0.5 * W * W) / J) / A, 0.0)
    s1 = (peak - W) / J
    return [s1, s1 + hold, s1 + hold + peak / J]
