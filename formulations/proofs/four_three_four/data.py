"""4-3-...-3-4: what the compiled functions of the proof share, as named tuples."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.conditions import WIDTH, with_derivatives

# what multiplies d, T v0, T v1 in a piece's position from its start:
# (order, piece [first quartic, cubic, last quartic], term, power of s)
BASIS = with_derivatives(
    [
        [[0, 0, 0, 4, -3], [0, 0, 0, 0, 0], [0, 0, 0, -1, 1]],
        [[0, 0, 3, -2, 0], [0, 1, -2, 1, 0], [0, 0, -1, 1, 0]],
        [[0, 0, 6, -8, 3], [0, 1, -3, 3, -1], [0, 0, 0, 0, 0]],
    ],
    3,
)

# how the share of a segment stands in the equation of a knot beside it (see ``velocities``)
VARIES, UNIT, GONE = 0, 1, 2


class RateData(NamedTuple):
    """The task of one attempt; the variables are the rates x_k = 1 / T_k.

    ends: (n, first, last), for small functions: a large tuple takes time to pass. n: number of segments.
    first, last: the knots whose velocity is unknown are first .. last: 1 .. n-1
    from rest to rest, but a part of the motion is free at an end that is not one of the motion (first is
    0 there, last is n). d, d_lo, d_hi: displacements and their enclosures, (n, dof) [rad]. limit
    (3, dof): velocity, acceleration, jerk. room_lo, room_hi (n, dof): from the start of each segment to
    the position limits below and above, rounded up [rad]. basis: ``BASIS``. L: the total time [s].
    speed (dof,): bounds on the velocities [rad/s].
    parts (m, 2), least (m,): the segments parts[i, 0] .. parts[i, 1] - 1 are known to take least[i] [s].
    """

    ends: Any
    n: int
    first: int
    last: int
    d: Any
    d_lo: Any
    d_hi: Any
    limit: Any
    room_lo: Any
    room_hi: Any
    basis: Any
    L: float
    speed: Any
    parts: Any
    least: Any


class Reference(NamedTuple):
    """A point of the box, and what follows from it in floating point.

    c, half (n,): the point and the half-widths of the box. is_open (n,): whether x has no upper end.
    ce (n+1, 2): coefficient at the point of the segments before and after each knot. state (n+1, 2):
    VARIES, UNIT or GONE, of the same. C (n+1, n+1): approximate inverse of A(c). rest (n+1, n+1): upper
    bounds of |I - C A(c)|. vc (dof, n+1): approximate velocities C b(c).
    """

    c: Any
    half: Any
    is_open: Any
    ce: Any
    state: Any
    C: Any
    rest: Any
    vc: Any


class VelocityEnclosure(NamedTuple):
    """Enclosures of the velocities at the waypoints over a box of x.

    lo, hi (dof, n+1) [rad/s]. slopes (dof, n+1, n), remainder (dof, n+1): v = vc + slopes (x - c) to
    within the remainder, not rounded, for the choice of rows alone. stray_lo, stray_hi (n+1,): of one
    joint, see ``velocities.strays``.
    """

    lo: Any
    hi: Any
    slopes: Any
    remainder: Any
    stray_lo: Any
    stray_hi: Any


class RateForm(NamedTuple):
    """Rows, and their first-order form a_i + g_i . e <= 0, e in [-1, 1]^n, about the reference.

    rows (m, WIDTH), a (m,), g (m, n_variables), multipliers (m,); few (n_variables+1, WIDTH): the rows of
    a discard. The variables are the n of x, then the velocities at the free ends, see ``n_variables``;
    smear (n_variables,): how much the rows of the last discard depend on each.
    """

    rows: Any
    a: Any
    g: Any
    multipliers: Any
    few: Any
    smear: Any


class LagrangianSums(NamedTuple):
    """Coefficients of one Lagrangian, and room to compute them.

    shares (n, 6): per segment alpha_lo, alpha_hi, kappa_lo, nu, w1, w2 (see ``lagrangian``). least (n,):
    the least values of the segments' shares. weight_lo, weight_hi (dof, n+1): coefficients of the
    velocities. used (dof,): whether a row is about the joint. eta (dof, n+1): multipliers of the shares
    beside an open segment. Of one joint: factor_lo, factor_hi, cross (n, 2), extra, mu (n+1,).
    """

    shares: Any
    least: Any
    weight_lo: Any
    weight_hi: Any
    used: Any
    eta: Any
    factor_lo: Any
    factor_hi: Any
    cross: Any
    extra: Any
    mu: Any


@compiled
def empty_reference(n: int, dof: int) -> Reference:
    """Make room for a reference.

    Parameters
    ----------
    n, dof : int
        Segments and moving joints.

    Returns
    -------
    Reference
        Zeros.
    """
    return Reference(
        np.zeros(n), np.zeros(n), np.zeros(n, np.bool_),
        np.zeros((n + 1, 2)), np.zeros((n + 1, 2), np.int64),
        np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1)), np.zeros((dof, n + 1)),
    )  # fmt: skip


@compiled
def empty_enclosure(n: int, dof: int) -> VelocityEnclosure:
    """Make room for enclosures of the velocities.

    Parameters
    ----------
    n, dof : int
        Segments and moving joints.

    Returns
    -------
    VelocityEnclosure
        Zeros.
    """
    return VelocityEnclosure(
        np.zeros((dof, n + 1)), np.zeros((dof, n + 1)),
        np.zeros((dof, n + 1, n)), np.zeros((dof, n + 1)), np.zeros(n + 1), np.zeros(n + 1),
    )  # fmt: skip


@compiled
def empty_form(data: RateData) -> RateForm:
    """Make room for the most rows that a box can have.

    Parameters
    ----------
    data : RateData
        The task.

    Returns
    -------
    RateForm
        Zeros.
    """
    n, variables = data.d.shape[0], n_variables(data)
    most = data.d.shape[1] * n * 19 + 1 + len(data.least)
    return RateForm(
        np.zeros((most, WIDTH)), np.zeros(most), np.zeros((most, variables)), np.zeros(most),
        np.zeros((variables + 1, WIDTH)), np.zeros(variables),
    )  # fmt: skip


@compiled
def empty_sums(n: int, dof: int) -> LagrangianSums:
    """Make room for a Lagrangian.

    Parameters
    ----------
    n, dof : int
        Segments and moving joints.

    Returns
    -------
    LagrangianSums
        Zeros.
    """
    return LagrangianSums(
        np.zeros((n, 6)), np.zeros(n),
        np.zeros((dof, n + 1)), np.zeros((dof, n + 1)), np.zeros(dof, np.bool_), np.zeros((dof, n + 1)),
        np.zeros((n, 2)), np.zeros((n, 2)), np.zeros((n, 2)), np.zeros(n + 1), np.zeros(n + 1),
    )  # fmt: skip


@compiled
def n_variables(data: RateData) -> int:
    """Count the variables: x, and the velocities of all joints at the free ends, first start, then end.

    Parameters
    ----------
    data : RateData
        The task.

    Returns
    -------
    int
        n, or more for a part.
    """
    free = (1 if data.first == 0 else 0) + (1 if data.last == data.n else 0)
    return data.n + int(free * data.d.shape[1])


@compiled
def variable_of(j: int, i: int, data: RateData) -> int:
    """Which variable the velocity of joint j at the free end i, 0 or n, is.

    Parameters
    ----------
    j, i : int
        Joint and knot.
    data : RateData
        The task.

    Returns
    -------
    int
        Its place among the variables.
    """
    return int(data.n + j + (data.d.shape[1] if i > 0 and data.first == 0 else 0))


@compiled
def end_of(x: int, data: RateData) -> tuple[int, int]:
    """Which velocity the variable x >= n is; undoes ``variable_of``.

    Parameters
    ----------
    x : int
        The variable.
    data : RateData
        The task.

    Returns
    -------
    j, i : int
        Joint and knot.
    """
    dof = data.d.shape[1]
    j = x - data.n
    if data.first == 0:
        return (j, 0) if j < dof else (j - dof, data.n)
    return j, data.n


@compiled
def piece_type(m: int, ends: Any) -> int:
    """Which kind of piece segment m is.

    Parameters
    ----------
    m : int
        The segment.
    ends : tuple of int
        n, first and last of ``RateData``.

    Returns
    -------
    int
        0: first quartic, 1: cubic, 2: last quartic.
    """
    if m == 0 and ends[1] == 1:
        return 0
    return 2 if m == ends[0] - 1 and ends[2] < ends[0] else 1


@compiled
def weights(m: int, ends: Any) -> tuple[float, float, float, float]:
    """The weights w, p of segment m in the equations of its left and of its right knot.

    Parameters
    ----------
    m : int
        The segment.
    ends : tuple of int
        n, first and last of ``RateData``.

    Returns
    -------
    wr, pr, wl, pl : float
        In the left knot's equation (where it is the segment on the right), and in the right knot's.
    """
    kind = piece_type(m, ends)
    wr, pr = (6.0, 12.0) if kind == 2 else (4.0, 6.0)
    wl, pl = (6.0, 12.0) if kind == 0 else (4.0, 6.0)
    return wr, pr, wl, pl


@compiled
def side_of(i: int, side: int, ends: Any) -> tuple[int, float, float, int]:
    """The share of one neighbouring segment in the equation of knot i: x_m (w v_i + 2 v_other - p d_m x_m).

    Parameters
    ----------
    i, side : int
        The knot; 0 for the segment before it, 1 for the one after.
    ends : tuple of int
        n, first and last of ``RateData``.

    Returns
    -------
    m : int
        The segment.
    w, p : float
        4 and 6, but 6 and 12 for the quartic end pieces.
    other : int
        The other waypoint of the segment.
    """
    m = i - 1 + side
    wr, pr, wl, pl = weights(m, ends)
    if side == 0:
        return m, wl, pl, i - 1
    return m, wr, pr, i + 1
