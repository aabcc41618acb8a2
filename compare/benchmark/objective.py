"""Codings: how a swarm's vector becomes a motion, and what the swarm is told about it.

published   each joint alone, durations of its own; infeasible = worst fitness; in the end the
            longest time per segment over the joints (000, 001, 002)
shared      one vector of durations for all joints; the same penalty
stretched   one vector of durations; every shape is stretched exactly to feasibility first
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations import FAMILIES, Problem
from formulations.problem.arrays import Array

CODINGS: dict[str, str] = {
    "published": "each joint alone, infeasible = worst fitness, longest time per segment",
    "shared": "durations shared by all joints, infeasible = worst fitness",
    "stretched": "durations shared by all joints, stretched exactly to feasibility",
}

_SHORTEST, _LONGEST = 1e-3, 3.0  # the box, in units of the shortest feasible equal duration


def search_box(problem: Problem) -> tuple[Array, Array]:
    """Least and greatest duration a swarm may try, each (n_segments,) [s].

    The unit is the shortest feasible duration if all segments take equally long, which is where the
    papers start from (2 s each in 000 and 001, 4 s in 002). The papers print no box but 003's
    (0 to 5 s for segments of about 1.7 s); the longest here is 3 units, the shortest 0.001.
    """
    n = problem.n_segments
    unit = float(FAMILIES[problem.family].stretch(problem, np.ones((1, n)))[0])
    return np.full(n, _SHORTEST * unit), np.full(n, _LONGEST * unit)


@dataclass(frozen=True)
class Objective:
    """Total time of whole populations: (n, n_segments) [s] -> (n,) [s], infinite if infeasible.

    stretch=False: the time as it stands, infeasible if any limit is broken. stretch=True: the time
    after the exact stretch; only position limits, which no stretch mends, make a shape infeasible.
    """

    problem: Problem
    stretch: bool

    def __call__(self, durations: Array) -> Array:
        """Fitness of a population."""
        family = FAMILIES[self.problem.family]
        total = np.asarray(durations.sum(axis=1))
        factor = family.stretch(self.problem, durations)
        if self.stretch:
            total *= factor
        else:
            total[factor > 1.0] = np.inf
        if self.problem.limits.has_position:
            excess = family.position_excess(self.problem, durations)
            total[excess > self.problem.position_slack] = np.inf
        return total

    def durations(self, x: Array) -> Array:
        """The durations a swarm's vector stands for, (n_segments,) [s]."""
        if not self.stretch:
            return x
        factor = FAMILIES[self.problem.family].stretch(self.problem, x[None])[0]
        return np.asarray(x * factor)
