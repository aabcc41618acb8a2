"""Times of whole populations: what a swarm is told of its candidates, computed by two compiled calls."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.families.family import BLOCK, Family
from formulations.families.polynomial import WIDTH, least_factor
from formulations.families.position import stays_inside
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem


class PopulationTimes:
    """Time of every candidate of a population, infinite if it is infeasible: (n, n_segments) -> (n,).

    A swarm asks for fifty candidates at a time. The arrays of the problem are therefore bound once, and the
    buffers of the coefficients are used again: an object serves one thread at a time.

    Parameters
    ----------
    family : Family
        The family of the splines.
    problem : Problem
        Its waypoints and limits; the family does not matter.
    stretched : bool
        False: the time of a candidate as it is; infeasible if it breaks any limit. True: its time once it
        is stretched until it keeps the velocity, acceleration and jerk limits; infeasible only if its
        shape leaves the position limits, because no stretch changes the shape.

    Raises
    ------
    UnsupportedProblem
        If the family has no spline for the problem.

    Examples
    --------
    >>> import formulations as f
    >>> problem = f.load("sr4c")
    >>> times = PopulationTimes(f.FAMILIES["3-5-3"], problem, stretched=True)
    >>> times(np.array([[2.0, 1.0, 2.0], [2.0, 2.0, 2.0]])).round(3).tolist()
    [10.035, 5.14]
    """

    def __init__(self, family: Family, problem: Problem, *, stretched: bool) -> None:
        family.require(problem)
        self._family, self._problem = family, problem
        degrees = family.degrees_of(problem)
        bounds = np.empty((0, 3))
        if problem.limits.has_position:
            slack = np.full(problem.dof, problem.position_slack)
            bounds = np.column_stack([problem.position_bounds, slack])
        self._judged_by = degrees, problem.limits.derivatives, bounds, stretched
        self._lengths = np.zeros((BLOCK, len(degrees)))
        self._coefficients = np.zeros((BLOCK, len(degrees), problem.dof, WIDTH))

    def __call__(self, durations: Array) -> Array:
        """Compute the times of a population.

        Parameters
        ----------
        durations : Array, shape (n, n_segments)
            One candidate per row [s].

        Returns
        -------
        Array, shape (n,)
            Times [s].

        Raises
        ------
        InputError
            For durations of another shape, or that are not positive and finite.
        """
        durations = np.ascontiguousarray(durations, dtype=np.float64)
        if durations.ndim != 2 or durations.shape[1] != self._problem.n_segments or not len(durations):
            return self._family.stretch(self._problem, durations)  # refuses wrong shapes
        out = np.empty(len(durations))
        for start in range(0, len(out), BLOCK):
            rows = durations[start : start + BLOCK]
            lengths, coefficients = self._lengths[: len(rows)], self._coefficients[: len(rows)]
            self._family.population(self._problem.waypoints, rows, lengths, coefficients)
            judged = _judge(rows, lengths, coefficients, *self._judged_by, out[start : start + BLOCK])
            if not judged:
                self._family.pieces(self._problem, rows)  # says which duration is bad
        return out


@compiled
def _judge(
    durations: Any,
    lengths: Any,
    coefficients: Any,
    degrees: Any,
    limits: Any,
    bounds: Any,
    stretched: bool,
    out: Any,
) -> bool:
    """Fill ``out`` with the times; return False if a duration is not positive and finite.

    ``bounds`` is that of ``position.stays_inside``, without rows if there are no position limits. The
    other arrays are those of ``polynomial.stretch``.
    """
    work = np.zeros((7, WIDTH))
    worst = 0
    for i in range(len(out)):
        total = 0.0
        for k in range(durations.shape[1]):
            if not 0.0 < durations[i, k] < inf:
                return False
            total += durations[i, k]
        factor, worst = least_factor(i, coefficients, degrees, lengths, limits, worst, work)
        if stretched:
            total *= factor
        elif factor > 1.0:
            total = inf
        if len(bounds) > 0 and not stays_inside(i, coefficients, degrees, bounds, work):
            total = inf
        out[i] = total
    return True
