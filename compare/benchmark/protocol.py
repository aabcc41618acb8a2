"""The rules of a comparison: tracks, coordinates, budgets, targets, and the sizes of a run."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from formulations import InputError
from metaheuristics import ALGORITHMS


class Track(StrEnum):
    """Which rules a run follows.

    Attributes
    ----------
    equal
        Equal totals of evaluations in every coding; constants as published.
    paper
        The papers' own protocol: in the published coding each joint has the whole budget.
    tuned
        Equal totals; constants tuned on the open instances, with the same effort for each swarm.
    """

    equal = "equal"
    paper = "paper"
    tuned = "tuned"


class Coordinates(StrEnum):
    """In which coordinates a swarm sees the durations. Rows hold the durations themselves.

    Attributes
    ----------
    printed
        As the papers have them: durations, with zero just below the box.
    mirrored
        Counted from the other end of the box: what was short is long.
    offset
        The same box, far away from zero.
    """

    printed = "printed"
    mirrored = "mirrored"
    offset = "offset"


@dataclass(frozen=True)
class Budget:
    """Size of a search: its population, and how many iterations follow the first population."""

    population: int
    iterations: int

    @property
    def evaluations(self) -> int:
        """Number of evaluations; those of the first population count too."""
        return self.population * (self.iterations + 1)


# Wang 2025, Table 7; Li 2022, sec. 3; Zhou 2025, sec. 5.2; Zhang 2025, sec. 3.2; Lu 2024, sec. 3.2
PAPER_BUDGETS: dict[str, Budget] = {
    "sr4c": Budget(50, 50),
    "bagging": Budget(20, 200),
    "ur5": Budget(1000, 50),
    "ur5-corrected": Budget(1000, 50),
    "cobot": Budget(20, 200),
    "z1": Budget(30, 500),
}
# that of Wang 2025, the least of them: all instances of a suite have it, so that its targets compare
DEFAULT_BUDGET = Budget(50, 50)
QUICK_BUDGET = Budget(20, 20)
BUDGET_FACTORS = (1, 10, 100)

SEEDS = {"default": 5, "quick": 2, "full": 31, "suite": 5}

TARGETS: tuple[float, ...] = tuple(float(f"{10.0**e:.4e}") for e in np.linspace(1.0, -7.0, 41))
"""Targets of a fixed-target analysis: gaps to the certified optimum [1], the easiest first."""

# unless swarms are named, those of the papers and a few controls run; rival libraries only on demand
QUICK_SWARMS = [
    "pso", "mipso", "mpso", "pso-zhang-2025", "sparrow", "issa", "whale", "whale-lu-2024", "random", "de",
]  # fmt: skip
DEFAULT_CONTROLS = ["random", "de", "cma-es"]
FULL_CONTROLS = ["random", "sobol", "de", "cma-es", "annealing", "nelder-mead", "slsqp"]
RIVALS = ["lshade", "mealpy:OriginalPSO", "mealpy:OriginalWOA", "pymoo:PSO", "nevergrad:NGOpt"]


def swarms_of(size: str) -> list[str]:
    """Return the names of the swarms of a run of this size.

    Parameters
    ----------
    size : str
        ``default``, ``quick``, ``full`` or ``suite``.

    Returns
    -------
    list of str
    """
    if size == "quick":
        return QUICK_SWARMS
    papers = [name for name, entry in ALGORITHMS.items() if entry.group != "controls"]
    return papers + (FULL_CONTROLS if size in ("full", "suite") else DEFAULT_CONTROLS)


def shares(budget: int, searches: int) -> list[int]:
    """Divide the evaluations of a whole motion among the searches of its joints.

    Parameters
    ----------
    budget : int
        Evaluations over the whole motion.
    searches : int
        Number of searches: one for each joint that moves, or one for all joints.

    Returns
    -------
    list of int
        They add up to the budget and differ by one at most; the first searches have the larger share.

    Raises
    ------
    InputError
        If a search would have none.
    """
    if budget < searches:
        raise InputError(
            f"budget: {budget} evaluations are fewer than {searches}, one for each joint that moves"
        )
    each, more = divmod(budget, searches) if searches else (0, 0)
    return [each + (k < more) for k in range(searches)]


def variant(coding: str, track: Track, coordinates: Coordinates) -> str:
    """Name a coding with what is not usual about it: ``stretched``, ``published (paper)``.

    Rows of two variants never enter one statistic.

    Parameters
    ----------
    coding : str
    track : Track
        Not said where it is ``equal``.
    coordinates : Coordinates
        Not said where they are ``printed``.

    Returns
    -------
    str
    """
    usual = (Track.equal, Coordinates.printed)
    unusual = [str(word) for word in (track, coordinates) if word not in usual]
    return f"{coding} ({', '.join(unusual)})" if unusual else coding


def targets(proved: float) -> tuple[float, ...]:
    """Return the targets that a proof can tell from the optimum.

    Parameters
    ----------
    proved : float
        Relative gap between the certified bound and the verified optimum [1].

    Returns
    -------
    tuple of float
        Those of ``TARGETS`` that are no smaller.
    """
    return tuple(target for target in TARGETS if target >= proved)
