"""Narrower boxes of the accelerations at the waypoints, from those of the durations: no linear program.

Two segments take T and U seconds and move a joint by d and by e; a is its acceleration at the waypoint
where they meet, |jerk| <= J and K. Then

    | a - 2 (e / U - d / T) / (T + U) |  <=  (J T^2 + K U^2) / (3 (T + U)).                      (13)

Proof. By Taylor's formula at the waypoint, where the velocity is v, e = v U + a U^2 / 2 + r with
|r| <= K U^3 / 6, and d = v T - a T^2 / 2 + s with |s| <= J T^3 / 6. Divide by U and by T and subtract:
e / U - d / T = a (T + U) / 2 + r / U - s / T, and |r / U - s / T| <= (J T^2 + K U^2) / 6.

With D = T^2 U + T U^2, the upper side of (13) is N / D for N = 2 (e T - d U) + (J T^3 U + K T U^3) / 3. Over
boxes of T and U both are combinations of their Bernstein coefficients of degree 3 in T and in U, with the
same positive weights, and those of D are positive. So a <= max N_ij / D_ij; the lower side is the upper
one of -a, -d and -e. Of zones, d is the least and e the greatest there is. Moreover the acceleration changes
by at most J T over a segment.

The products (9) lose the width of a duration's interval times that of an acceleration's. Without (13)
the latter is the acceleration limit or J H / 4; short segments leave it no more than 2 J (T + U) / 3.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from formulations.problem.arrays import Array, Truths
from formulations.proofs.every_motion.relaxation.boxes import Boxes, joined_ends, with_legs
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem

_ROUNDING = 32.0 * 2.0**-53  # of the sum of all terms' moduli: more than their roundings
_UNDERFLOW = 1e-300  # more than what is lost of numbers next to 0
_SMALL = 1e-280  # a denominator above this has all its digits


def propagate(relaxed: RelaxedProblem, boxes: Boxes) -> Boxes:
    """Narrow the boxes of the accelerations without losing a motion.

    Parameters
    ----------
    relaxed : RelaxedProblem
    boxes : Boxes

    Returns
    -------
    Boxes
        Empty where an interval is.
    """
    limited = relaxed.has_jerk
    boxes = with_legs(relaxed, boxes)
    if boxes.empty or not limited.any():
        return boxes
    J, found = relaxed.jerks[: relaxed.n_segments, limited], boxes.accelerations[:, limited].copy()
    least, most = (
        _upper_sides(*_ways(relaxed, boxes, sign, limited), J, boxes.durations[: relaxed.n_segments])
        for sign in (-1.0, 1.0)
    )
    # where a number overflows the box stays as it is, and so does an acceleration that is given
    inner = found[1:-1]
    free = inner[..., 0] < inner[..., 1]
    inner[..., 0] = np.where(free, np.fmax(inner[..., 0], -least), inner[..., 0])
    inner[..., 1] = np.where(free, np.fmin(inner[..., 1], most), inner[..., 1])
    changes = boxes.durations[: relaxed.n_segments, 1, None] * J
    for k, change in enumerate(changes):
        _follow(found[k + 1], found[k], change)
    for k, change in reversed(list(enumerate(changes))):
        _follow(found[k], found[k + 1], change)
    accelerations = boxes.accelerations.copy()
    accelerations[:, limited] = found
    accelerations = joined_ends(relaxed, accelerations)
    empty = bool((accelerations[..., 0] > accelerations[..., 1]).any())
    return replace(boxes, accelerations=accelerations, empty=empty)


def _ways(relaxed: RelaxedProblem, boxes: Boxes, sign: float, joints: Truths) -> tuple[Array, Array]:
    """Least displacement before and greatest one after each inner waypoint, (K - 1, n), in one direction."""
    d = sign * relaxed.displacements[: relaxed.n_segments, joints]
    offsets = boxes.offsets[:, joints] if sign > 0.0 else -boxes.offsets[:, joints, ::-1]
    low, high = offsets[..., 0], offsets[..., 1]
    least, most = d + (low[1:] - high[:-1]), d + (high[1:] - low[:-1])
    if offsets.any():  # three roundings
        wider = (
            4.0
            * 2.0**-53
            * (np.abs(d) + np.abs(offsets).max(axis=-1)[1:] + np.abs(offsets).max(axis=-1)[:-1])
        )
        least, most = least - wider, most + wider
    return least[:-1], most[1:]


def _upper_sides(d: Array, e: Array, J: Array, durations: Array) -> Array:
    """Upper bounds of the accelerations at the inner waypoints, (K - 1, n) [rad/s^2]."""
    powers = _powers(*durations.T)
    before, after = (
        [np.moveaxis(p[:, part], 0, -1)[:, None] for p in powers]
        for part in (slice(None, -1), slice(1, None))
    )

    def product(p: int, q: int) -> Array:
        """T^p U^q: (K - 1, 1, 4, 4)."""
        return np.asarray(before[p][..., :, None] * after[q][..., None, :])

    ways = [2.0 * e[:, :, None, None] * product(1, 0), -2.0 * d[:, :, None, None] * product(0, 1)]
    jerks = J[:, :, None, None] / 3.0
    jerk = jerks[:-1] * product(3, 1) + jerks[1:] * product(1, 3)
    sizes = abs(ways[0]) + abs(ways[1]) + jerk
    below = product(2, 1) + product(1, 2)
    tops = ways[0] + ways[1] + jerk + _ROUNDING * sizes + _UNDERFLOW
    with np.errstate(divide="ignore", invalid="ignore"):  # beside a segment that may take no time
        tops = tops / below
    return np.where(below > _SMALL, tops, np.inf).max(axis=(2, 3))


def _powers(low: Array, high: Array) -> list[Array]:
    """Bernstein coefficients of degree 3 of 1, x, x^2 and x^3 over [low, high], (4, K) each."""
    first, last = (2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0
    return [
        np.ones((4, len(low))),
        np.stack([low, first, last, high]),
        np.stack([low**2, low * last, high * first, high**2]),
        np.stack([low**3, low**2 * high, low * high**2, high**3]),
    ]


def _follow(mine: Array, other: Array, change: Array) -> None:
    """Narrow the intervals (n, 2) at one end of a segment, in place, by those at its other end."""
    margin = change + _ROUNDING * (np.abs(other).max(axis=1) + change) + _UNDERFLOW
    mine[:, 0] = np.fmax(mine[:, 0], other[:, 0] - margin)
    mine[:, 1] = np.fmin(mine[:, 1], other[:, 1] + margin)
