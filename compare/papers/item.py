"""One table or figure of a paper, made again: how it is computed, and how the stored result is shown."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.figure import Figure

from compare.papers.verdicts import Reproduction


@dataclass(frozen=True)
class Table:
    """A table of a page; every cell is text, printed beside reproduced.

    Attributes
    ----------
    header : sequence of str
        Names of the columns.
    rows : sequence of (sequence of str)
        The cells.
    caption : str
        Below the table.
    right : sequence of int
        Columns of numbers.
    """

    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    caption: str = ""
    right: Sequence[int] = ()


@dataclass(frozen=True)
class ItemVerdict:
    """What is left of one printed result; a line of the table on top of the page.

    Attributes
    ----------
    what : str
        The printed result, and the reading if there are several: "the gain of MIPSO over PSO, 60 deg/s²".
    outcome : Reproduction
        The same value that the remark on it uses.
    """

    what: str
    outcome: Reproduction


@dataclass(frozen=True)
class Shown:
    """What a reader sees of an item.

    Attributes
    ----------
    parts : sequence of Table or Figure
        In order.
    remarks : sequence of str
        Sentences, each with the numbers that it rests on; verdicts come from ``verdicts``.
    verdicts : sequence of ItemVerdict
        On each printed result that the remarks judge; empty if nothing is printed that could be judged.
    """

    parts: Sequence[Table | Figure]
    remarks: Sequence[str]
    verdicts: Sequence[ItemVerdict]


@dataclass(frozen=True)
class Item:
    """A table or figure of a paper, made again.

    Attributes
    ----------
    label : str
        As the paper calls it: "Table 8", "Figs 8-10".
    title : str
        What it shows there.
    make : callable
        (full) -> JSON of plain numbers and text, with the paper's own budgets if ``full``. It is a
        function of a module, since it runs in a worker, and gives the same for the same argument.
    show : callable
        That JSON -> ``Shown``. It computes nothing but text and pictures.
    reading : str
        What the paper leaves open, and how it was read. What another reading gives belongs to the remarks.
    cost : float [s]
        About how long it takes by default; the longest item is started first.
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
