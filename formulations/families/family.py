"""What a spline family is: a rule that turns durations into a C2 spline through the waypoints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from formulations.errors import InputError, UnsupportedProblem
from formulations.families import polynomial
from formulations.problem import Array, Problem
from formulations.trajectory import Trajectory

_BLOCK = 256  # candidates whose coefficients fit the processor's cache


@dataclass(frozen=True)
class Family:
    """One spline family. The formula stands once, in ``joint``; all else follows from it.

    joint(x, t, c, work): coefficients of one joint on normalised time from waypoints and durations,
    compiled, and plain enough to run on CasADi symbols (``joint.py_func``).
    population(waypoints, durations, out): the same for whole populations, compiled.
    degrees(n_segments): polynomial degree of each piece. refusal(n_segments): why not, or None.
    """

    name: str
    title: str
    source: str
    joint: Callable[..., None]
    population: Callable[..., None]
    degrees: Callable[[int], tuple[int, ...]]
    refusal: Callable[[int], str | None]

    def require(self, problem: Problem) -> None:
        """Raises UnsupportedProblem with the reason if the family has no spline for the problem."""
        reason = self.refusal(problem.n_segments)
        if reason is not None:
            raise UnsupportedProblem(f"family: {reason}")

    def coefficients(self, problem: Problem, durations: Array) -> Array:
        """Coefficients on normalised time of a population: (n, n_segments) [s] ->
        (n, n_segments, dof, 6) [rad], ascending.
        """
        self.require(problem)
        durations = np.ascontiguousarray(durations, dtype=np.float64)
        if durations.ndim != 2 or durations.shape[1] != problem.n_segments:
            raise InputError(f"durations: expected (n, {problem.n_segments}), got {durations.shape}")
        good = (durations > 0.0) & (durations < np.inf)  # false for NaN
        if not good.all():
            raise InputError(f"durations: must be positive and finite, got {durations[~good][0]:g}")
        out = polynomial.empty_coefficients(len(durations), problem.n_segments, problem.dof)
        self.population(problem.waypoints, durations, out)
        return out

    def degrees_of(self, problem: Problem) -> Array:
        """Polynomial degree of each piece, (n_segments,) integers."""
        return np.array(self.degrees(problem.n_segments))

    def peaks(self, problem: Problem, durations: Array) -> Array:
        """Exact peaks of |velocity|, |acceleration|, |jerk| per joint: (n, n_segments) [s] ->
        (n, dof, 3) [rad/s, rad/s^2, rad/s^3].
        """
        out = np.empty((len(durations), problem.dof, 3))
        coefficients = self.coefficients(problem, durations)
        polynomial.peaks(coefficients, self.degrees_of(problem), durations, out)
        return out

    def stretch(self, problem: Problem, durations: Array) -> Array:
        """Least factor on all durations that keeps the derivative limits: (n, n_segments) -> (n,).

        At most 1 exactly where the candidate is feasible, position limits apart.
        """
        durations = np.asarray(durations, dtype=np.float64)
        out = np.empty(len(durations))
        degrees, limits = self.degrees_of(problem), problem.limits.derivatives
        for start in range(0, len(durations), _BLOCK):
            rows = slice(start, start + _BLOCK)
            coefficients = self.coefficients(problem, durations[rows])
            polynomial.stretch(coefficients, degrees, durations[rows], limits, out[rows])
        return out

    def position_excess(self, problem: Problem, durations: Array) -> Array:
        """How far the position limits are left [rad]: (n, n_segments) -> (n,), 0 if kept.

        It depends on the shape alone; no stretch mends it.
        """
        coefficients = self.coefficients(problem, durations)
        out = np.zeros(len(coefficients))
        if problem.limits.has_position:
            polynomial.position_excess(
                coefficients, self.degrees_of(problem), problem.position_bounds, out
            )
        return out

    def trajectory(self, problem: Problem, durations: Any) -> Trajectory:
        """The spline for one vector of durations (n_segments,) [s]."""
        t = np.asarray(durations, dtype=np.float64)
        normalised = self.coefficients(problem, t[None])[0]
        powers = t[:, None, None] ** np.arange(polynomial.WIDTH)
        return Trajectory(durations=t, coefficients=normalised / powers)
