"""What a spline family is: a rule that turns durations into a C2 spline through the waypoints."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from formulations.compiled import Late
from formulations.families import polynomial
from formulations.families.polynomial import WIDTH
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, UnsupportedProblem
from formulations.problem.problem import Problem

_BLOCK = 256  # candidates whose coefficients fit the processor's cache


@dataclass(frozen=True)
class Family:
    """One spline family. Its formula stands once, in its file; all else follows from it.

    population(waypoints, durations, lengths, out): the splines of whole populations, compiled:
    (n+1, dof), (m, n) -> lengths of the polynomial pieces (m, n_pieces) [s] and their coefficients on
    normalised time, out (m, n_pieces, dof, 6), zeroed before.
    symbols(waypoints, t, near): the same lines run on symbols t; near: the numeric durations whose
    pattern of knots holds. Returns lengths per piece, and coefficients per joint and piece.
    degrees(n_segments): polynomial degree of each piece. refusal(n_segments): why not, or None.
    pattern(durations): what changes the formula's course; equal patterns, equal symbols.
    """

    name: str
    title: str
    source: str
    population: Callable[[Any, Any, Any, Any], None]
    symbols: Callable[[Array, list[Any], Array], tuple[list[Any], list[Any]]]
    degrees: Callable[[int], tuple[int, ...]]
    refusal: Callable[[int], str | None] = lambda n_segments: None
    pattern: Callable[[Array], tuple[int, ...]] = lambda durations: ()

    def require(self, problem: Problem) -> None:
        """Raises UnsupportedProblem with the reason if the family has no spline for the problem."""
        reason = self.refusal(problem.n_segments)
        if reason is not None:
            raise UnsupportedProblem(f"family: {reason}")

    def pieces(self, problem: Problem, durations: Array) -> tuple[Array, Array]:
        """The splines of a population: (n, n_segments) [s] -> lengths (n, n_pieces) [s], coefficients.

        Coefficients on normalised time, (n, n_pieces, dof, 6) [rad], ascending.
        """
        self.require(problem)
        durations = np.ascontiguousarray(durations, dtype=np.float64)
        if durations.ndim != 2 or durations.shape[1] != problem.n_segments:
            raise InputError(f"durations: expected (n, {problem.n_segments}), got {durations.shape}")
        good = (durations > 0.0) & (durations < np.inf)  # false for NaN
        if not good.all():
            raise InputError(f"durations: must be positive and finite, got {durations[~good][0]:g}")
        n_pieces = len(self.degrees(problem.n_segments))
        lengths = np.zeros((len(durations), n_pieces))
        out = np.zeros((len(durations), n_pieces, problem.dof, WIDTH))
        fill = self._one if len(durations) == 1 else self.population
        fill(problem.waypoints, durations, lengths, out)
        return lengths, out

    @cached_property
    def _one(self) -> Late:
        """``population`` for a single candidate: not worth the compiler's time."""
        return Late(self.population)

    def _blocks(self, problem: Problem, durations: Array) -> Iterator[tuple[slice, Array, Array]]:
        if not len(durations):
            self.pieces(problem, durations)  # refuses wrong shapes
        for start in range(0, len(durations), _BLOCK):
            rows = slice(start, start + _BLOCK)
            yield rows, *self.pieces(problem, durations[rows])

    def coefficients(self, problem: Problem, durations: Array) -> Array:
        """Coefficients on normalised time alone, (n, n_pieces, dof, 6) [rad]."""
        return self.pieces(problem, durations)[1]

    def degrees_of(self, problem: Problem) -> Array:
        """Polynomial degree of each piece, (n_pieces,) integers."""
        return np.array(self.degrees(problem.n_segments))

    def peaks(self, problem: Problem, durations: Array) -> Array:
        """Exact peaks of |velocity|, |acceleration|, |jerk| per joint: (n, n_segments) [s] ->
        (n, dof, 3) [rad/s, rad/s^2, rad/s^3].
        """
        durations = np.asarray(durations, dtype=np.float64)
        out = np.empty((len(durations), problem.dof, 3))
        degrees = self.degrees_of(problem)
        for rows, lengths, coefficients in self._blocks(problem, durations):
            polynomial.peaks(coefficients, degrees, lengths, out[rows])
        return out

    def stretch(self, problem: Problem, durations: Array) -> Array:
        """Least factor on all durations that keeps the derivative limits: (n, n_segments) -> (n,).

        At most 1 exactly where the candidate is feasible, position limits apart.
        """
        durations = np.asarray(durations, dtype=np.float64)
        out = np.empty(len(durations))
        degrees, limits = self.degrees_of(problem), problem.limits.derivatives
        for rows, lengths, coefficients in self._blocks(problem, durations):
            polynomial.stretch(coefficients, degrees, lengths, limits, out[rows])
        return out

    def position_excess(self, problem: Problem, durations: Array) -> Array:
        """How far the position limits are left [rad]: (n, n_segments) -> (n,), 0 if kept.

        It depends on the shape alone; no stretch mends it.
        """
        durations = np.asarray(durations, dtype=np.float64)
        out = np.zeros(len(durations))
        degrees, bounds = self.degrees_of(problem), problem.position_bounds
        for rows, _, coefficients in self._blocks(problem, durations):
            if problem.limits.has_position:
                polynomial.position_excess(coefficients, degrees, bounds, out[rows])
        return out

    def trajectory(self, problem: Problem, durations: Any) -> Trajectory:
        """The spline for one vector of durations (n_segments,) [s]."""
        t = np.asarray(durations, dtype=np.float64)
        lengths, normalised = (part[0] for part in self.pieces(problem, t[None]))
        powers = lengths[:, None, None] ** np.arange(WIDTH)
        passages = np.concatenate([[0.0], np.cumsum(t)])
        # the last break and the last passage are the same instant, however their sums round
        passages[-1] = lengths.cumsum()[-1]
        return Trajectory(lengths, normalised / powers, passages)


def scratch(*shape: int) -> Any:
    """Zeroed arrays that hold symbols, to run compiled formulas on as plain Python."""
    cells = np.empty(shape, dtype=object)
    cells.fill(0.0)
    return cells


def on_symbols(
    joint: Any, *, work: int = 0
) -> Callable[[Array, list[Any], Array], tuple[list[Any], list[Any]]]:
    """``symbols`` of a family with one piece per segment and a compiled joint(x, t, c[, work])."""

    def symbols(waypoints: Array, t: list[Any], near: Array) -> tuple[list[Any], list[Any]]:
        joints = []
        for x in waypoints.T.tolist():
            c = scratch(len(t), WIDTH)
            joint.py_func(x, t, c, *([scratch(work, len(t))] if work else []))
            joints.append([list(row) for row in c])
        return t, joints

    return symbols
