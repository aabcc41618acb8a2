"""The runs of a table by cell; a table with a hole is refused, as no average goes over unequal sets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Sized

_NAMED = 3  # cells that the message names


class MissingCellError(ValueError):
    """A cell of a table has no run, or fewer than the others; the message names it."""


def complete(
    cells: Mapping[tuple[str, str], Sized], rows: Sequence[str], columns: Sequence[str], runs: int
) -> None:
    """Make sure that each cell of a table holds the same number of runs.

    Parameters
    ----------
    cells : mapping of (row, column) to array or list, n
        One entry per run.
    rows, columns : sequence of str
        The table that is asked for: instances and algorithms.
    runs : int
        Number of runs that each cell must hold.

    Raises
    ------
    MissingCellError
        A cell holds another number; the message names the first ones.
    """
    found = {(row, column): len(cells.get((row, column), ())) for row in rows for column in columns}
    wrong = [
        f"{column} on {row}: {count} of {runs} runs"
        for (row, column), count in found.items()
        if count != runs
    ]
    if wrong:
        more = f" and {len(wrong) - _NAMED} cells more" if len(wrong) > _NAMED else ""
        raise MissingCellError("; ".join(wrong[:_NAMED]) + more)
