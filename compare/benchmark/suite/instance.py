"""An instance of the benchmark: one problem as plain data, with a digest and with where it comes from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

from compare.benchmark.records.instances import plain_problem, problem_of
from compare.benchmark.records.provenance import problem_digest
from formulations import InputError, Problem


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
        return {
            "name": self.name,
            "split": self.split.value,
            "origin": self.origin,
            "source": self.source,
            "digest": self.digest,
            "problem": plain_problem(replace(self.problem, name=self.name, source=self.source)),
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
            problem = problem_of(data["problem"])
            split = Split(data["split"])
            found = Instance(data["name"], problem, split, data["origin"], data["source"])
            digest = data["digest"]
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(f"instance: not one of this version of timebound: {error}") from None
        if found.digest != digest:
            raise InputError(f"instance {found.name}: its digest is {found.digest}, not {digest}")
        return found
