"""The motion of one joint between points, as a linear program: the least share of its jerk limit.

The jerk is constant on each cell, d its length. Unknown are the jerk j of each cell and acceleration a,
velocity v and position p at the ends of the cells, tied by exact integration:

    a' = a + j d        v' = v + a d + j d^2 / 2        p' = p + v d + a d^2 / 2 + j d^3 / 6

Each kind of unknown has a unit of its own, so that the solver sees numbers of order one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import qr, solve_triangular
from scipy.optimize import linprog
from scipy.sparse import csr_matrix, vstack

from formulations.problem.arrays import Array, Indices

_DEPENDENT = 1e-13  # relative size below which a state adds nothing to those before it


@dataclass(frozen=True)
class JointBounds:
    """What one joint has to keep.

    Attributes
    ----------
    waypoints : Array, shape (n_waypoints,) [rad]
        Positions to pass.
    velocity, acceleration : Array, shape (n_segments, 2) [rad/s, rad/s^2]
        Least and greatest value per segment, without the share that rounding may take.
    jerk : Array, shape (n_segments,) [rad/s^3]
        Limits per segment in the same way; infinite where there is none.
    position : Array, shape (n_segments, 2) [rad]
        Least and greatest position per segment.
    end_velocity, end_acceleration : Array, shape (2,) [rad/s, rad/s^2]
        At the start and at the end.
    smooth : bool
        Whether the acceleration may not jump: it is as given at both ends, and zero at the stops.
    stops : tuple of int
        Waypoints at which the joint stands still.
    """

    waypoints: Array
    velocity: Array
    acceleration: Array
    jerk: Array
    position: Array
    end_velocity: Array
    end_acceleration: Array
    smooth: bool
    stops: tuple[int, ...]


def least_jerk(times: Array, waypoints: Indices, bounds: JointBounds) -> tuple[Array, Array] | None:
    """Find the motion of one joint that uses the least share of its jerk limit.

    Parameters
    ----------
    times : Array, shape (n_cells + 1,) [s]
        Ends of the cells.
    waypoints : Indices, shape (n_waypoints,)
        The end of a cell at which each waypoint is passed.
    bounds : JointBounds
        Waypoints, limits and end states.

    Returns
    -------
    tuple of Array, or None
        The jerk of each cell, (n_cells,) [rad/s^3], and position, velocity and acceleration at the start,
        (3,). None: the linear program has no solution.
    """
    d = np.diff(times)
    n = len(d)
    columns = _Columns(n)
    unit = _Units.of(times, bounds)
    segment = np.searchsorted(waypoints, np.arange(n), side="right") - 1
    segment = np.clip(segment, 0, len(bounds.velocity) - 1)
    lower, upper = _box(columns, unit, segment, waypoints, bounds)
    rows, most = _inequalities(columns, unit, segment, d, bounds)
    cost = np.zeros(columns.size)
    cost[columns.share] = 1.0
    answer = linprog(
        cost, A_ub=rows, b_ub=most, A_eq=_integration(columns, unit, d), b_eq=np.zeros(3 * n),
        bounds=np.stack([lower, upper], axis=1), method="highs",
        options={"primal_feasibility_tolerance": 1e-10},
    )  # fmt: skip
    if answer.x is None:
        return None
    free = float(answer.x[columns.a[0]]) * unit.a
    acceleration = float(bounds.end_acceleration[0]) if bounds.smooth else free
    start = np.array([bounds.waypoints[0], bounds.end_velocity[0], acceleration])
    return _corrected(times, answer.x[columns.j] * unit.j, start, waypoints, bounds), start


def integrated(lengths: Array, jerks: Array, start: Array) -> Array:
    """Integrate constant jerks over the cells, cell by cell.

    Parameters
    ----------
    lengths : Array, shape (n_cells,) [s]
        Durations of the cells.
    jerks : Array, shape (n_cells, dof) [rad/s^3]
        Jerk on each cell.
    start : Array, shape (3, dof)
        Position, velocity and acceleration at the start.

    Returns
    -------
    Array, shape (3, n_cells + 1, dof)
        Position, velocity and acceleration at the ends of all cells.
    """
    d = lengths[:, None]
    a = np.concatenate([start[2:3], start[2] + np.cumsum(jerks * d, axis=0)])
    steps = a[:-1] * d + jerks * d**2 / 2.0
    v = np.concatenate([start[1:2], start[1] + np.cumsum(steps, axis=0)])
    steps = v[:-1] * d + a[:-1] * d**2 / 2.0 + jerks * d**3 / 6.0
    p = np.concatenate([start[0:1], start[0] + np.cumsum(steps, axis=0)])
    return np.stack([p, v, a])


@dataclass(frozen=True)
class _Columns:
    """Where the unknowns of a program of n cells stand."""

    n: int

    @property
    def j(self) -> Indices:
        return np.arange(self.n)

    @property
    def a(self) -> Indices:
        return self.n + np.arange(self.n + 1)

    @property
    def v(self) -> Indices:
        return 2 * self.n + 1 + np.arange(self.n + 1)

    @property
    def p(self) -> Indices:
        return 3 * self.n + 2 + np.arange(self.n + 1)

    @property
    def share(self) -> int:
        return 4 * self.n + 3

    @property
    def size(self) -> int:
        return 4 * self.n + 4

    def rows(self, *entries: tuple[Indices, Array]) -> Any:
        """A row per cell: the columns of each entry, (n,), and their coefficients, (n,)."""
        at = np.tile(np.arange(self.n), len(entries))
        where, values = (np.concatenate(part) for part in zip(*entries, strict=True))
        return csr_matrix((values, (at, where)), shape=(self.n, self.size))


@dataclass(frozen=True)
class _Units:
    """Sizes of the unknowns: position, velocity, acceleration, jerk."""

    p: float
    v: float
    a: float
    j: float

    @staticmethod
    def of(times: Array, bounds: JointBounds) -> _Units:
        total = float(times[-1])
        coasting = float(np.abs(bounds.end_velocity).max()) * total
        a = float(np.abs(bounds.acceleration).max())
        finite = np.isfinite(bounds.jerk).all()
        return _Units(
            p=max(float(np.ptp(bounds.waypoints)), coasting, 1e-9),
            v=min(float(np.abs(bounds.velocity).max()), a * total),
            a=a,
            # without a limit, no more than from one acceleration limit to the other within a cell
            j=float(bounds.jerk.max()) if finite else 2.0 * a / float(np.diff(times).min()),
        )


def _integration(columns: _Columns, unit: _Units, d: Array) -> Any:
    """Rows of the three equations of integration, one of each per cell."""
    j, a, v, p, one = columns.j, columns.a, columns.v, columns.p, np.ones(columns.n)
    return vstack(
        [
            columns.rows((a[1:], one), (a[:-1], -one), (j, -d * unit.j / unit.a)),
            columns.rows(
                (v[1:], one),
                (v[:-1], -one),
                (a[:-1], -d * unit.a / unit.v),
                (j, -(d**2) / 2.0 * unit.j / unit.v),
            ),
            columns.rows(
                (p[1:], one),
                (p[:-1], -one),
                (v[:-1], -d * unit.v / unit.p),
                (a[:-1], -(d**2) / 2.0 * unit.a / unit.p),
                (j, -(d**3) / 6.0 * unit.j / unit.p),
            ),
        ],
        format="csr",
    )


def _box(
    columns: _Columns, unit: _Units, segment: Indices, waypoints: Indices, bounds: JointBounds
) -> tuple[Array, Array]:
    """Bounds of every unknown: limits at the ends of cells, waypoints, rest."""
    lower, upper = np.full(columns.size, -np.inf), np.full(columns.size, np.inf)
    # a state keeps the limits of the cells on both sides
    before = np.concatenate([segment[:1], segment])
    after = np.concatenate([segment, segment[-1:]])
    for at, size, limit in (
        (columns.a, unit.a, bounds.acceleration),
        (columns.v, unit.v, bounds.velocity),
    ):
        upper[at] = np.minimum(limit[before, 1], limit[after, 1]) / size
        lower[at] = np.maximum(limit[before, 0], limit[after, 0]) / size
    origin, position = bounds.waypoints[0], bounds.position
    lower[columns.p] = (np.maximum(position[before, 0], position[after, 0]) - origin) / unit.p
    upper[columns.p] = (np.minimum(position[before, 1], position[after, 1]) - origin) / unit.p
    lower[columns.share], upper[columns.share] = 0.0, 1.0

    def fix(at: Any, values: Any) -> None:
        lower[at] = upper[at] = values

    stops = waypoints[list(bounds.stops)]
    fix(columns.p[waypoints], (bounds.waypoints - origin) / unit.p)
    fix(columns.v[stops], 0.0)
    fix(columns.v[[0, -1]], bounds.end_velocity / unit.v)
    if bounds.smooth:
        fix(columns.a[stops], 0.0)
        fix(columns.a[[0, -1]], bounds.end_acceleration / unit.a)
    return lower, upper


def _inequalities(
    columns: _Columns, unit: _Units, segment: Indices, d: Array, bounds: JointBounds
) -> tuple[Any, Array]:
    """Rows <= values: jerk against its share of the limit, velocity and position inside the cells.

    Inside a cell a polynomial lies between the least and greatest of its Bernstein coefficients.
    """
    j, a, v, p, one = columns.j, columns.a[:-1], columns.v[:-1], columns.p[:-1], np.ones(columns.n)
    shares = np.full(columns.n, columns.share)
    limit = bounds.jerk[segment] / unit.j if np.isfinite(bounds.jerk).all() else one
    middle = columns.rows((v, one), (a, d / 2.0 * unit.a / unit.v))  # of the quadratic
    slowest, fastest = bounds.velocity[segment].T / unit.v
    rows = [
        columns.rows((j, one), (shares, -limit)),
        columns.rows((j, -one), (shares, -limit)),
        middle,
        -middle,
    ]
    most = [np.zeros(columns.n), np.zeros(columns.n), fastest, -slowest]
    thirds = (  # of the cubic
        columns.rows((p, one), (v, d / 3.0 * unit.v / unit.p)),
        columns.rows((p, one), (v, d * 2.0 / 3.0 * unit.v / unit.p), (a, d**2 / 6.0 * unit.a / unit.p)),
    )
    for sign, side in ((-1.0, 0), (1.0, 1)):
        reach = sign * (bounds.position[segment, side] - bounds.waypoints[0]) / unit.p
        if np.isfinite(reach).all():
            rows += [sign * third for third in thirds]
            most += [reach, reach]
    return vstack(rows, format="csr"), np.concatenate(most)


def _corrected(
    times: Array, jerks: Array, start: Array, waypoints: Indices, bounds: JointBounds
) -> Array:
    """The jerks nearest to those of the linear program that meet every fixed state to rounding.

    The solver meets them to 1e-10 of a unit per cell, and the errors add up.
    """
    d = np.diff(times)
    last = len(d)
    stops = [int(waypoints[stop]) for stop in bounds.stops if waypoints[stop] < last]
    fixed = [  # order of the derivative, end of a cell, value
        *((0, int(at), float(x)) for at, x in zip(waypoints[1:], bounds.waypoints[1:], strict=True)),
        *((1, at, 0.0) for at in stops),
        (1, last, float(bounds.end_velocity[1])),
    ]
    if bounds.smooth:
        fixed += [*((2, at, 0.0) for at in stops), (2, last, float(bounds.end_acceleration[1]))]
    effects = np.array([_effect(times, order, at) for order, at, _ in fixed])
    scale = np.abs(effects).max(axis=1)
    usable = np.flatnonzero(scale > 0.0)
    # the least change that adds given amounts to the states lies in the span of their effects
    basis, triangle, order_of = qr(
        (effects[usable] / scale[usable, None]).T, mode="economic", pivoting=True
    )
    sizes = np.abs(np.diag(triangle))
    rank = int((sizes > _DEPENDENT * sizes[0]).sum())
    free = usable[order_of[:rank]]  # the other states follow from these
    for _ in range(2):
        states = integrated(d, jerks[:, None], start[:, None])[..., 0]
        missing = np.array([value - states[order, at] for order, at, value in fixed])
        amounts = solve_triangular(triangle[:rank, :rank], missing[free] / scale[free], trans="T")
        jerks = jerks + basis[:, :rank] @ amounts
    return np.asarray(jerks)


def _effect(times: Array, order: int, at: int) -> Array:
    """Derivative of one state at the end of a cell by the jerk of each cell, (n_cells,)."""
    power = 3 - order
    since_start = np.maximum(times[at] - times[:-1], 0.0)
    since_end = np.maximum(times[at] - times[1:], 0.0)
    return np.asarray((since_start**power - since_end**power) / (1.0, 1.0, 2.0, 6.0)[power])
