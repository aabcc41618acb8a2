"""Separation: the rows that cut a given point off, for every segment, joint and sign.

Of each kind that row is proposed which the point violates most; those that it violates are kept.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from formulations.problem.arrays import Array, Indices
from formulations.proofs.every_motion.relaxation.cuts import PEAKS, PRODUCTS, STOPS, ZONES, Cuts, Kind
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.switches import (
    farthest,
    farthest_without_jerk,
    fastest,
    soonest_stop,
)

Proposal = tuple[Kind, Cuts]  # cuts that are all of this kind


def separate(frame: Frame, x: Array, tolerance: float) -> Cuts:
    """Find the cuts that a point violates.

    Parameters
    ----------
    frame : Frame
    x : Array, shape (size,)
    tolerance : float
        A cut is kept if its row is violated by more, in units of the variables.

    Returns
    -------
    Cuts
    """
    proposed = [*_durations(frame, x), *_products(frame), *_zones(frame), *_peaks(frame, x)]
    proposed += [*_reach(frame, x), *_stops(frame, x)]
    kept = [
        cuts[frame.terms(kind, cuts).violated(x, tolerance)] for kind, cuts in proposed if len(cuts)
    ]
    return Cuts.joined([Cuts.none(), *kept])


def _durations(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (7) at T itself, rows (8) at their deepest: t = (h - T) / (h / T - 1)."""
    T, inverse, h = x[frame.T], x[frame.inverse], frame.high
    t = (h - T) / np.maximum(h * inverse - 1.0, 1e-300)
    k = np.arange(frame.K)
    for kind, at in ((Kind.TANGENT, T), (Kind.HULL, np.clip(t, frame.low, h))):
        yield kind, Cuts.of(kind, k, at * frame.typical)


def _products(frame: Frame) -> Iterator[Proposal]:
    """Rows (9) in all four corners, except where the acceleration is fixed at 0."""
    moves = (frame.a_low != 0.0) | (frame.a_high != 0.0)
    for kind in PRODUCTS:
        k, j = np.nonzero(moves[kind.end : frame.K + kind.end])
        yield kind, _corners(kind, k, j)


def _zones(frame: Frame) -> Iterator[Proposal]:
    """Rows (11) in all four corners."""
    for kind in ZONES:
        k, j = np.nonzero(frame.p[:, :, kind.end] >= 0)
        yield kind, _corners(kind, k, j)


def _corners(kind: Kind, k: Indices, j: Indices) -> Cuts:
    return Cuts.of(kind, np.tile(k, 4), np.repeat(np.arange(4.0), len(k)), np.tile(j, 4))


def _peaks(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (10) at the ratio W / T^2 of the point."""
    joints = np.flatnonzero(frame.relaxed.has_jerk)
    for kind in PEAKS:
        k, j = _grid(frame.K, joints)
        unit = frame.relaxed.acceleration[j] / frame.typical[k]
        at = x[frame.W[k, j, kind.end]] / x[frame.square[k]] * unit
        yield kind, Cuts.of(kind, k, at, j, np.sign(x[frame.v[k + kind.end, j]]))


def _reach(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (1) and (2) at the switches of the motion that goes farthest or gains most speed."""
    has_jerk = frame.relaxed.has_jerk
    for limited in (True, False):
        k, j = _grid(frame.K, np.flatnonzero(has_jerk == limited))
        if not len(k):
            continue
        k, j, sign = np.tile(k, 2), np.tile(j, 2), np.repeat((1.0, -1.0), len(k))
        forwards = (sign > 0.0).astype(np.intp)
        ramp, J = frame.ramp[k, j], frame.bend[k, j] * x[frame.square[k]]
        v0, v1 = sign * x[frame.v[k, j]], sign * x[frame.v[k + 1, j]]
        W0, W1 = (sign * ramp * x[frame.W[k, j, end]] for end in (0, 1))
        A, B = (frame.ramps[k, j, side] * x[frame.T[k]] for side in (forwards, 1 - forwards))
        A, B = np.maximum(A, np.maximum(W0, W1)), np.maximum(B, np.maximum(-W0, -W1))
        top = frame.top[k, j, forwards]
        if limited:
            six, cruises = farthest(v0, W0, v1, W1, top, A, J, down=B)
            two = fastest(W0, W1, A, J)
        else:
            six, cruises = farthest_without_jerk(v0, v1, top, A, down=B)
            two = np.stack([0.0 * A, np.ones_like(A)], axis=1)
        for kind, which in ((Kind.CRUISE, cruises), (Kind.DISTANCE, ~cruises)):
            yield kind, Cuts.of(kind, k[which], six[which], j[which], sign[which])
        yield Kind.SPEED, Cuts.of(Kind.SPEED, k, two, j, sign)


def _stops(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (3) at the switches of the soonest stop, where there is a position limit."""
    jerk = np.where(frame.relaxed.has_jerk, frame.bend, np.inf) * x[frame.square][:, None]
    for kind in STOPS:
        k, j, side = np.nonzero(np.isfinite(frame.room[:, kind.end]))
        if not len(k):
            continue
        # the joint goes towards the limit, or comes from there where time is reversed
        turned = -1.0 if kind.end else 1.0
        sign = turned * np.where(side == 1, 1.0, -1.0)
        v, W = sign * x[frame.v[k + kind.end, j]], turned * sign * x[frame.W[k, j, kind.end]]
        A = np.maximum(frame.ramps[k, j, 1 - side] * x[frame.T[k]], 1e-300)
        two = soonest_stop(v, W * frame.ramp[k, j], A, jerk[k, j])
        yield kind, Cuts.of(kind, k, two, j, sign)


def _grid(K: int, joints: Indices) -> tuple[Indices, Indices]:
    """All pairs of a segment and one of the joints."""
    return np.repeat(np.arange(K), len(joints)), np.tile(joints, K)
