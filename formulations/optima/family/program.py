"""The nonlinear program of a spline family, with its constraints posed at given places.

    minimise    sum_k T_k                                     over y = log T
    subject to  |q_j^(r)(t)| <= limit_j^(r)   for every t, joint j, derivative r = 1, 2, 3
                low_j <= q_j(t) <= high_j     for every t

The constraints hold at every instant, so the program is a semi-infinite one. Here each constraint is
posed at both ends of each piece and at the inner extremes of the current iterate; ``exchange`` poses
them again at the extremes of the solution until these no longer move. Fixed sample points end up to
0.4 % away from the optimum, and exchange alone does not converge where the extremes wander. So, near
the end, each posed place follows its extreme as the durations vary, by one Newton step on q^(r+1)
inside the program: this is correct to second order. CasADi builds the program, IPOPT solves it.
"""

from __future__ import annotations

from typing import Any

import casadi
import numpy as np

from formulations.deadlines import NEVER, Deadline
from formulations.deadlines.ipopt import StoppableIpopt
from formulations.families import Family
from formulations.motion.extremes import differentiated, evaluated, roots_of
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

NO_RADIUS = 30.0  # radius of a trust region in log T that does not bind
SHORTEST = 1e-10  # least duration of a segment, as a share of the sum of the duration scales
_LARGEST = 1e300  # rad; derivatives of larger coefficients overflow

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
    "show_eval_warnings": False,  # IPOPT itself takes back a step that is too long
}


def duration_scales(problem: Problem) -> Array:
    """Estimate the size of each duration from its displacement and the limits alone.

    The largest of |d| / V, sqrt(|d| / A) and cbrt(|d| / J) over the joints: a scale for starts and
    boxes, not a bound.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.

    Returns
    -------
    Array, shape (n_segments,) [s]
        Positive scales, also where nothing moves.
    """
    d = np.abs(problem.displacements)
    limits = problem.limits
    each = np.maximum.reduce(
        [d / limits.velocity, np.sqrt(d / limits.acceleration), np.cbrt(d / limits.jerk)]
    ).max(axis=1)
    return np.asarray(np.maximum(each, SHORTEST * max(float(each.sum()), 1e-300)))


class PosedProgram:
    """The nonlinear program of one problem; the places where constraints are posed are parameters."""

    def __init__(self, problem: Problem, family: Family, near: Array, bounded: set[int]) -> None:
        """Build the program.

        Parameters
        ----------
        problem : Problem
            Waypoints and limits.
        family : Family
            The spline family.
        near : Array, shape (n_segments,) [s]
            Durations with the knot pattern that the program is built for.
        bounded : set of int
            Joints whose position limits are posed.
        """
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
        scales = duration_scales(problem)
        nlp = {
            "x": y,
            "p": casadi.vertcat(*self.places),
            "f": casadi.sum1(t) / float(scales.sum()),
            "g": casadi.vertcat(*self.rows),
        }
        options = dict(_IPOPT)
        if family.pattern(near):
            # for a B-spline, exact second derivatives cost more than the iterations they save
            options["ipopt.hessian_approximation"] = "limited-memory"
        self.solver = StoppableIpopt("family", nlp, options)
        self.floor = float(np.log(SHORTEST * scales.sum()))

    def _pose(self, j: int, k: int, order: int, length: casadi.SX, c: list[casadi.SX]) -> None:
        """Pose one derivative of one joint on one piece: its value over its limit, in [-1, 1]."""
        problem = self.problem
        last = len(self.degrees) - 1
        if order == 0:
            # at a waypoint the position is given: nothing to pose there
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
            self._pose_departure(j, k, c)
        value = _derivative(c, order)
        for which in [*ends, *range(len(value) - 2)]:
            s, follow = casadi.SX.sym("s"), casadi.SX.sym("follow")
            place = s
            if which >= 0:
                slope, bend = _derivative(value, 1), _derivative(value, 2)
                curvature = casadi.if_else(follow > 0, _at(bend, s), 1.0)
                # an extreme that has left the piece: the end of the piece takes its place
                step = s - follow * _at(slope, s) / curvature
                place = casadi.fmin(casadi.fmax(step, 0.0), 1.0)
            self.rows.append((_at(value, place) / length**order - origin) / scale)
            self.places.append(casadi.vertcat(s, follow))
            self.lower.append(low)
            self.upper.append(high)
            self.posed.append((j, k, order, which))

    def _pose_departure(self, j: int, k: int, c: list[casadi.SX]) -> None:
        """Make a joint that rests on its position limit leave it, or come to it, on the inner side.

        Velocity and acceleration vanish at rest, so the sign of the jerk decides. No inner extreme of
        the position would reveal a departure to the wrong side.
        """
        jerk = _derivative(c, 3)
        at_start = k == 0
        x = float(self.problem.waypoints[0 if at_start else -1, j])
        bounds = self.problem.position_bounds[j]
        for bound, inward in zip(bounds, (1.0, -1.0), strict=True):
            if touches(x, bound):
                sign = inward if at_start else -inward
                self.rows.append(sign * _at(jerk, casadi.SX(0.0 if at_start else 1.0)))
                self.places.append(casadi.SX.sym("unused", 2))
                self.lower.append(0.0)
                self.upper.append(float("inf"))
                self.posed.append((j, k, 3, -2 if at_start else -1))

    def solve(
        self, centre: Array, radius: float, follow: bool, deadline: Deadline = NEVER
    ) -> tuple[Array, str]:
        """Solve the program within a trust region about an iterate.

        Parameters
        ----------
        centre : Array, shape (n_segments,) [s]
            Positive durations; the constraints are posed at the extremes of their spline.
        radius : float
            Radius of the trust region in log T; ``NO_RADIUS`` for none.
        follow : bool
            Whether the posed places follow their extremes.
        deadline : Deadline
            IPOPT stops after the iteration in which it is over.

        Returns
        -------
        durations : Array, shape (n_segments,) [s]
            The local optimum, NaN if the solver refused the program.
        outcome : str
            IPOPT's return status, or why there was no solve.
        """
        spline = self.family.coefficients(self.problem, centre[None])[0]
        if not np.abs(spline).max() < _LARGEST:
            return np.full_like(centre, np.nan), "the spline leaves the range of floats"
        y = np.log(centre)
        upper = np.minimum(y + radius, np.log(centre.sum() * 10.0))
        # the trust region comes first: from far below the floor a duration rises by the radius only
        lower = np.minimum(np.maximum(y - radius, self.floor), upper)
        try:
            solved = self.solver.solve(
                deadline,
                x0=y,
                p=self._extremes(spline, follow),
                lbg=self.lower,
                ubg=self.upper,
                lbx=lower,
                ubx=upper,
            )
        except (RuntimeError, np.linalg.LinAlgError) as error:  # CasADi's one exception; no roots
            return np.full_like(centre, np.nan), str(error).strip().splitlines()[-1]
        if solved is None:
            return centre, "stopped at the deadline"
        answer, stats = solved
        return np.exp(np.asarray(answer["x"]).ravel()), str(stats["return_status"])

    def _extremes(self, spline: Array, follow: bool) -> Array:
        """Where the constraints are posed: normalised time, and 1 if the place follows its extreme."""
        found: dict[tuple[int, int], Array] = {}
        for order in {order for _, _, order, which in self.posed if which >= 0}:
            for degree in {*self.degrees}:
                pieces = [k for k, own in enumerate(self.degrees) if own == degree]
                values = differentiated(spline[pieces, :, : degree + 1], order)
                inner = _inner_extremes(values.reshape(-1, values.shape[-1]))
                found |= {
                    (k, order): each
                    for k, each in zip(pieces, np.split(inner, len(pieces)), strict=True)
                }
        places = np.zeros((len(self.posed), 2))
        for row, (j, k, order, which) in enumerate(self.posed):
            places[row] = found[k, order][j, which] if which >= 0 else (which + 2.0, 0.0)
        places[:, 1] *= follow
        return places.ravel()


def touches(x: float, bound: float) -> bool:
    """Whether a position equals a limit within rounding.

    Parameters
    ----------
    x, bound : float [rad]
        The position and the limit.

    Returns
    -------
    bool
        Whether they agree to 1e-9.
    """
    return abs(x - bound) <= 1e-9 * (1.0 + abs(x))


def _inner_extremes(values: Array) -> Array:
    """Inner extremes in (0, 1) of polynomials (m, degree + 1), with evenly spread places to fill up.

    Returns (m, degree - 1, 2): the place, and 1 if it is a true extreme that can be followed.
    """
    slopes = differentiated(values, 1)
    count = slopes.shape[1] - 1
    size = np.abs(slopes).max(axis=1, keepdims=True)
    significant = np.abs(slopes) > 1e-14 * size
    degrees = np.where(significant.any(axis=1), count - significant[:, ::-1].argmax(axis=1), 0)
    inner = np.full((len(slopes), count), np.inf)
    for degree in np.unique(degrees[degrees > 0]):
        mine = np.flatnonzero(degrees == degree)
        roots = roots_of(slopes[mine, : degree + 1])
        inside = (np.abs(roots.imag) < 1e-9) & (roots.real > 0.0) & (roots.real < 1.0)
        inner[mine, :degree] = np.sort(np.where(inside, roots.real, np.inf))
    there = np.isfinite(inner)
    spread = (np.arange(count) + 1.0) / (count + 1.0)
    # at an inflection there is no curvature for the Newton step
    bends = evaluated(differentiated(slopes, 1), np.where(there, inner, 0.0))
    follow = there & (np.abs(bends) > 1e-6 * size)
    return np.stack([np.where(there, inner, spread), follow], axis=-1)


def _at(polynomial: list[casadi.SX], s: casadi.SX) -> casadi.SX:
    """Value of a polynomial (ascending coefficients) by Horner's rule."""
    value = casadi.SX(0)
    for c in reversed(polynomial):
        value = value * s + c
    return value


def _derivative(polynomial: list[casadi.SX], order: int) -> list[casadi.SX]:
    """Ascending coefficients of a derivative."""
    for _ in range(order):
        polynomial = [i * c for i, c in enumerate(polynomial)][1:]
    return polynomial
