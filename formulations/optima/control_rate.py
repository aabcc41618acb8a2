"""The fastest motion again, such that the points of a file describe it exactly.

A controller joins the points of a file by quintics. Between two points where the jerk of the motion
switches, that quintic overshoots: at 125 points per second up to 1.7 times the jerk limit. The motion of
this module switches its jerk at points of the file only. Then each quintic *is* the cubic between two
points, and the file keeps the limits that the motion keeps.

The passage times are rounded up to points of the file first. With these fixed, the joints no longer
depend on each other, and each of them is a linear program: its jerk is constant on cells, its states
(position, velocity, acceleration) at the ends of the cells are variables, and the least share of the jerk
limit is asked for. Cells are one point wide where the jerk of the given motion switches, and wide elsewhere.
Velocities and positions inside a cell are bounded by their Bernstein coefficients.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from math import ceil

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_matrix, vstack

from formulations.motion.trajectory import Trajectory, check
from formulations.problem.arrays import Array, Indices
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError, NoFeasibleMotion
from formulations.problem.problem import Problem

NANOSECOND = 1e-9  # time stamps of a file are whole nanoseconds
MOST_POINTS = 5_000_000
_EVEN_CELLS = 200  # cells are never longer than the motion over this
_EXTRA = (0, 1, 2, 4, 8, 16, 32)  # further periods per segment, tried in this order
_STRETCHES = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)  # the same where points are not tied to a rate
_LEAST_MARGIN = 1e-7  # relative; covers the tolerance of the linear program
_LARGEST_MARGIN = 0.02  # a file at a higher rate would be more rounding than motion
_MERGED_MARGIN = 1e-6  # margin that sets the least distance of points without a rate


@dataclass(frozen=True)
class AtPoints:
    """A motion whose jerk switches at the points of a file only.

    Attributes
    ----------
    trajectory : Trajectory
        The motion; cubic on every piece.
    times : Array, shape (n_points,) [s]
        The points of the file, whole nanoseconds, the end included.
    margin : float
        Share of the jerk limit that is left free for the rounding of positions and times.
    """

    trajectory: Trajectory
    times: Array
    margin: float


def at_rate(
    problem: Problem,
    trajectory: Trajectory,
    rate: float | None,
    *,
    conditions: Conditions | None = None,
) -> AtPoints:
    """Compute the motion near a given one that a file with points at a rate describes exactly.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits that the motion keeps.
    trajectory : Trajectory
        A motion that keeps them, usually the fastest one. Its passage times and switching times are the
        starting point.
    rate : float or None [1/s]
        Points per second. None: points where the jerk switches, at least so far apart that rounding does
        not matter.
    conditions : Conditions, optional
        What else was asked of the given motion.

    Returns
    -------
    AtPoints
        The motion and the times of its points. It was judged by ``check``.

    Raises
    ------
    InputError
        The rate is not positive, or asks for more than 5,000,000 points, or is so high that the
        rounding of positions hides the jerk; a moving joint has no acceleration limit; a passage time
        that was asked for lies between two points.
    NoFeasibleMotion
        No motion was found even with 32 further periods per segment.
    """
    asked = conditions or Conditions()
    _require_acceleration(problem)
    if rate is not None and not (np.isfinite(rate) and rate > 0.0):
        raise InputError(f"rate: {rate:g} points per second; a positive number is needed")
    if rate is not None and trajectory.seconds * rate > MOST_POINTS:
        raise InputError(
            f"rate: {rate:g} points per second over {trajectory.seconds:.4g} s are "
            f"{trajectory.seconds * rate:.3g} points; at most {MOST_POINTS} are written"
        )
    least = _least_distance(problem, trajectory.seconds, _LARGEST_MARGIN)
    if rate is not None and rate * least > 1.0:
        raise InputError(
            f"rate: {rate:g} points per second; beyond {1.0 / least:.4g} the rounding of positions to "
            "double precision takes more than 2 % of the jerk limit"
        )
    verdict = None
    for patience in _EXTRA if rate is not None else _STRETCHES:
        grid = (
            _Grid.at_rate(problem, trajectory, rate, int(patience), asked)
            if rate is not None
            else _Grid.at_switches(problem, trajectory, patience, asked)
        )
        found = _solve(problem, trajectory, grid, asked)
        if found is None:
            continue
        verdict = check(problem, found.trajectory, conditions=asked)
        if verdict.feasible:
            return found
    reason = "" if verdict is None else f"; the last one: {verdict.faults[0]}"
    points = "at the switching times" if rate is None else f"at {rate:g} points per second"
    raise NoFeasibleMotion(
        f"no motion with its jerk constant between points {points} was found{reason}"
    )


def _require_acceleration(problem: Problem) -> None:
    """Refuse a moving joint without an acceleration limit: its first acceleration would be unbounded."""
    for joint in problem.moving_joints:
        if not np.isfinite(problem.limits.acceleration[joint]):
            raise InputError(
                f"limits.acceleration: joint {joint + 1} has none; a controller cannot follow a motion "
                "whose velocity jumps, so give a limit for this joint"
            )


def _rounding(problem: Problem, seconds: float) -> Array:
    """Errors of a position in a file, (dof,) [rad]: its own rounding, and that of its time stamp."""
    largest = np.abs(problem.waypoints).max(axis=0)
    late = 0.5 * seconds * problem.limits.velocity
    return np.asarray(np.finfo(float).eps * (2.0 * largest + late))


def _margins(problem: Problem, seconds: float, distance: float) -> Array:
    """Shares of velocity, acceleration and jerk limits that rounding may take, (3, dof).

    A quintic through two points ``distance`` apart turns an error e of a position into errors of at
    most 4 e / h, 12 e / h^2 and 60 e / h^3 of its derivatives (derivatives of its Hermite basis; two ends).
    """
    error = _rounding(problem, seconds)
    factors = np.array([4.0, 12.0, 60.0])[:, None] * 2.0
    powers = distance ** np.arange(1, 4)[:, None]
    return np.asarray(_LEAST_MARGIN + factors * error / powers / problem.limits.derivatives)


def _least_distance(problem: Problem, seconds: float, margin: float) -> float:
    """Distance of points [s] at which rounding takes ``margin`` of a limit at most."""
    error = _rounding(problem, seconds)
    factors = np.array([4.0, 12.0, 60.0])[:, None] * 2.0
    limits = problem.limits.derivatives
    distances = (factors * error / (limits * margin)) ** (1.0 / np.arange(1, 4)[:, None])
    return float(distances[:, problem.moving_joints].max(initial=NANOSECOND))


@dataclass(frozen=True)
class _Grid:
    """Points that the jerk may switch at.

    stamps: (n_points,) whole nanoseconds. waypoints: (n_waypoints,) index of the point of each waypoint.
    """

    stamps: Indices
    waypoints: Indices

    @property
    def times(self) -> Array:
        return np.asarray(self.stamps / 1e9)  # correctly rounded, as a reader of the decimal gets it

    @staticmethod
    def at_rate(
        problem: Problem, trajectory: Trajectory, rate: float, extra: int, asked: Conditions
    ) -> _Grid:
        """Even points; each segment takes a whole number of periods, rounded up, and ``extra`` more."""
        exact = np.diff(trajectory.passage_times) * rate
        periods = np.ceil(exact - 1e-6).astype(np.intp)
        periods += np.where(problem.displacements.any(axis=1), extra, 0)
        waypoints = np.concatenate([[0], np.cumsum(periods)])
        for waypoint, time in sorted(asked.times(problem).items()):
            nearest = round(time * rate)
            if abs(nearest / rate - time) > 1e-9 * time:
                raise InputError(
                    f"rate: waypoint {waypoint + 1} is asked for at {time:.9g} s, between two points at "
                    f"{rate:g} points per second; {nearest / rate:.9g} s is the time of a point"
                )
            waypoints[: waypoint + 1] = np.minimum(waypoints[: waypoint + 1], nearest)
            waypoints[waypoint:] += nearest - waypoints[waypoint]
        stamps = np.rint(np.arange(waypoints[-1] + 1) * (1e9 / rate)).astype(np.intp)
        return _Grid(stamps, waypoints)

    @staticmethod
    def at_switches(
        problem: Problem, trajectory: Trajectory, stretch: float, asked: Conditions
    ) -> _Grid:
        """Points where the jerk switches, those too close together merged, and further ones between."""
        fixed = asked.times(problem)
        factor = 1.0 if problem.n_segments in fixed else 1.0 + stretch
        passed = trajectory.passage_times * factor
        for waypoint, time in fixed.items():
            passed[waypoint] = time
        distance = _least_distance(problem, trajectory.seconds, _MERGED_MARGIN)
        warped = np.interp(trajectory.breaks, trajectory.passage_times, passed)
        kept = [0.0]
        for start, end in itertools.pairwise(passed):
            inside = warped[(warped > start) & (warped < end)]
            even = np.linspace(start, end, max(2, ceil((end - start) / passed[-1] * _EVEN_CELLS)))
            for time in np.sort(np.concatenate([inside, even[1:-1]])):
                if time - kept[-1] >= distance and end - time >= distance:
                    kept.append(float(time))
            if end > kept[-1]:
                kept.append(float(end))
        stamps = np.unique(np.rint(np.array(kept) * 1e9).astype(np.intp))
        waypoints = np.searchsorted(stamps, np.rint(passed * 1e9).astype(np.intp))
        return _Grid(stamps, waypoints)

    def cells(self, switches: Array, passed: Array, most: int) -> Indices:
        """Points that bound the cells of one joint: near its switching times, and evenly between."""
        images = np.interp(switches, passed, self.times[self.waypoints])
        below = np.searchsorted(self.times, images)[:, None] + np.arange(-2, 2)
        last = len(self.stamps) - 1
        chosen = np.unique(np.concatenate([below.clip(0, last).ravel(), self.waypoints]))
        longest = max(1, ceil(last / most))
        parts = np.maximum(1, -(-np.diff(chosen) // longest))
        inner = [
            np.rint(np.linspace(start, end, count + 1)[:-1])
            for start, end, count in zip(chosen[:-1], chosen[1:], parts, strict=True)
        ]
        return np.unique(np.concatenate([*inner, [last]]).astype(np.intp))


def _solve(problem: Problem, trajectory: Trajectory, grid: _Grid, asked: Conditions) -> AtPoints | None:
    """All joints on one grid; None where one of them has no motion."""
    times = grid.times
    if len(times) < 2:
        return None
    margins = _margins(problem, float(times[-1]), float(np.diff(times).min()))
    bounds = _Bounds.of(problem, asked, margins)
    jerks = np.zeros((len(times) - 1, problem.dof))
    starts = np.zeros((3, problem.dof))
    starts[0] = problem.waypoints[0]
    used = {0, len(times) - 1, *grid.waypoints.tolist()}
    passed = trajectory.passage_times
    for joint in range(problem.dof):
        if not np.ptp(problem.waypoints[:, joint]) > 0.0 and not bounds.moves_at_ends(joint):
            continue
        cells = grid.cells(_switches(trajectory, joint), passed, _EVEN_CELLS)
        found = _joint(times[cells], np.searchsorted(cells, grid.waypoints), bounds.of_joint(joint))
        if found is None:
            return None
        values, starts[:, joint] = found
        jerks[:, joint] = np.repeat(values, np.diff(cells))
        used.update(cells.tolist())
    breaks = np.array(sorted(used))
    lengths = np.diff(times[breaks])
    states = _integrated(lengths, jerks[breaks[:-1]], starts)[:, :-1]
    coefficients = np.stack([states[0], states[1], states[2] / 2.0, jerks[breaks[:-1]] / 6.0], axis=-1)
    motion = Trajectory(lengths, coefficients, times[grid.waypoints])
    return AtPoints(motion, times, float(margins[2][np.isfinite(problem.limits.jerk)].max(initial=0.0)))


def _switches(trajectory: Trajectory, joint: int) -> Array:
    """Times at which the highest derivative of one joint changes, both ends included [s]."""
    highest = trajectory.coefficients[:, joint, 1:]
    change = np.abs(np.diff(highest[:, 2:], axis=0)).max(axis=1, initial=0.0)
    own = change > 1e-6 * np.abs(highest[:, 2:]).max(initial=0.0)
    return np.concatenate([[0.0], trajectory.breaks[1:-1][own], [trajectory.seconds]])


@dataclass(frozen=True)
class _JointBounds:
    """What one joint keeps: limits per segment (n_segments,), position (n_segments, 2), states at ends."""

    waypoints: Array
    velocity: Array
    acceleration: Array
    jerk: Array
    position: Array
    end_velocity: Array  # (2,)
    rests: bool  # whether the acceleration is zero at both ends and at stops
    stops: tuple[int, ...]


@dataclass(frozen=True)
class _Bounds:
    """Limits less the margins, for all joints."""

    problem: Problem
    asked: Conditions
    limits: Array  # (3, n_segments, dof)

    @staticmethod
    def of(problem: Problem, asked: Conditions, margins: Array) -> _Bounds:
        limits = asked.derivatives(problem) * (1.0 - np.minimum(margins, 0.5))[:, None]
        return _Bounds(problem, asked, limits)

    def moves_at_ends(self, joint: int) -> bool:
        return bool(self.asked.end_velocities(self.problem)[:, joint].any())

    def of_joint(self, joint: int) -> _JointBounds:
        problem = self.problem
        return _JointBounds(
            waypoints=problem.waypoints[:, joint],
            velocity=self.limits[0, :, joint],
            acceleration=self.limits[1, :, joint],
            jerk=self.limits[2, :, joint],
            position=self.asked.position_bounds(problem)[:, joint],
            end_velocity=self.asked.end_velocities(problem)[:, joint],
            rests=bool(np.isfinite(problem.limits.jerk[joint])),
            stops=tuple(sorted(self.asked.stops)),
        )


def _joint(times: Array, waypoints: Indices, bounds: _JointBounds) -> tuple[Array, Array] | None:
    """Jerk on each cell, (n_cells,), and the state at the start, (3,): least share of the jerk limit.

    Variables in units that make them of order one: j, a, v, p and the share s of the jerk limit.
    """
    d = np.diff(times)
    n = len(d)
    segment = np.clip(np.searchsorted(waypoints, np.arange(n), side="right") - 1, 0, None)
    segment = np.minimum(segment, len(bounds.velocity) - 1)
    total = float(times[-1])
    unit_p = max(
        float(np.ptp(bounds.waypoints)), float(np.abs(bounds.end_velocity).max()) * total, 1e-9
    )
    unit_a = float(bounds.acceleration.max())
    unit_v = min(float(bounds.velocity.max()), unit_a * total)
    finite = np.isfinite(bounds.jerk).all()
    unit_j = float(bounds.jerk.max()) if finite else 2.0 * unit_a / float(d.min())
    j, a, v, p = 0, n, 2 * n + 1, 3 * n + 2
    share, size = 4 * n + 3, 4 * n + 4
    k = np.arange(n)
    one = np.ones(n)

    def matrix(rows: int, *entries: tuple[Array, Array, Array]) -> csr_matrix:
        at, columns, values = (np.concatenate(part) for part in zip(*entries, strict=True))
        return csr_matrix((values, (at, columns)), shape=(rows, size))

    # exact integration over a cell: a' = a + j d, v' = v + a d + j d^2/2, p' = p + v d + a d^2/2 + j d^3/6
    integration = matrix(
        3 * n,
        (k, a + k + 1, one), (k, a + k, -one), (k, j + k, -d * unit_j / unit_a),
        (n + k, v + k + 1, one), (n + k, v + k, -one),
        (n + k, a + k, -d * unit_a / unit_v), (n + k, j + k, -(d**2) / 2.0 * unit_j / unit_v),
        (2 * n + k, p + k + 1, one), (2 * n + k, p + k, -one), (2 * n + k, v + k, -d * unit_v / unit_p),
        (2 * n + k, a + k, -(d**2) / 2.0 * unit_a / unit_p),
        (2 * n + k, j + k, -(d**3) / 6.0 * unit_j / unit_p),
    )  # fmt: skip
    lower, upper = np.full(size, -np.inf), np.full(size, np.inf)
    before = np.concatenate([segment[:1], segment])  # a state belongs to the cells on both sides
    after = np.concatenate([segment, segment[-1:]])
    for first, unit, limit in ((a, unit_a, bounds.acceleration), (v, unit_v, bounds.velocity)):
        largest = np.minimum(limit[before], limit[after]) / unit
        lower[first : first + n + 1], upper[first : first + n + 1] = -largest, largest
    origin = bounds.waypoints[0]
    lower[p : p + n + 1] = (
        np.maximum(bounds.position[before, 0], bounds.position[after, 0]) - origin
    ) / unit_p
    upper[p : p + n + 1] = (
        np.minimum(bounds.position[before, 1], bounds.position[after, 1]) - origin
    ) / unit_p
    lower[share], upper[share] = 0.0, 1.0

    def fix(variable: int, value: float) -> None:
        lower[variable] = upper[variable] = value

    for point, value in zip(waypoints, bounds.waypoints, strict=True):
        fix(p + point, (value - origin) / unit_p)
    fix(v, bounds.end_velocity[0] / unit_v)
    fix(v + n, bounds.end_velocity[1] / unit_v)
    for point in (waypoints[stop] for stop in bounds.stops):
        fix(v + point, 0.0)
    if bounds.rests:
        for point in (0, n, *(waypoints[stop] for stop in bounds.stops)):
            fix(a + point, 0.0)

    # Bernstein coefficients of velocity (quadratic) and position (cubic) inside each cell
    middle = matrix(n, (k, v + k, one), (k, a + k, d / 2.0 * unit_a / unit_v))
    jerk = matrix(
        n, (k, j + k, one), (k, np.full(n, share), -bounds.jerk[segment] / unit_j if finite else -one)
    )
    other = matrix(
        n, (k, j + k, -one), (k, np.full(n, share), -bounds.jerk[segment] / unit_j if finite else -one)
    )
    speed = bounds.velocity[segment] / unit_v
    rows, most = [middle, -middle, jerk, other], [speed, speed, np.zeros(n), np.zeros(n)]
    if np.isfinite(bounds.position).any():
        for inner in (
            matrix(n, (k, p + k, one), (k, v + k, d / 3.0 * unit_v / unit_p)),
            matrix(n, (k, p + k, one), (k, v + k, d * 2.0 / 3.0 * unit_v / unit_p),
                   (k, a + k, d**2 / 6.0 * unit_a / unit_p)),
        ):  # fmt: skip
            for sign, side in ((-1.0, 0), (1.0, 1)):
                limit = sign * (bounds.position[segment, side] - origin) / unit_p
                if np.isfinite(limit).all():
                    rows.append(sign * inner)
                    most.append(limit)
    cost = np.zeros(size)
    cost[share] = 1.0
    answer = linprog(
        cost, A_ub=vstack(rows, format="csr"), b_ub=np.concatenate(most), A_eq=integration,
        b_eq=np.zeros(3 * n), bounds=np.stack([lower, upper], axis=1), method="highs",
        options={"primal_feasibility_tolerance": 1e-10},
    )  # fmt: skip
    if answer.x is None:
        return None
    jerks = answer.x[j : j + n] * unit_j
    start = np.array([origin, bounds.end_velocity[0], 0.0 if bounds.rests else answer.x[a] * unit_a])
    return _corrected(times, jerks, start, waypoints, bounds), start


def _corrected(
    times: Array, jerks: Array, start: Array, waypoints: Indices, bounds: _JointBounds
) -> Array:
    """The jerks nearest to those of the linear program that meet every fixed state to rounding."""
    d = np.diff(times)
    for _ in range(2):
        states = _integrated(d, jerks[:, None], start[:, None])[..., 0]
        fixed: list[tuple[int, int, float]] = [
            (0, int(point), float(value))
            for point, value in zip(waypoints[1:], bounds.waypoints[1:], strict=True)
        ]
        fixed.append((1, len(d), float(bounds.end_velocity[1])))
        fixed += [(1, int(waypoints[stop]), 0.0) for stop in bounds.stops if waypoints[stop] < len(d)]
        if bounds.rests:
            fixed += [
                (2, int(waypoints[stop]), 0.0) for stop in bounds.stops if waypoints[stop] < len(d)
            ]
            fixed.append((2, len(d), 0.0))
        effects = np.array([_effect(times, order, point) for order, point, _ in fixed])
        missing = np.array([value - states[order, point] for order, point, value in fixed])
        scale = np.abs(effects).max(axis=1)
        usable = scale > 0.0
        weighted = effects[usable] / scale[usable, None]
        change, *_ = np.linalg.lstsq(weighted, missing[usable] / scale[usable], rcond=1e-13)
        jerks = jerks + change
    return np.asarray(jerks)


def _effect(times: Array, order: int, point: int) -> Array:
    """Derivative of one state at a point by the jerk of each cell, (n_cells,)."""
    power = 3 - order
    end = np.maximum(times[point] - times[:-1], 0.0)
    rest = np.maximum(times[point] - times[1:], 0.0)
    return np.asarray((end**power - rest**power) / (1.0, 1.0, 2.0, 6.0)[power])


def _integrated(lengths: Array, jerks: Array, start: Array) -> Array:
    """Position, velocity and acceleration at the ends of all cells, (3, n_cells + 1, dof)."""
    d = lengths[:, None]
    acceleration = np.concatenate([start[2:3], start[2] + np.cumsum(jerks * d, axis=0)])
    steps = acceleration[:-1] * d + jerks * d**2 / 2.0
    velocity = np.concatenate([start[1:2], start[1] + np.cumsum(steps, axis=0)])
    steps = velocity[:-1] * d + acceleration[:-1] * d**2 / 2.0 + jerks * d**3 / 6.0
    position = np.concatenate([start[0:1], start[0] + np.cumsum(steps, axis=0)])
    return np.stack([position, velocity, acceleration])
