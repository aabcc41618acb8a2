"""Codings: how a swarm's vector becomes a motion, and what the swarm is told about it.

published   each joint alone, with durations of its own; infeasible = worst fitness; at the end the
            longest time per segment over the joints (Wang 2025, Li 2022, Zhou 2025)
shared      one vector of durations for all joints; infeasible = worst fitness
stretched   one vector of durations for all joints; every shape is first stretched, exactly, until it is
            feasible
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from formulations import FAMILIES, Problem
from formulations.families.population_times import PopulationTimes
from formulations.problem.arrays import Array

CODINGS: dict[str, str] = {
    "published": "each joint alone, infeasible = worst fitness, longest time per segment",
    "shared": "durations shared by all joints, infeasible = worst fitness",
    "stretched": "durations shared by all joints, stretched exactly to feasibility",
}

_SHORTEST, _LONGEST = 1e-3, 3.0  # times the shortest feasible duration of equally long segments


def search_box(problem: Problem, seconds: tuple[float, float] | None = None) -> tuple[Array, Array]:
    """Return the least and the greatest duration of each segment that a swarm may try.

    Both are multiples of the shortest feasible duration of equally long segments: 0.001 and 3 times.
    The papers start from equally long segments (2 s each in Wang 2025 and Li 2022, 4 s in Zhou 2025).
    Only Lu 2024 prints a box: 0 to 5 s for segments of about 1.7 s.

    Parameters
    ----------
    problem : Problem
    seconds : tuple of float, optional [s]
        Least and greatest duration of every segment, in place of these multiples.

    Returns
    -------
    lo, hi : Array, shape (n_segments,) [s]
    """
    n = problem.n_segments
    if seconds is not None:
        return np.full(n, seconds[0]), np.full(n, seconds[1])
    unit = float(FAMILIES[problem.family].stretch(problem, np.ones((1, n)))[0])
    return np.full(n, _SHORTEST * unit), np.full(n, _LONGEST * unit)


@dataclass(frozen=True)
class Objective:
    """Total time of whole populations: (n, n_segments) [s] -> (n,) [s], infinite if infeasible.

    Parameters
    ----------
    problem : Problem
    stretch : bool
        False: the time of the candidate as it is, infeasible if it breaks any limit. True: its time
        once it is stretched until it keeps the velocity, acceleration and jerk limits; only a shape
        that leaves the position limits is infeasible, as no stretch changes the shape.
    """

    problem: Problem
    stretch: bool

    def __post_init__(self) -> None:
        self.problem.require_plain("the objective of a swarm")

    def __call__(self, durations: Array) -> Array:
        """Return the fitness of a population.

        Parameters
        ----------
        durations : Array, shape (n, n_segments) [s]

        Returns
        -------
        Array, shape (n,) [s]
        """
        return self._times(durations)

    def __reduce__(self) -> tuple[Any, ...]:
        return Objective, (self.problem, self.stretch)  # without the buffers of a process

    @cached_property
    def _times(self) -> PopulationTimes:
        return PopulationTimes(FAMILIES[self.problem.family], self.problem, stretched=self.stretch)

    def durations(self, x: Array) -> Array:
        """Return the durations that a swarm's vector stands for.

        Parameters
        ----------
        x : Array, shape (n_segments,)
            The vector.

        Returns
        -------
        Array, shape (n_segments,) [s]
        """
        if not self.stretch:
            return x
        factor = FAMILIES[self.problem.family].stretch(self.problem, x[None])[0]
        return np.asarray(x * factor)
