"""Which runs a grading consists of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from compare.benchmark.grade import Run
from compare.benchmark.protocol import DEFAULT_BUDGET, Coordinates, Track
from formulations import Problem

SEEDS = 31
"""With 36 instances, two equal swarms are called equal 998 times in 1000 (tests/compare/statistics)."""
CONTROLS = ("cma-es", "de", "random")
"""Between these a swarm stands: the best known here, a common one, and no search at all."""
CONTROL_SEEDS = 11
"""How many seeds the others run; the standing counts so many of every swarm."""
ZERO_INSTANCES, ZERO_SEEDS = 12, 11
"""How many of the instances and seeds are run in moved coordinates too."""
CODINGS = ("stretched", "shared")
"""Codings in which one vector holds the durations of all joints."""


@dataclass(frozen=True)
class GradingProtocol:
    """What is run.

    Attributes
    ----------
    swarm, against : str
        The swarm that is graded, and the one that it is compared with.
    others : tuple of str
        Further swarms of the standing.
    seeds, control_seeds : int
        Number of seeds, from 0: of the two swarms, and of the others at most.
    budget : int
        Evaluations of each run.
    zero_instances, zero_seeds : int
        How many of them are run in moved coordinates, by the graded swarm alone; 0: none.
    """

    swarm: str
    against: str
    others: tuple[str, ...] = CONTROLS
    coding: str = "stretched"
    seeds: int = SEEDS
    control_seeds: int = CONTROL_SEEDS
    budget: int = DEFAULT_BUDGET.evaluations
    population: int = DEFAULT_BUDGET.population
    zero_instances: int = ZERO_INSTANCES
    zero_seeds: int = ZERO_SEEDS

    @property
    def swarms(self) -> tuple[str, ...]:
        """All swarms, each once: the graded one first."""
        return tuple(dict.fromkeys([self.swarm, self.against, *self.others]))

    @property
    def even_seeds(self) -> int:
        """Number of seeds that every swarm has: those of the standing."""
        return min(self.seeds, self.control_seeds) if len(self.swarms) > 2 else self.seeds

    def zero_cases(self, problems: Mapping[str, Problem]) -> list[str]:
        """Names of the instances that are run in moved coordinates, spread over all of them.

        Parameters
        ----------
        problems : mapping of str to Problem

        Returns
        -------
        list of str
        """
        names = list(problems)
        count = min(self.zero_instances, len(names))
        return [names[k * len(names) // count] for k in range(count)]

    def runs(self, problems: Mapping[str, Problem]) -> list[Run]:
        """List the runs, instance by instance, so that failures and numbers come early.

        Parameters
        ----------
        problems : mapping of str to Problem
            By instance.

        Returns
        -------
        list of Run
        """
        moved = set(self.zero_cases(problems))
        listed = []
        for case in problems:
            listed += [
                self._run(case, swarm, seed, Coordinates.printed)
                for swarm in self.swarms
                for seed in range(
                    self.seeds if swarm in (self.swarm, self.against) else self.even_seeds
                )
            ]
            if case in moved:
                listed += [
                    self._run(case, self.swarm, seed, seen)
                    for seen in (Coordinates.offset, Coordinates.mirrored)
                    for seed in range(min(self.zero_seeds, self.seeds))
                ]
        return listed

    def _run(self, case: str, swarm: str, seed: int, seen: Coordinates) -> Run:
        return Run(
            case, self.coding, swarm, seed, self.budget, self.population,
            track=Track.equal, coordinates=seen,
        )  # fmt: skip
