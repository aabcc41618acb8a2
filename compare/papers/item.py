"""One table or figure of a paper, made again: how it is computed, and how what is stored is shown."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from matplotlib.figure import Figure


@dataclass(frozen=True)
class Table:
    """Cells as text, printed beside reproduced. right: columns of numbers."""

    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    caption: str = ""
    right: Sequence[int] = ()


@dataclass(frozen=True)
class Shown:
    """What a reader sees of an item. remarks: one sentence each, with the number that it rests on."""

    parts: Sequence[Table | Figure]
    remarks: Sequence[str] = field(default_factory=tuple)


@dataclass(frozen=True)
class Item:
    """A table or figure of a paper.

    label: as the paper calls it ("Table 8", "Figs 8-10"); title: what it shows there; reading: what the
    paper leaves open and how it was read (what the other reading gives belongs to the remarks).
    make: (full) -> JSON of plain numbers and text, with the papers' budgets if full; a function of a
    module, as it runs in a worker, and the same for the same argument.
    show: that JSON -> what a reader sees; computes nothing but the picture.
    cost: seconds it takes by default, about: the longest item is started first.
    """

    label: str
    title: str
    make: Callable[[bool], dict[str, Any]]
    show: Callable[[dict[str, Any]], Shown]
    reading: str = ""
    cost: float = 1.0

    @property
    def key(self) -> str:
        """As a file name."""
        return self.label.lower().replace(" ", "-").replace(".", "").replace(",", "")
