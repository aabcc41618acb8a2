"""What each limit costs: the derivative of the bound by the limit, from the multipliers.

With the point held fixed in SI units, a row's multiplier times the derivative of the row by the
logarithm of a limit is the derivative of the bound. So the savings are seconds per relative increase of
a limit, to first order: 10 % more of a limit saves a tenth of its entry. A motion slowed down by a factor
s keeps limits that are lower by s, s^2 and s^3. So, where the boxes have no influence on the bound,

    sum of savings by velocity + 2 by acceleration + 3 by jerk = bound.                        (12)
"""

from __future__ import annotations

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.proofs.every_motion.relaxation.cuts import (
    CRUISES,
    DISTANCES,
    FADES,
    PEAKS,
    PRODUCTS,
    STOPS,
    Cuts,
    Kind,
)
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram, LPSolution
from formulations.proofs.every_motion.relaxation.reach import (
    arc_coefficients,
    distance_coefficients,
    speed_coefficients,
    stop_coefficients,
)
from formulations.proofs.every_motion.relaxation.rows import Frame


def price_limits(demands: Demands, program: LinearProgram, solution: LPSolution) -> Array:
    """Compute the seconds saved per relative increase of each limit.

    Half of what a limit at a waypoint saves is attributed to each of the two segments that meet there.
    Limits that follow from the horizon save nothing.

    Parameters
    ----------
    demands : Demands
    program : LinearProgram
    solution : LPSolution
        Of the total time.

    Returns
    -------
    Array, shape (3, K, n) [s]
        By velocity, acceleration and jerk limits; segments and joints of the relaxed problem.
    """
    frame, x = program.frame, solution.x
    found = np.zeros((3, frame.L, frame.n))
    y = np.maximum(solution.multipliers[program.n_fixed :], 0.0)
    for kind in np.unique(program.cuts.kind[y > 0.0]):
        which = (program.cuts.kind == kind) & (y > 0.0)
        cuts = program.cuts[which]
        for quantity, share in enumerate(_derivatives(frame, Kind(int(kind)), cuts, x)):
            np.add.at(found[quantity], (cuts.segment, cuts.joint), y[which] * share)
    found = _of_segments(frame, found, x)
    reduced = frame.cost + program.rows.matrix.T @ np.maximum(solution.multipliers, 0.0)
    for quantity, columns in ((0, frame.v), (1, frame.a)):
        low, high = np.moveaxis(frame.box[columns], -1, 0)
        at = np.where(x[columns] > 0.0, high - x[columns], x[columns] - low) < 1e-9
        bound = at & (np.minimum(-low, high) > 0.0)  # one that is given has no limit of its own
        price = np.where(bound, -reduced[columns] * x[columns], 0.0)[1:-1]
        found[quantity, :-1] += 0.5 * price
        found[quantity, 1:] += 0.5 * price
    return _of_own_limits(demands, frame, found)


def _of_segments(frame: Frame, found: Array, x: Array) -> Array:
    """What is saved on the segments, (3, K, n): that on a leg over several is shared by their durations."""
    T = x[frame.T] * frame.typical
    own = found[:, : frame.K].copy()
    for leg in range(frame.K, frame.L):
        i, k = frame.relaxed.legs[leg]
        shares = T[i:k] / max(float(T[i:k].sum()), 1e-300)
        own[:, i:k] += shares[:, None] * found[:, leg, None]
    return own


def _of_own_limits(demands: Demands, frame: Frame, found: Array) -> Array:
    """Savings by the problem's own limits, from those by the limits that follow (``implied_limits``)."""
    relaxed, joints = frame.relaxed, frame.relaxed.joints
    V = np.abs(demands.velocity[:, joints]).max(axis=(0, 2))
    A = np.abs(demands.acceleration[:, joints]).max(axis=(0, 2))
    J = demands.jerk[:, joints].max(axis=0)
    own = relaxed.acceleration >= A
    by_both = ~own & np.isclose(relaxed.acceleration, np.sqrt(2.0 * J * V), rtol=1e-12)
    shared = np.where(by_both, 0.5 * found[1], 0.0)
    velocity = np.where(relaxed.velocity >= V, found[0], 0.0) + shared
    return np.stack([velocity, np.where(own, found[1], 0.0), found[2] + shared])


def _derivatives(frame: Frame, kind: Kind, cuts: Cuts, x: Array) -> tuple[Array, Array, Array]:
    """Minus the derivative of each row by the logarithm of the three limits, at x: each (m,)."""
    k, j = cuts.segment, cuts.joint
    none, with_it = np.zeros(len(k)), (cuts.sign > 0.0).astype(np.intp)
    if kind in (*DISTANCES, *STOPS, Kind.SPEED):
        T, square = (x[columns[k]] for columns in frame.parts[kind.times_T][:2])
        A, against = (frame.ramps[k, j, side] * T for side in (with_it, 1 - with_it))
        if kind in STOPS and kind.end:  # with time turned the joint brakes the other way
            A, against = against, A
        c_V, c_A, c_against, c_J = _limit_coefficients(kind, cuts.at)
        J = frame.bend[k, j] * square
        by_V = c_V * frame.top[k, j, with_it] * (x[frame.T[k]] if kind.times_T else 1.0)
        return by_V, c_A * A + c_against * against, c_J * J
    if kind in (*PEAKS, *FADES):
        top = frame.peak(kind.end, cuts)[0]
        return top, none, top - cuts.sign * x[frame.v[frame.relaxed.legs[k, kind.end], j]]
    if kind in PRODUCTS:
        t, e, side = frame.corner(kind, cuts)
        return none, np.where(np.abs(e) >= 1.0, side * e * (t - x[frame.T[k]]), 0.0), none
    return none, none, none


def _limit_coefficients(kind: Kind, at: Array) -> tuple[Array, Array, Array, Array]:
    """Coefficients of V, of A T with and against the motion, and of J T^2 in (1), (2) or (3), each (m,)."""
    if kind in DISTANCES:
        cruises = kind in CRUISES
        coefficients = distance_coefficients(at, cruises)
        return coefficients[4], *arc_coefficients(at, cruises), coefficients[6]
    none = np.zeros(len(at))
    if kind == Kind.SPEED:
        c_A, c_J = speed_coefficients(at[:, :2])[2:]
        return none, c_A, none, c_J
    c_A, c_J = stop_coefficients(at[:, :2])[2:]
    return none, none, c_A, c_J
