"""The one gate through which rows reach a statistic: what differs in more than the seed is not pooled."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from compare.benchmark.records.rows import Row
from formulations import InputError

CELL = ("case", "coding", "track", "coordinates", "swarm")
"""Columns that name a cell: the runs of one swarm on one task, which differ in their seeds."""

_WORDS = {
    "budget": "budgets",
    "population": "populations",
    "problem": "problems",
    "code": "versions of the swarm's code",
    "library": "versions of the swarm's library",
    "parameters": "sets of parameters",
    "versions": "versions of the programs",
    "time_limit": "time limits",
    "machine": "machines",
}


def pooled(rows: Iterable[Row], *, allow: Collection[str] = ()) -> list[Row]:
    """Return rows of which each cell was made by one code, in one version, with one budget.

    Parameters
    ----------
    rows : iterable of Row
        Rows of any cells.
    allow : collection of str
        Columns in which the rows of one cell may differ; only ``machine`` can be allowed.

    Returns
    -------
    list of Row
        The same rows in the same order.

    Raises
    ------
    InputError
        If a cell holds rows that differ in anything but their seeds, or two rows of one seed. The
        message names the cell, what differs, and two values of it.
    """
    return list(require_pooled(rows, allow=allow))


def require_pooled(rows: Iterable[Row], *, allow: Collection[str] = ()) -> Iterator[Row]:
    """Pass rows on one by one, as ``pooled`` does; memory grows with cells and seeds alone.

    Parameters
    ----------
    rows : iterable of Row
    allow : collection of str
        As for ``pooled``.

    Yields
    ------
    Row
    """
    if forbidden := set(allow) - {"machine"}:
        raise InputError(f"allow: {', '.join(sorted(forbidden))}: only machine can be allowed")
    first: dict[tuple[object, ...], Row] = {}
    seeds: set[tuple[object, ...]] = set()
    for row in rows:
        cell = tuple(getattr(row, name) for name in CELL)
        other = first.setdefault(cell, row)
        for name, words in _WORDS.items():
            one, two = getattr(other, name), getattr(row, name)
            if one != two and name not in allow:
                raise InputError(
                    f"{', '.join(map(str, cell))}: rows of two {words} cannot be pooled:"
                    f" {'none' if one in ('', None) else one} and {'none' if two in ('', None) else two}"
                )
        if (*cell, row.seed) in seeds:
            raise InputError(
                f"{', '.join(map(str, cell))}: two rows of seed {row.seed} cannot be pooled"
            )
        seeds.add((*cell, row.seed))
        yield row
