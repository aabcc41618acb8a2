"""The exact nonlinear program of a spline family, solved by CasADi/IPOPT from many starts.

    minimise    sum_k T_k                                     over y = log T
    subject to  |q_j^(r)(t)| <= limit_j^(r)   for every t, joint j, derivative r = 1, 2, 3
                low_j <= q_j(t) <= high_j     for every t

The constraints hold at every instant, so each is a semi-infinite one. It is posed at both ends of
each piece and at the extremes of the current iterate, and posed again at the extremes of the
solution until they stay where they are (exchange). Fixed sample points stall up to 0.4 % away, and
exchange alone where the extremes wander, so near the end the posed place follows its extreme as
the durations vary, by one Newton step on q^(r+1) inside the program: correct to second order.
Stretching by the exact factor makes every iterate feasible, so each start ends in a verified motion.

A local solver proves nothing: the best of its starts is an upper bound.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray

from formulations.errors import InputError, NoFeasibleMotion
from formulations.families import FAMILIES, Family
from formulations.problem import Array, Problem
from formulations.trajectory import Trajectory, Verdict, check

_FIXED_EXCHANGES = 3  # rounds before the posed places follow their extremes
_EXCHANGES = 40  # rounds of exchange before a start is given up as not converged
_FREE, _VANISHED = 30.0, 1e-9  # log radius of the trust region: none, and when no step is left
_CONVERGED = 1e-10  # relative excess of the exact peaks over the posed ones
_SAMPLE, _NICHES, _APART = 8192, 4, 0.7  # shapes looked at, starts made of them, their log distance
_AGREEING = 3  # starts that end alike and make more of a dear family needless
_SHORTEST = 1e-10  # least duration of a segment, as a share of the displacement bound

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


@dataclass(frozen=True)
class FamilyOptimum:
    """The best of all starts, judged by the independent check. durations: (n_segments,) [s]."""

    problem: Problem
    family: str
    durations: Array
    starts: tuple[Start, ...]

    @property
    def seconds(self) -> float:
        """Total time [s]."""
        return float(self.durations.sum())

    @cached_property
    def trajectory(self) -> Trajectory:
        """The motion itself."""
        return FAMILIES[self.family].trajectory(self.problem, self.durations)

    @cached_property
    def verdict(self) -> Verdict:
        """What the independent check says of it."""
        return check(self.problem, self.trajectory)

    @property
    def agreeing_starts(self) -> int:
        """Number of starts that ended within 1e-7 of the best."""
        return sum(start.seconds <= self.seconds * (1.0 + 1e-7) for start in self.starts)


def family_optimum(
    problem: Problem,
    *,
    family: str | None = None,
    random_starts: int | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> FamilyOptimum:
    """Shortest total time of a family's splines for durations shared by all joints.

    family: the problem's own if left out. random_starts: beside the two plain and four promising ones;
    8 if left out, none for B-splines. Raises UnsupportedProblem where the family has no spline,
    NoFeasibleMotion if no start ends feasible (position limits only; all others yield to a stretch).
    """
    chosen = FAMILIES[family or problem.family]
    chosen.require(problem)
    if not problem.moving_joints:
        durations = np.full(problem.n_segments, _SHORTEST)
        still = Start(durations, float(durations.sum()), "nothing moves", 0)
        return FamilyOptimum(problem, chosen.name, durations, (still,))
    exchange = _Exchange(problem, chosen)
    starts = []
    dear = bool(chosen.pattern(np.ones(problem.n_segments)))
    if random_starts is None:
        # a program per pattern of knots is dear, and starts far away have patterns of their own
        random_starts = 0 if dear else 8
    guesses = _guesses(problem, chosen, random_starts, seed)
    for index, guess in enumerate(guesses):
        starts.append(exchange.solve(guess))
        if progress is not None:
            progress((index + 1) / len(guesses))
        times = np.array([start.seconds for start in starts])
        if dear and len(starts) == _AGREEING and np.ptp(times) <= 1e-7 * times.min():
            break
    best = min(starts, key=lambda start: start.seconds)
    if not np.isfinite(best.seconds):
        raise NoFeasibleMotion(
            f"none of {len(starts)} starts ended in a {chosen.name} spline that keeps the position "
            f"limits; last status: {starts[-1].status}"
        )
    return FamilyOptimum(problem, chosen.name, best.durations, tuple(starts))


def polished(problem: Problem, guess: Array, *, family: str | None = None) -> Start:
    """The local optimum from one start, durations (n_segments,) [s] of any shape."""
    return _Exchange(problem, FAMILIES[family or problem.family]).solve(guess)


def each_joint_alone(
    problem: Problem, *, random_starts: int | None = None, seed: int = 0
) -> tuple[FamilyOptimum | None, ...]:
    """The optimum of every joint by itself, as the papers plan; None for joints that do not move."""
    return tuple(
        family_optimum(problem.joint(j), random_starts=random_starts, seed=seed)
        if j in problem.moving_joints
        else None
        for j in range(problem.dof)
    )


@dataclass(frozen=True)
class LongestSegment:
    """The papers' rule (000 sec. 2.2; 001 sec. 3; 002 sec. 5.2): longest time per segment.

    claimed: (n_segments,) [s], the durations the rule gives. stretch: the least factor on them that
    keeps the limits; above 1 the rule's own motion breaks them. position_excess: rad outside the
    position limits, which no stretch mends.
    """

    claimed: Array
    stretch: float
    position_excess: float

    @property
    def durations(self) -> Array:
        """Durations stretched to feasibility, as claimed if they are feasible, (n_segments,) [s]."""
        return self.claimed * max(self.stretch, 1.0)


def longest_segment(problem: Problem, per_joint: list[Array]) -> LongestSegment:
    """Apply the rule to the durations of single joints, each (n_segments,) [s]."""
    if not per_joint:
        raise InputError("longest_segment: no joint moves")
    claimed = np.max(per_joint, axis=0)
    chosen = FAMILIES[problem.family]
    return LongestSegment(
        claimed=claimed,
        stretch=float(chosen.stretch(problem, claimed[None])[0]),
        position_excess=float(chosen.position_excess(problem, claimed[None])[0]),
    )


def shortest_segments(problem: Problem) -> Array:
    """Lower bounds on each duration from displacement and limits alone, (n_segments,) [s], > 0.

    |d| <= V T, and rest to rest is not even asked for: a scale for starts and boxes, not a tight bound.
    """
    d = np.abs(problem.displacements)
    limits = problem.limits
    each = np.maximum.reduce(
        [d / limits.velocity, np.sqrt(d / limits.acceleration), np.cbrt(d / limits.jerk)]
    ).max(axis=1)
    return np.asarray(np.maximum(each, _SHORTEST * max(float(each.sum()), 1e-300)))


def _guesses(problem: Problem, family: Family, random_starts: int, seed: int) -> list[Array]:
    """Starts: displacement times, their geometric mean with the longest, random ratios, and the best
    shapes among many: a narrow basin is seen by the compiled kernel for next to nothing.
    """
    shortest = shortest_segments(problem)
    scale = np.maximum(shortest, 1e-2 * shortest.max())
    rng = np.random.default_rng(seed)
    ratios = rng.uniform(np.log(0.1), np.log(10.0), (random_starts, len(scale)))
    plain = [scale, np.sqrt(scale * scale.max()), *(scale * np.exp(row) for row in ratios)]
    promising = _promising(problem, family, plain[0], rng)
    return [plain[0], *promising[:1], *plain[1:], *promising[1:]]


def _promising(problem: Problem, family: Family, first: Array, rng: np.random.Generator) -> list[Array]:
    """The best shapes of a random sample, at most ``_NICHES``, each in a neighbourhood of its own."""
    upper = float(first.sum() * family.stretch(problem, first[None])[0])
    lower = np.maximum(shortest_segments(problem), 1e-7 * upper)
    span = np.log(upper / np.minimum(lower, 0.5 * upper))
    shapes = upper * np.exp(-span * rng.random((_SAMPLE, problem.n_segments)))
    # half of the sample halves in size round by round about the best of what is known
    for radius in (1.0, 0.3, 0.1):
        best = shapes[_ranked(problem, family, shapes)[: 2 * _NICHES]]
        if not len(best):
            return []
        near = best[rng.integers(len(best), size=_SAMPLE // 4)]
        steps = np.exp(radius * rng.normal(size=near.shape))
        shapes = np.concatenate([shapes, near * steps])
    niches: list[Array] = []
    for shape in shapes[_ranked(problem, family, shapes)]:
        ratios = np.log(shape / shape.sum())
        if all(np.abs(ratios - np.log(n / n.sum())).max() > _APART for n in niches):
            niches.append(shape)
            if len(niches) == _NICHES:
                break
    return niches


def _ranked(problem: Problem, family: Family, shapes: Array) -> NDArray[np.intp]:
    """Indices of the feasible shapes, best first."""
    seconds = shapes.sum(axis=1) * family.stretch(problem, shapes)
    seconds[family.position_excess(problem, shapes) > 0.0] = np.inf
    order = np.argsort(seconds, kind="stable")
    return np.asarray(order[np.isfinite(seconds[order])])


class _Exchange:
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
        self.floor = float(np.log(_SHORTEST * shortest.sum()))

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
        y = np.log(centre)
        answer = self.solver(
            x0=y,
            p=self._extremes(centre, follow),
            lbg=self.lower,
            ubg=self.upper,
            lbx=np.maximum(y - radius, self.floor),
            ubx=np.minimum(y + radius, np.log(centre.sum() * 10.0)),
        )
        return np.exp(np.asarray(answer["x"]).ravel()), str(self.solver.stats()["return_status"])

    def _extremes(self, durations: Array, follow: bool) -> Array:
        """Where the rows are posed: normalised time, and whether it follows its extreme."""
        spline = self.family.coefficients(self.problem, durations[None])[0]
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
