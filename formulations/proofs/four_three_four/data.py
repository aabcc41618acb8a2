"""4-3-...-3-4: what the compiled functions of the proof share, as named tuples."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.conditions import WIDTH, with_derivatives
from formulations.proofs.four_three_four.ends import n_variables

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

    n: number of segments. ends: see ``ends``. d, d_lo, d_hi: displacements and their enclosures, (n, dof)
    [rad]. limit (3, dof): velocity, acceleration, jerk. room_lo, room_hi (n, dof): from the start of each
    segment to the position limits below and above, rounded up [rad]. basis: ``BASIS``. L: the total time
    [s]. speed (dof,): bounds on the velocities [rad/s]. parts (m, 3): the
    segments parts[i, 0] .. parts[i, 1] - 1 are known to take parts[i, 2] [s].
    """

    n: int
    ends: Any
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
    smear (n_variables,): how much the rows of the last discard depend on each of the latter.
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
    n, variables = data.d.shape[0], n_variables(data.ends, data.d.shape[1])
    most = data.d.shape[1] * n * 19 + 1 + len(data.parts)
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
