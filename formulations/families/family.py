"""What a spline family is: a rule that turns durations into a C2 spline through the waypoints."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from formulations.compiled import Late
from formulations.families import polynomial, position
from formulations.families.polynomial import WIDTH
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError, UnsupportedProblem
from formulations.problem.problem import Problem

BLOCK = 256  # candidates whose coefficients fit the processor's cache


@dataclass(frozen=True)
class Family:
    """One spline family: its formula stands once, in its file, and all else follows from it.

    Attributes
    ----------
    name, title, source : str
        Key in ``FAMILIES``, name for people, and the paper it comes from.
    population : callable
        ``population(waypoints, durations, lengths, out)``, compiled: from waypoints (n + 1, dof) [rad] and
        durations (m, n) [s] it fills the lengths of the polynomial pieces (m, n_pieces) [s] and their
        coefficients on normalised time, out (m, n_pieces, dof, 6) [rad], which is zero before, or holds what
        an earlier call filled.
    symbols : callable
        ``symbols(waypoints, t, near)``: runs the same lines on CasADi symbols t. ``near`` are numeric
        durations that have the pattern wanted. Returns the length of each piece, and the coefficients by
        joint and piece.
    degrees : callable
        ``degrees(n_segments)``: the polynomial degree of each piece.
    refusal : callable
        ``refusal(n_segments)``: why the family has no spline for so many segments, None if it has one.
    pattern : callable
        ``pattern(durations)``: integers that tell which course the formula takes. Durations of equal
        patterns share their symbols. For a B-spline it says which knot span each waypoint lies in.

    Examples
    --------
    >>> import formulations as f
    >>> import numpy as np
    >>> family, problem = f.FAMILIES["3-5-3"], f.load("sr4c")
    >>> durations = np.array([[2.0, 1.0, 2.0], [2.0, 2.0, 2.0]])  # two candidates
    >>> family.stretch(problem, durations).round(3).tolist()
    [2.007, 0.857]
    >>> family.trajectory(problem, durations[0]).seconds
    5.0
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
        """Refuse a problem for which the family has no spline.

        Parameters
        ----------
        problem : Problem
            Its number of segments decides, and whether it has conditions: splines know none.

        Raises
        ------
        UnsupportedProblem
            With the reason.
        """
        reason = self.refusal(problem.n_segments)
        if reason is not None:
            raise UnsupportedProblem(f"family: {reason}")
        problem.require_plain(f"family {self.name}")

    def pieces(self, problem: Problem, durations: Array) -> tuple[Array, Array]:
        """Compute the splines of a population.

        Parameters
        ----------
        problem : Problem
            Its waypoints and limits; the family does not matter.
        durations : Array, shape (n, n_segments)
            One candidate per row [s].

        Returns
        -------
        lengths : Array, shape (n, n_pieces)
            Lengths of the polynomial pieces [s].
        coefficients : Array, shape (n, n_pieces, dof, 6)
            Ascending, on normalised time [rad].

        Raises
        ------
        UnsupportedProblem
            If the family has no spline for the problem.
        InputError
            For durations of another shape, or that are not positive and finite.
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
        """``population`` for a single candidate, which seldom is worth compiling."""
        return Late(self.population)

    def _blocks(self, problem: Problem, durations: Array) -> Iterator[tuple[slice, Array, Array]]:
        if not len(durations):
            self.pieces(problem, durations)  # refuses wrong shapes
        for start in range(0, len(durations), BLOCK):
            rows = slice(start, start + BLOCK)
            yield rows, *self.pieces(problem, durations[rows])

    def coefficients(self, problem: Problem, durations: Array) -> Array:
        """Compute the coefficients alone.

        Parameters
        ----------
        problem : Problem
            Its waypoints and limits; the family does not matter.
        durations : Array, shape (n, n_segments)
            One candidate per row [s].

        Returns
        -------
        Array, shape (n, n_pieces, dof, 6)
            Ascending, on normalised time [rad].
        """
        return self.pieces(problem, durations)[1]

    def degrees_of(self, problem: Problem) -> Array:
        """Return the polynomial degree of each piece.

        Parameters
        ----------
        problem : Problem
            Its number of segments decides.

        Returns
        -------
        Array of int, shape (n_pieces,)
        """
        return np.array(self.degrees(problem.n_segments))

    def peaks(self, problem: Problem, durations: Array) -> Array:
        """Compute the exact peaks of |velocity|, |acceleration| and |jerk|.

        Parameters
        ----------
        problem : Problem
            Its waypoints and limits; the family does not matter.
        durations : Array, shape (n, n_segments)
            One candidate per row [s].

        Returns
        -------
        Array, shape (n, dof, 3)
            Peaks of each joint [rad/s, rad/s^2, rad/s^3].
        """
        durations = np.asarray(durations, dtype=np.float64)
        out = np.empty((len(durations), problem.dof, 3))
        degrees = self.degrees_of(problem)
        for rows, lengths, coefficients in self._blocks(problem, durations):
            polynomial.peaks(coefficients, degrees, lengths, out[rows])
        return out

    def stretch(self, problem: Problem, durations: Array) -> Array:
        """Compute the least factor on all durations that keeps the derivative limits.

        A candidate keeps them if its factor is at most 1. Position limits are not looked at: no stretch
        changes the path.

        Parameters
        ----------
        problem : Problem
            Its waypoints and limits; the family does not matter.
        durations : Array, shape (n, n_segments)
            One candidate per row [s].

        Returns
        -------
        Array, shape (n,)
        """
        durations = np.asarray(durations, dtype=np.float64)
        out = np.empty(len(durations))
        degrees, limits = self.degrees_of(problem), problem.limits.derivatives
        for rows, lengths, coefficients in self._blocks(problem, durations):
            polynomial.stretch(coefficients, degrees, lengths, limits, out[rows])
        return out

    def position_excess(self, problem: Problem, durations: Array) -> Array:
        """Compute how far each candidate leaves the position limits.

        It depends on the ratios of the durations alone: no stretch changes it.

        Parameters
        ----------
        problem : Problem
            Its waypoints and limits; the family does not matter.
        durations : Array, shape (n, n_segments)
            One candidate per row [s].

        Returns
        -------
        Array, shape (n,)
            Largest excess [rad], 0 if the limits are kept.
        """
        durations = np.asarray(durations, dtype=np.float64)
        out = np.zeros(len(durations))
        degrees, bounds = self.degrees_of(problem), problem.position_bounds
        for rows, _, coefficients in self._blocks(problem, durations):
            if problem.limits.has_position:
                position.position_excess(coefficients, degrees, bounds, out[rows])
        return out

    def trajectory(self, problem: Problem, durations: Any) -> Trajectory:
        """Compute the spline of one candidate.

        Parameters
        ----------
        problem : Problem
            Its waypoints and limits; the family does not matter.
        durations : array_like, shape (n_segments,)
            Durations of the segments [s].

        Returns
        -------
        Trajectory
            Passes the waypoints; whether it keeps the limits is for ``check`` to say.
        """
        t = np.asarray(durations, dtype=np.float64)
        lengths, normalised = (part[0] for part in self.pieces(problem, t[None]))
        powers = lengths[:, None, None] ** np.arange(WIDTH)
        passages = np.concatenate([[0.0], np.cumsum(t)])
        # the last break and the last passage are the same instant, however their sums round
        passages[-1] = lengths.cumsum()[-1]
        return Trajectory(lengths, normalised / powers, passages)


def scratch(*shape: int) -> Any:
    """Make a zeroed array that can hold symbols, so that a compiled formula runs on it as plain Python.

    Parameters
    ----------
    *shape : int
        Its shape.

    Returns
    -------
    array of object
    """
    cells = np.empty(shape, dtype=object)
    cells.fill(0.0)
    return cells


def on_symbols(
    joint: Any, *, work: int = 0
) -> Callable[[Array, list[Any], Array], tuple[list[Any], list[Any]]]:
    """Make ``symbols`` of a family that has one piece per segment.

    Parameters
    ----------
    joint : callable
        The compiled ``joint(x, t, c)``, or ``joint(x, t, c, work)``.
    work : int
        Rows of scratch that it needs, each as long as t.

    Returns
    -------
    callable
        As ``Family.symbols``.
    """

    def symbols(waypoints: Array, t: list[Any], near: Array) -> tuple[list[Any], list[Any]]:
        joints = []
        for x in waypoints.T.tolist():
            c = scratch(len(t), WIDTH)
            joint.py_func(x, t, c, *([scratch(work, len(t))] if work else []))
            joints.append([list(row) for row in c])
        return t, joints

    return symbols
