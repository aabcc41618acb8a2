"""4-3-...-3-4: which knots, variables and pieces a motion has, and a part of it with free ends.

``ends`` is (n, first, last): the number of segments, and the knots whose velocity is unknown. They are
1 .. n-1 from rest to rest, but first is 0 and last is n where a part ends inside the motion: its velocity
is free there. The functions take these three integers alone, since large named tuples take time to pass.
"""

from __future__ import annotations

from typing import Any

from formulations.compiled import compiled


@compiled
def unknown_knots(ends: Any) -> tuple[int, int]:
    """First and last knot whose velocity is unknown.

    Written so that the compiler sees that first is 0 or 1: it leaves the check for negative indices out
    of the loops over the knots.

    Parameters
    ----------
    ends : tuple of int
        n, first, last.

    Returns
    -------
    first, last : int
        The knots.
    """
    return (1 if ends[1] else 0), ends[2]


@compiled
def n_variables(ends: Any, dof: int) -> int:
    """Count the variables: x, and the velocities of all joints at the free ends, first start, then end.

    Parameters
    ----------
    ends : tuple of int
        n, first, last.
    dof : int
        Moving joints.

    Returns
    -------
    int
        n, or more for a part.
    """
    n, first, last = ends
    return int(n + dof * ((1 if first == 0 else 0) + (1 if last == n else 0)))


@compiled
def variable_of(j: int, i: int, ends: Any, dof: int) -> int:
    """Which variable the velocity of joint j at the free end i, 0 or n, is.

    Parameters
    ----------
    j, i : int
        Joint and knot.
    ends : tuple of int
        n, first, last.
    dof : int
        Moving joints.

    Returns
    -------
    int
        Its place among the variables.
    """
    return int(ends[0] + j + (dof if i > 0 and ends[1] == 0 else 0))


@compiled
def end_of(x: int, ends: Any, dof: int) -> tuple[int, int]:
    """Which velocity the variable x >= n is; undoes ``variable_of``.

    Parameters
    ----------
    x : int
        The variable.
    ends : tuple of int
        n, first, last.
    dof : int
        Moving joints.

    Returns
    -------
    j, i : int
        Joint and knot.
    """
    j = x - ends[0]
    if ends[1] == 0:
        return (j, 0) if j < dof else (j - dof, ends[0])
    return j, ends[0]


@compiled
def piece_type(m: int, ends: Any) -> int:
    """Which kind of piece segment m is.

    Parameters
    ----------
    m : int
        The segment.
    ends : tuple of int
        n, first, last.

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
        n, first, last.

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
        n, first, last.

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
