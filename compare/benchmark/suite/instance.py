"""An instance of the benchmark: one problem as plain data, with a digest and with where it comes from."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from compare.benchmark.records.provenance import problem_digest
from formulations import InputError, Limits, Problem
from formulations.problem.arrays import Array


class Split(StrEnum):
    """What an instance may be used for.

    Attributes
    ----------
    open
        Constants may be tuned on it.
    held_out
        It is for grading alone.
    own
        It belongs to whoever runs the comparison.
    """

    open = "open"
    held_out = "held-out"
    own = "own"


@dataclass(frozen=True)
class Instance:
    """One problem of the benchmark.

    Attributes
    ----------
    name : str
        Name of its case in rows and tables.
    problem : Problem
    split : Split
    origin : str
        ``paper``, ``perturbed CASE``, ``drawn ARM``, or ``file``.
    source : str
        Where its numbers come from, and what was assumed.
    """

    name: str
    problem: Problem
    split: Split
    origin: str
    source: str

    @property
    def digest(self) -> str:
        """A short hash of waypoints, limits and family."""
        return problem_digest(self.problem)

    def to_json(self) -> dict[str, Any]:
        """Return plain numbers and text, from which `from_json` makes the same instance."""
        problem, limits = self.problem, self.problem.limits
        return {
            "name": self.name,
            "split": self.split.value,
            "origin": self.origin,
            "source": self.source,
            "digest": self.digest,
            "problem": {
                "family": problem.family,
                "title": problem.title,
                "display_unit": problem.display_unit,
                "names": list(problem.names),
                "units": list(problem.units),
                "waypoints": problem.waypoints.tolist(),
                "velocity": _finite(limits.velocity),
                "acceleration": _finite(limits.acceleration),
                "jerk": _finite(limits.jerk),
                "position": _finite(limits.position),
            },
        }

    @staticmethod
    def from_json(data: Any) -> Instance:
        """Make an instance of plain data.

        Parameters
        ----------
        data : object
            What `to_json` gave.

        Returns
        -------
        Instance

        Raises
        ------
        InputError
            If an entry is missing or does not fit, or the digest is that of another problem.
        """
        try:
            stated = data["problem"]
            units = tuple(stated["units"])
            limits = Limits(
                _infinite(stated["velocity"], 1),
                _infinite(stated["acceleration"], 1),
                _infinite(stated["jerk"], 1),
                _infinite(stated["position"], 2),
                units,
            )
            problem = Problem(
                stated["waypoints"],
                limits,
                name=data["name"],
                family=stated["family"],
                title=stated["title"],
                source=data["source"],
                display_unit=stated["display_unit"],
                names=stated["names"],
                units=units,
            )
            split = Split(data["split"])
            found = Instance(data["name"], problem, split, data["origin"], data["source"])
            digest = data["digest"]
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(f"instance: not one of this version of timebound: {error}") from None
        if found.digest != digest:
            raise InputError(f"instance {found.name}: its digest is {found.digest}, not {digest}")
        return found


def _finite(values: Array) -> list[Any]:
    """Numbers as lists, None where there is no limit: JSON has no infinity."""
    if values.ndim > 1:
        return [_finite(row) for row in values]
    return [float(v) if math.isfinite(v) else None for v in values]


def _infinite(values: list[Any], dimensions: int) -> Array:
    """Numbers of lists; None is infinite, downwards for the first of a pair."""
    if dimensions == 1:
        return np.array([math.inf if v is None else v for v in values], dtype=np.float64)
    return np.array(
        [
            [-math.inf if low is None else low, math.inf if high is None else high]
            for low, high in values
        ],
        dtype=np.float64,
    )
