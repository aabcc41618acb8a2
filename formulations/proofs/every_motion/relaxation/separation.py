"""Separation: the rows that cut a given point off, for every segment, joint and sign.

Of each kind that row is proposed which the point violates most; those that it violates are kept.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

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
    with np.errstate(all="ignore"):  # switches where a segment takes no time
        return _violated(frame, x, tolerance)


def _violated(frame: Frame, x: Array, tolerance: float) -> Cuts:
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
    # times T, the place is that where T^2 stands for T and T for 1
    for inverse, which, (tangent, hull) in (
        (x[frame.inverse], frame.long, (Kind.TANGENT, Kind.HULL)),
        (T / x[frame.square], frame.short, (Kind.TANGENT_TIMES_T, Kind.HULL_TIMES_T)),
    ):
        k = np.flatnonzero(which)
        t = np.clip((h - T) / np.maximum(h * inverse - 1.0, 1e-300), frame.low, h)
        for kind, at in ((tangent, T), (hull, t)):
            yield kind, Cuts.of(kind, k, (at * frame.typical)[k])


def _products(frame: Frame) -> Iterator[Proposal]:
    """Rows (9) in all four corners, except where the acceleration is fixed at 0."""
    moves = (frame.a_low != 0.0) | (frame.a_high != 0.0)
    for kind in PRODUCTS:
        k, j = np.nonzero(moves[frame.relaxed.legs[:, kind.end]])
        yield kind, _corners(kind, k, j)


def _zones(frame: Frame) -> Iterator[Proposal]:
    """Rows (11) in all four corners."""
    for kind in ZONES:
        there = frame.long[:, None] & ~frame.relaxed.by_speed_alone
        k, j = np.nonzero((frame.p[:, :, kind.end] >= 0) & there)
        yield kind, _corners(kind, k, j)


def _short_products(frame: Frame) -> Iterator[Proposal]:
    """Rows (9) of T v and T^2 a in short segments, in all four corners."""
    for kinds, low, high, joints in (
        (SPEED_PRODUCTS, frame.v_low, frame.v_high, ~frame.relaxed.by_speed_alone),
        (SQUARE_PRODUCTS, frame.a_low, frame.a_high, frame.relaxed.has_jerk),
    ):
        moves = ((low != 0.0) | (high != 0.0)) & joints
        for kind in kinds:
            k, j = np.nonzero(frame.short[:, None] & moves[frame.relaxed.legs[:, kind.end]])
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
        k, j = np.nonzero(frame.long[:, None] & frame.relaxed.has_jerk)
        unit = frame.relaxed.acceleration[j] / frame.typical[k]
        at = x[frame.W[k, j, kind.end]] / x[frame.square[k]] * unit
        speeds = x[frame.v[frame.relaxed.legs[k, kind.end], j]]
        yield kind, Cuts.of(kind, k, at, j, np.sign(speeds))


def _reach(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (1) and (2) at the switches of the motion that goes farthest or gains most speed."""
    has_jerk, alone = frame.relaxed.has_jerk, frame.relaxed.by_speed_alone
    yield from _at_top_speed(frame)
    kinds = ((Kind.CRUISE, Kind.DISTANCE), (Kind.CRUISE_TIMES_T, Kind.DISTANCE_TIMES_T))
    for (cruise, distance), limited in product(kinds, (True, False)):
        which = frame.short if cruise.times_T else frame.long
        k, j = _grid(np.flatnonzero(which), np.flatnonzero((has_jerk == limited) & ~alone))
        if not len(k):
            continue
        T, square, v, W = _states(frame, x, cruise.times_T)
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
            two = fastest(W0, W1, A, J)
        else:
            six, cruises = farthest_without_jerk(v0, v1, top, A, down=B)
            two = np.stack([0.0 * A, np.ones_like(A)], axis=1)
        for kind, posed in ((cruise, cruises), (distance, ~cruises)):
            yield kind, Cuts.of(kind, k[posed], six[posed], j[posed], sign[posed])
        yield Kind.SPEED, Cuts.of(Kind.SPEED, k, two, j, sign)


def _states(frame: Frame, x: Array, times_T: bool) -> tuple[Array, Array, Array, Array]:
    """T, T^2, v and W at both ends as the rows of reach have them: those times T, divided by T."""
    T, square, v, W = (x[columns] for columns in frame.parts[times_T][:4])
    if times_T:
        by = x[frame.T]
        moves = by > _NO_TIME
        for values in (T, square, v, W):
            values[moves] /= by[moves].reshape(-1, *(1,) * (values.ndim - 1))
        T[~moves], square[~moves], W[~moves] = _NO_TIME, _NO_TIME**2, 0.0
        v[~moves] = x[frame.parts[False][2]][~moves]
    return T, square, v, W


def _at_top_speed(frame: Frame) -> Iterator[Proposal]:
    """Rows (1) times T at top speed all the way, of short segments and of joints with no other limit."""
    k, j = np.nonzero(frame.short[:, None] | frame.relaxed.by_speed_alone)
    k, j, sign = np.tile(k, 2), np.tile(j, 2), np.repeat((1.0, -1.0), len(k))
    at = np.tile([0.0, 0.0, 0.0, 1.0, 1.0, 1.0], (len(k), 1))
    yield Kind.CRUISE_TIMES_T, Cuts.of(Kind.CRUISE_TIMES_T, k, at, j, sign)
    # from the state at one end alone (Taylor's formula): the ends of a point need not fit together
    which = frame.relaxed.has_jerk[j]
    k, j, sign = k[which], j[which], sign[which]
    for switch in (0.0, 1.0):
        at = np.full((len(k), 6), switch)
        yield Kind.DISTANCE_TIMES_T, Cuts.of(Kind.DISTANCE_TIMES_T, k, at, j, sign)


def _stops(frame: Frame, x: Array) -> Iterator[Proposal]:
    """Rows (3) at the switches of the soonest stop, where there is a position limit."""
    for kind in STOPS:
        which = frame.short if kind.times_T else frame.long
        limited = np.isfinite(frame.room[:, kind.end]) & which[:, None, None]
        k, j, side = np.nonzero(limited & ~frame.relaxed.by_speed_alone[:, None])
        if not len(k):
            continue
        T, square, speeds, ramps = _states(frame, x, kind.times_T)
        # the joint goes towards the limit, or comes from there where time is reversed
        turned = -1.0 if kind.end else 1.0
        sign = turned * np.where(side == 1, 1.0, -1.0)
        v, W = sign * speeds[k, j, kind.end], turned * sign * ramps[k, j, kind.end]
        A = np.maximum(frame.ramps[k, j, 1 - side] * T[k], 1e-300)
        jerk = np.where(frame.relaxed.has_jerk[j], frame.bend[k, j], np.inf) * square[k]
        two = soonest_stop(v, W * frame.ramp[k, j], A, jerk)
        yield kind, Cuts.of(kind, k, two, j, sign)


def _grid(legs: Indices, joints: Indices) -> tuple[Indices, Indices]:
    """All pairs of a leg and one of the joints."""
    return np.repeat(legs, len(joints)), np.tile(joints, len(legs))
