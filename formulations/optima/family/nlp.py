"""The exact nonlinear program of a spline family from one start, solved by CasADi/IPOPT.

    minimise    sum_k T_k                                     over y = log T
    subject to  |q_j^(r)(t)| <= limit_j^(r)   for every t, joint j, derivative r = 1, 2, 3
                low_j <= q_j(t) <= high_j     for every t

The constraints hold at every instant, so each is a semi-infinite one. It is posed at both ends of
each piece and at the extremes of the current iterate, and posed again at the extremes of the
solution until they stay where they are (exchange). Fixed sample points stall up to 0.4 % away, and
exchange alone where the extremes wander, so near the end the posed place follows its extreme as
the durations vary, by one Newton step on q^(r+1) inside the program: correct to second order.
Stretching by the exact factor makes every iterate feasible.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi
import numpy as np

from formulations.families import Family
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

_FIXED_EXCHANGES = 3  # rounds before the posed places follow their extremes
_EXCHANGES = 40  # rounds of exchange before a start is given up as not converged
_FREE, _VANISHED = 30.0, 1e-9  # log radius of the trust region: none, and when no step is left
_LARGEST = 1e300  # rad; derivatives of larger coefficients overflow
_CONVERGED = 1e-10  # relative excess of the exact peaks over the posed ones
SHORTEST = 1e-10  # least duration of a segment, as a share of the displacement bound

_IPOPT: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.tol": 1e-11,
    "ipopt.acceptable_tol": 1e-9,
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.mu_strategy": "adaptive",
    "ipopt.max_iter": 300,
    "error_on_fail": False,
    "show_eval_warnings": False,  # a step too far is IPOPT's to take back
}


@dataclass(frozen=True)
class Start:
    """One start of the local solver: where it ended and how."""

    durations: Array
    seconds: float
    status: str
    exchanges: int


def shortest_segments(problem: Problem) -> Array:
    """Lower bounds on each duration from displacement and limits alone, (n_segments,) [s], > 0.

    |d| <= V T, and rest to rest is not even asked for: a scale for starts and boxes, not a tight bound.
    """
    d = np.abs(problem.displacements)
    limits = problem.limits
    each = np.maximum.reduce(
        [d / limits.velocity, np.sqrt(d / limits.acceleration), np.cbrt(d / limits.jerk)]
    ).max(axis=1)
    return np.asarray(np.maximum(each, SHORTEST * max(float(each.sum()), 1e-300)))


class Exchange:
    """Solve, pose again at the extremes of the solution, until they stay where they are."""

    def __init__(self, problem: Problem, family: Family) -> None:
        self.problem, self.family = problem, family
        self.programs: dict[tuple[int, ...], _Program] = {}
        # joints whose position limits are posed: few come near theirs, and these rows are the dearest
        self.bounded = {j for j in problem.moving_joints if _rests_on_a_limit(problem, j)}

    def solve(self, guess: Array) -> Start:
        """Exchange from one start within a trust region; each iterate is stretched to feasibility.

        An iterate that is not faster is taken back and the region shrunk: rows posed at one spline's
        extremes say little about splines far away.
        """
        centre = self._feasible(guess)
        if not (np.isfinite(centre).all() and (centre > 0.0).all() and np.isfinite(centre.sum())):
            return Start(guess, np.inf, "not finite (no stretch of the start keeps the limits)", 0)
        shortest = self._seconds(centre)
        radius, follow, status = _FREE, False, "not converged"
        for exchange in range(1, _EXCHANGES + 1):
            solved, outcome = self._program(centre).solve(centre, radius, follow)
            if not np.isfinite(solved).all():
                return Start(centre, shortest, f"not finite ({outcome})", exchange)
            step = float(np.abs(np.log(solved / centre)).max())
            found = self._feasible(solved)
            if leaving := self._leaving(found) - self.bounded:
                self.bounded |= leaving
                self.programs.clear()
                continue
            seconds = self._seconds(found)
            # the posed rows were all that matters, and the region did not hold the step back
            exact = abs(found.sum() / solved.sum() - 1.0) <= _CONVERGED and step < 0.999 * radius
            exact = exact and self.family.pattern(solved) == self.family.pattern(centre)
            settled = exact and seconds <= shortest * (1.0 + _CONVERGED) and np.isfinite(seconds)
            if seconds < shortest or not np.isfinite(shortest):
                centre, shortest = found, seconds
                radius = min(2.0 * radius, _FREE)
            elif not settled:
                radius, follow = 0.25 * min(radius, step), True
            if settled:
                status = "ok" if outcome == "Solve_Succeeded" else outcome
                break
            if radius < _VANISHED:
                status = f"step vanished ({outcome})"
                break
            follow = follow or exchange >= _FIXED_EXCHANGES
        return Start(centre, shortest, status, exchange)

    def _seconds(self, durations: Array) -> float:
        """Total time [s], infinite where the position limits are left."""
        excess = self.family.position_excess(self.problem, durations[None])[0]
        return float(durations.sum()) if excess <= self.problem.position_slack else np.inf

    def _leaving(self, durations: Array) -> set[int]:
        """Joints that leave their position limits."""
        if self.family.position_excess(self.problem, durations[None])[0] <= 0.0:
            return set()
        positions = self.family.trajectory(self.problem, durations).extremes(0)
        low, high = self.problem.position_bounds.T
        outside = (positions.low.min(axis=0) < low) | (positions.high.max(axis=0) > high)
        return set(np.flatnonzero(outside).tolist())

    def _feasible(self, durations: Array) -> Array:
        return np.asarray(durations * self.family.stretch(self.problem, durations[None])[0])

    def _program(self, durations: Array) -> _Program:
        pattern = self.family.pattern(durations)
        if pattern not in self.programs:
            self.programs[pattern] = _Program(self.problem, self.family, durations, self.bounded)
        return self.programs[pattern]


class _Program:
    """The NLP of one problem; the places where constraints are posed are parameters.

    near: durations with the pattern of knots that the program is built for. bounded: joints whose
    position limits are posed.
    """

    def __init__(self, problem: Problem, family: Family, near: Array, bounded: set[int]) -> None:
        self.problem, self.family = problem, family
        self.degrees = family.degrees(problem.n_segments)
        y = casadi.SX.sym("y", problem.n_segments)
        t = casadi.exp(y)
        times = [t[k] for k in range(problem.n_segments)]
        self.rows: list[casadi.SX] = []
        self.places: list[casadi.SX] = []
        self.lower: list[float] = []
        self.upper: list[float] = []
        self.posed: list[tuple[int, int, int, int]] = []  # joint, piece, order, extreme or -1, -2
        moving = problem.moving_joints
        lengths, splines = family.symbols(problem.waypoints[:, moving], times, near)
        for j, pieces in zip(moving, splines, strict=True):
            for k, (length, c) in enumerate(zip(lengths, pieces, strict=True)):
                for order in range(0 if j in bounded else 1, 4):
                    self._pose(j, k, order, length, c[: self.degrees[k] + 1])
        shortest = shortest_segments(problem)
        nlp = {
            "x": y,
            "p": casadi.vertcat(*self.places),
            "f": casadi.sum1(t) / float(shortest.sum()),
            "g": casadi.vertcat(*self.rows),
        }
        options = dict(_IPOPT)
        if family.pattern(
            near
        ):  # second derivatives of a B-spline take longer to build than to do without
            options["ipopt.hessian_approximation"] = "limited-memory"
        self.solver = casadi.nlpsol("family", "ipopt", nlp, options)
        self.floor = float(np.log(SHORTEST * shortest.sum()))

    def _pose(self, j: int, k: int, order: int, length: casadi.SX, c: list[casadi.SX]) -> None:
        """Rows for one derivative of one joint on one piece: its value over its limit, in [-1, 1]."""
        problem = self.problem
        last = len(self.degrees) - 1
        if order == 0:
            # at waypoints the position is what it is
            inner = len(self.degrees) != problem.n_segments
            ends = [end for end, there in ((-2, inner and k > 0), (-1, inner and k < last)) if there]
            origin = float(problem.waypoints[0, j])
            scale = float(np.ptp(problem.waypoints[:, j]))
            low, high = ((problem.position_bounds[j] - origin) / scale).tolist()
        else:
            ends = [-1, -2]
            origin, scale = 0.0, float(problem.limits.derivatives[order - 1, j])
            low, high = -1.0, 1.0
        if not (np.isfinite(scale) and (np.isfinite(low) or np.isfinite(high))):
            return
        if order == 0 and k in (0, last):
            self._leave(j, k, c, low, high)
        value = _derivative(c, order)
        for which in [*ends, *range(len(value) - 2)]:
            s, follow = casadi.SX.sym("s"), casadi.SX.sym("follow")
            place = s
            if which >= 0:
                slope, bend = _derivative(value, 1), _derivative(value, 2)
                curvature = casadi.if_else(follow > 0, _at(bend, s), 1.0)
                # an extreme that has left the piece is over at its end
                step = s - follow * _at(slope, s) / curvature
                place = casadi.fmin(casadi.fmax(step, 0.0), 1.0)
            self.rows.append((_at(value, place) / length**order - origin) / scale)
            self.places.append(casadi.vertcat(s, follow))
            self.lower.append(low)
            self.upper.append(high)
            self.posed.append((j, k, order, which))

    def _leave(self, j: int, k: int, c: list[casadi.SX], low: float, high: float) -> None:
        """A joint that rests on its limit leaves it, and comes to it, on the inner side.

        Velocity and acceleration vanish there, so the jerk decides; no extreme marks the spot.
        """
        jerk = _derivative(c, 3)
        at_start = k == 0
        x = float(self.problem.waypoints[0 if at_start else -1, j])
        bounds = self.problem.position_bounds[j]
        for bound, inward in zip(bounds, (1.0, -1.0), strict=True):
            if _touches(x, bound):
                sign = inward if at_start else -inward
                self.rows.append(sign * _at(jerk, casadi.SX(0.0 if at_start else 1.0)))
                self.places.append(casadi.SX.sym("unused", 2))
                self.lower.append(0.0)
                self.upper.append(float("inf"))
                self.posed.append((j, k, 3, -2 if at_start else -1))

    def solve(self, centre: Array, radius: float, follow: bool) -> tuple[Array, str]:
        """Durations of the local optimum within the trust region, and IPOPT's word for how it ended."""
        spline = self.family.coefficients(self.problem, centre[None])[0]
        if not np.abs(spline).max() < _LARGEST:
            return np.full_like(centre, np.nan), "the spline leaves the range of floats"
        y = np.log(centre)
        most = np.minimum(y + radius, np.log(centre.sum() * 10.0))
        # a duration that is below the floor by more than the radius rises by the radius alone
        least = np.minimum(np.maximum(y - radius, self.floor), most)
        try:
            answer = self.solver(
                x0=y, p=self._extremes(spline, follow), lbg=self.lower, ubg=self.upper, lbx=least, ubx=most
            )
            outcome = str(self.solver.stats()["return_status"])
        except RuntimeError as error:  # CasADi's only exception: the solver refused the program
            return np.full_like(centre, np.nan), str(error).strip().splitlines()[-1]
        except np.linalg.LinAlgError as error:
            return np.full_like(centre, np.nan), str(error)
        return np.exp(np.asarray(answer["x"]).ravel()), outcome

    def _extremes(self, spline: Array, follow: bool) -> Array:
        """Where the rows are posed: normalised time, and whether it follows its extreme."""
        found: dict[tuple[int, int, int], Array] = {}
        places = np.zeros((len(self.posed), 2))
        for row, (j, k, order, which) in enumerate(self.posed):
            if which < 0:
                places[row, 0] = which + 2.0
                continue
            key = (j, k, order)
            if key not in found:
                value = np.polynomial.Polynomial(spline[k, j, : self.degrees[k] + 1]).deriv(order)
                found[key] = _inner_extremes(value)
            places[row] = found[key][which]
        places[:, 1] *= follow
        return places.ravel()


def _touches(x: float, bound: float) -> bool:
    return abs(x - bound) <= 1e-9 * (1.0 + abs(x))


def _rests_on_a_limit(problem: Problem, j: int) -> bool:
    """Whether a joint starts or ends on a position limit."""
    ends = problem.waypoints[[0, -1], j].tolist()
    return any(_touches(x, bound) for x in ends for bound in problem.position_bounds[j].tolist())


def _inner_extremes(value: np.polynomial.Polynomial) -> Array:
    """Extremes in (0, 1), (degree - 1, 2): place, and 1 if it is a true one, not a spread filler."""
    count = len(value.coef) - 2
    slope = value.deriv(1)
    size = float(np.abs(slope.coef).max())
    places = np.stack([(np.arange(count) + 1.0) / (count + 1.0), np.zeros(count)], axis=1)
    if size > 0.0:
        roots = slope.trim(1e-14 * size).roots()
        inner = np.sort(roots[np.abs(roots.imag) < 1e-9].real) if len(roots) else np.empty(0)
        inner = inner[(inner > 0.0) & (inner < 1.0)][:count]
        places[: len(inner), 0] = inner
        # an inflection has no curvature to follow along
        places[: len(inner), 1] = np.abs(slope.deriv(1)(inner)) > 1e-6 * size
    return places


def _at(polynomial: list[casadi.SX], s: casadi.SX) -> casadi.SX:
    value = casadi.SX(0)
    for c in reversed(polynomial):
        value = value * s + c
    return value


def _derivative(polynomial: list[casadi.SX], order: int) -> list[casadi.SX]:
    for _ in range(order):
        polynomial = [i * c for i, c in enumerate(polynomial)][1:]
    return polynomial
