"""What was asked for in a comparison, as the report says it and the store keeps it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any


@dataclass(frozen=True, slots=True)
class Settings:
    """What was asked for.

    Attributes
    ----------
    size : str
        ``default``, ``quick`` or ``full``.
    cases : tuple of str
    seeds : tuple of int
        In ascending order.
    budget : str
        Evaluations of a run, in words.
    allow : tuple of str
        Columns in which the rows of one cell may differ: ``machine``, or none.
    """

    size: str
    cases: tuple[str, ...]
    seeds: tuple[int, ...]
    budget: str
    allow: tuple[str, ...] = ()

    @property
    def seeds_text(self) -> str:
        """The seeds for people: 0 to 4, or 0 to 4, 8, 10 to 19."""
        ends = [k for k, (a, b) in enumerate(pairwise(self.seeds), 1) if b != a + 1]
        spans = [self.seeds[i:j] for i, j in pairwise([0, *ends, len(self.seeds)])]
        return ", ".join(f"{s[0]} to {s[-1]}" if len(s) > 1 else str(s[0]) for s in spans if s)

    @staticmethod
    def from_json(data: Any) -> Settings:
        """Parse plain data.

        Parameters
        ----------
        data : object
            What was read from JSON.

        Returns
        -------
        Settings

        Raises
        ------
        ValueError
            If an entry is missing or of another type.
        """
        try:
            size, budget = data["size"], data["budget"]
            cases, seeds, allow = (tuple(data[key]) for key in ("cases", "seeds", "allow"))
        except (KeyError, TypeError) as error:
            raise ValueError(f"not the settings of a comparison: {error!r}") from None
        of_type = [(str, (size, budget, *cases, *allow)), (int, seeds)]
        if any(type(value) is not kind for kind, values in of_type for value in values):
            raise ValueError("not the settings of a comparison: unexpected entries")
        return Settings(size, cases, seeds, budget, allow)


def budget_words(budgets: Sequence[int]) -> str:
    """Return budgets in words; of many, the least and the greatest.

    Parameters
    ----------
    budgets : sequence of int
        In ascending order.

    Returns
    -------
    str
    """
    if len(budgets) > 4:
        return f"{budgets[0]} to {budgets[-1]} evaluations"
    return " or ".join(str(budget) for budget in budgets) + " evaluations"
