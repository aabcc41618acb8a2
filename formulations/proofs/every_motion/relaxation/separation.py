"""Separation: the rows that cut a given point off, for every segment, joint and sign.

Of each kind that row is proposed which the point violates most; those that it violates are kept.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from formulations.problem.arrays import Array, Indices
from formulations.proofs.every_motion.relaxation.cuts import (
    FADES,
    PEAKS,
    PRODUCTS,
    SPEED_PRODUCTS,
    SQUARE_PRODUCTS,
    STOPS,
    ZONES,
    Cuts,
    Kind,
)
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.switches import (
    farthest,
    farthest_without_jerk,
    fastest,
    soonest_stop,
)

_NO_TIME = 1e-9  # of a short segment's longest duration: states there are not divided by less

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
    if frame.short.any():
        proposed += [*_short_products(frame), *_fades(frame, x)]
    proposed += [*_reach(frame, x), *_stops(frame, x)]
    kept = [
        cuts[frame.terms(kind, cuts).violated(x, tolerance)] for kind, cuts in proposed if len(cuts)
    ]
    return Cuts.joined([Cuts.none(), *kept])


def _durations(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (7) at T itself, rows (8) at their deepest: t = (h - T) / (h / T - 1)."""
    T, h = x[frame.T], frame.high
    inverse = np.where(frame.short, T / np.maximum(x[frame.square], 1e-300), x[frame.inverse])
    t = (h - T) / np.maximum(h * inverse - 1.0, 1e-300)
    k = np.arange(frame.L)
    for kind, at in ((Kind.TANGENT, T), (Kind.HULL, np.clip(t, frame.low, h))):
        yield kind, Cuts.of(kind, k, at * frame.typical)


def _products(frame: Frame) -> Iterator[Proposal]:
    """Rows (9) in all four corners, except where the acceleration is fixed at 0."""
    moves = (frame.a_low != 0.0) | (frame.a_high != 0.0)
    for kind in PRODUCTS:
        k, j = np.nonzero(moves[frame.relaxed.legs[:, kind.end]])
        yield kind, _corners(kind, k, j)


def _zones(frame: Frame) -> Iterator[Proposal]:
    """Rows (11) in all four corners."""
    for kind in ZONES:
        k, j = np.nonzero((frame.p[:, :, kind.end] >= 0) & ~frame.times_T)
        yield kind, _corners(kind, k, j)


def _short_products(frame: Frame) -> Iterator[Proposal]:
    """Rows (9) of T v and T^2 a in short segments, in all four corners."""
    with_states = frame.short[:, None] & ~frame.relaxed.by_speed_alone
    for kinds, low, high in (
        (SPEED_PRODUCTS, frame.v_low, frame.v_high),
        (SQUARE_PRODUCTS, frame.a_low, frame.a_high),
    ):
        moves = (low != 0.0) | (high != 0.0)
        for kind in kinds:
            k, j = np.nonzero(with_states & moves[frame.relaxed.legs[:, kind.end]])
            yield kind, _corners(kind, k, j)


def _fades(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (10) at the acceleration of the point, at both ends of short segments."""
    for kind in FADES:
        k, j = np.nonzero(frame.short[:, None] & frame.relaxed.has_jerk)
        i = frame.relaxed.legs[k, kind.end]
        at = x[frame.a[i, j]] * frame.relaxed.acceleration[j]
        yield kind, Cuts.of(kind, k, at, j, np.sign(x[frame.v[i, j]]))
    sign = np.repeat((1.0, -1.0), len(k))
    k, j = np.tile(k, 2), np.tile(j, 2)
    yield Kind.CHANGE, Cuts.of(Kind.CHANGE, k, 0.0 * sign, j, sign)


def _corners(kind: Kind, k: Indices, j: Indices) -> Cuts:
    return Cuts.of(kind, np.tile(k, 4), np.repeat(np.arange(4.0), len(k)), np.tile(j, 4))


def _peaks(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (10) at the ratio W / T^2 of the point."""
    for kind in PEAKS:
        k, j = np.nonzero(~frame.short[:, None] & frame.relaxed.has_jerk)
        unit = frame.relaxed.acceleration[j] / frame.typical[k]
        at = x[frame.W[k, j, kind.end]] / x[frame.square[k]] * unit
        speeds = x[frame.v[frame.relaxed.legs[k, kind.end], j]]
        yield kind, Cuts.of(kind, k, at, j, np.sign(speeds))


def _reach(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (1) and (2) at the switches of the motion that goes farthest or gains most speed."""
    has_jerk, alone = frame.relaxed.has_jerk, frame.relaxed.by_speed_alone
    yield from _at_top_speed(frame)
    T, square, v, W = _states(frame, x)
    for limited in (True, False):
        k, j = _grid(frame.L, np.flatnonzero((has_jerk == limited) & ~alone))
        if not len(k):
            continue
        k, j, sign = np.tile(k, 2), np.tile(j, 2), np.repeat((1.0, -1.0), len(k))
        forwards = (sign > 0.0).astype(np.intp)
        ramp, J = frame.ramp[k, j], frame.bend[k, j] * square[k]
        v0, v1 = (sign * v[k, j, end] for end in (0, 1))
        W0, W1 = (sign * ramp * W[k, j, end] for end in (0, 1))
        A, B = (frame.ramps[k, j, side] * T[k] for side in (forwards, 1 - forwards))
        A, B = np.maximum(A, np.maximum(W0, W1)), np.maximum(B, np.maximum(-W0, -W1))
        top = frame.top[k, j, forwards]
        if limited:
            six, cruises = farthest(v0, W0, v1, W1, top, A, J, down=B)
            if frame.short.any():  # (2) is never taken times T
                W0, W1 = (sign * ramp * x[frame.W[k, j, end]] for end in (0, 1))
                A = np.maximum(frame.ramps[k, j, forwards] * x[frame.T[k]], np.maximum(W0, W1))
                J = frame.bend[k, j] * x[frame.square[k]]
            two = fastest(W0, W1, A, J)
        else:
            six, cruises = farthest_without_jerk(v0, v1, top, A, down=B)
            two = np.stack([0.0 * A, np.ones_like(A)], axis=1)
        for kind, which in ((Kind.CRUISE, cruises), (Kind.DISTANCE, ~cruises)):
            yield kind, Cuts.of(kind, k[which], six[which], j[which], sign[which])
        yield Kind.SPEED, Cuts.of(Kind.SPEED, k, two, j, sign)


def _states(frame: Frame, x: Array) -> tuple[Array, Array, Array, Array]:
    """T, T^2, v and W at both ends as the rows of reach have them: those times T, divided by T."""
    T, square, v, W = x[frame.of_T], x[frame.of_square], x[frame.of_v], x[frame.of_W]
    if frame.short.any():
        by = x[frame.T]
        moves, still = frame.short & (by > _NO_TIME), frame.short & (by <= _NO_TIME)
        for values in (T, square, v, W):
            values[moves] /= by[moves].reshape(-1, *(1,) * (values.ndim - 1))
        T[still], square[still], W[still] = _NO_TIME, _NO_TIME**2, 0.0
        v[still] = np.moveaxis(x[frame.v][frame.relaxed.legs[still]], 1, -1)
    return T, square, v, W


def _at_top_speed(frame: Frame) -> Iterator[Proposal]:
    """Rows (1) at top speed all the way, of short segments and of joints with a velocity limit only."""
    k, j = np.nonzero(frame.times_T)
    k, j, sign = np.tile(k, 2), np.tile(j, 2), np.repeat((1.0, -1.0), len(k))
    at = np.tile([0.0, 0.0, 0.0, 1.0, 1.0, 1.0], (len(k), 1))
    yield Kind.CRUISE, Cuts.of(Kind.CRUISE, k, at, j, sign)
    # from the state at one end alone (Taylor's formula): the ends of a point need not fit together
    which = frame.relaxed.has_jerk[j]
    k, j, sign = k[which], j[which], sign[which]
    for switch in (0.0, 1.0):
        yield Kind.DISTANCE, Cuts.of(Kind.DISTANCE, k, np.full((len(k), 6), switch), j, sign)


def _stops(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (3) at the switches of the soonest stop, where there is a position limit."""
    T, square, speeds, ramps = _states(frame, x)
    jerk = np.where(frame.relaxed.has_jerk, frame.bend, np.inf) * square[:, None]
    for kind in STOPS:
        limited = np.isfinite(frame.room[:, kind.end]) & ~frame.relaxed.by_speed_alone[:, None]
        k, j, side = np.nonzero(limited)
        if not len(k):
            continue
        # the joint goes towards the limit, or comes from there where time is reversed
        turned = -1.0 if kind.end else 1.0
        sign = turned * np.where(side == 1, 1.0, -1.0)
        v, W = sign * speeds[k, j, kind.end], turned * sign * ramps[k, j, kind.end]
        A = np.maximum(frame.ramps[k, j, 1 - side] * T[k], 1e-300)
        two = soonest_stop(v, W * frame.ramp[k, j], A, jerk[k, j])
        yield kind, Cuts.of(kind, k, two, j, sign)


def _grid(K: int, joints: Indices) -> tuple[Indices, Indices]:
    """All pairs of a segment and one of the joints."""
    return np.repeat(np.arange(K), len(joints)), np.tile(joints, K)
