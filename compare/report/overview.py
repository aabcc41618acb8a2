"""The table of all swarms on all cases: what stands in each column, row and cell."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row, RowStatus
from compare.benchmark.summaries import Summary, best_row, bound_of
from compare.report.words import percent

AT_OPTIMUM = 1e-6
"""Gap up to which a swarm counts as having reached the optimum."""
_SHADES = (("g0", AT_OPTIMUM), ("g1", 1e-4), ("g2", 1e-2), ("g3", 5e-2))
# a run that ended in one of these ways did what it should; its motion may break limits all the same
_ENDED = (
    RowStatus.ok,
    RowStatus.no_feasible_point,
    RowStatus.nothing_moves,
    RowStatus.breaks_position_limits,
)


@dataclass(frozen=True)
class OverviewColumn:
    """A variant of a coding on one case, with the evaluations that each run has."""

    case: str
    variant: str
    evaluations: str


@dataclass(frozen=True)
class OverviewCell:
    """All seeds of one swarm in one column.

    Attributes
    ----------
    summary : Summary
        Its gaps are relative to the best motion of the family that is known.
    shade : str
        Class of the median gap; five steps that differ in lightness too.
    failed : tuple of str
        How runs ended that did not end as they should, each named once.
    """

    summary: Summary
    shade: str
    failed: tuple[str, ...]


def best_known(ladder: LadderRecord, rows: Iterable[Row]) -> float | None:
    """Return the time of the best verified motion of the family, whoever found it.

    Parameters
    ----------
    ladder : LadderRecord
    rows : iterable of Row
        Runs on the same case.

    Returns
    -------
    float or None [s]
    """
    best = best_row(rows)
    found = (ladder["ladder"]["family"]["seconds"], None if best is None else best.seconds)
    return min((seconds for seconds in found if seconds is not None), default=None)


def to_best_known(
    rows: Sequence[Row], ladders: Mapping[str, LadderRecord]
) -> tuple[list[Row], dict[str, float | None]]:
    """Measure the gaps of rows against the best motion of the family that is known.

    Stored gaps are measured against the certified bound, which for B-splines lies up to 0.1 % lower.

    Parameters
    ----------
    rows : sequence of Row
    ladders : mapping of str to LadderRecord
        By case.

    Returns
    -------
    rows : list of Row
        The same with ``bound``, ``gap`` and ``claimed_gap`` measured anew.
    best : dict of str to float or None [s]
        By case.
    """
    best = {
        case: best_known(ladder, (r for r in rows if r.case == case))
        for case, ladder in ladders.items()
    }
    measured = []
    for row in rows:
        bound = best.get(row.case)
        if bound is not None:
            gap = None if row.seconds is None else row.seconds / bound - 1.0
            claimed = None if row.claimed is None else row.claimed / bound - 1.0
            row = replace(row, bound=bound, gap=gap, claimed_gap=claimed)
        measured.append(row)
    return measured, best


def columns(rows: Iterable[Row], cases: Iterable[str]) -> list[OverviewColumn]:
    """Return the columns of the table, case by case.

    Parameters
    ----------
    rows : iterable of Row
    cases : iterable of str
        In the order of the table.

    Returns
    -------
    list of OverviewColumn
    """
    budgets: dict[tuple[str, str], set[int]] = {}
    variants: dict[str, None] = {}
    for row in rows:
        budgets.setdefault((row.case, row.variant), set()).add(row.budget)
        variants[row.variant] = None
    return [
        OverviewColumn(
            case, variant, " or ".join(f"{count:,}" for count in sorted(budgets[case, variant]))
        )
        for case in cases
        for variant in variants
        if (case, variant) in budgets
    ]


def cells(
    found: Mapping[tuple[str, str, str], Summary], rows: Iterable[Row]
) -> dict[tuple[str, str, str], OverviewCell]:
    """Return the cells by case, variant and swarm.

    Parameters
    ----------
    found : mapping of (case, variant, swarm) to Summary
    rows : iterable of Row

    Returns
    -------
    dict of (case, variant, swarm) to OverviewCell
    """
    failed: dict[tuple[str, str, str], dict[str, None]] = {}
    for row in rows:
        if row.status not in _ENDED:
            failed.setdefault((row.case, row.variant, row.swarm), {})[str(row.status)] = None
    return {
        key: OverviewCell(summary, shade(summary.gap), tuple(failed.get(key, ())))
        for key, summary in found.items()
    }


def shade(gap: float | None) -> str:
    """Return the class of a gap.

    Parameters
    ----------
    gap : float or None

    Returns
    -------
    str
    """
    if gap is None:
        return "none"
    return next((name for name, most in _SHADES if gap <= most), "g4")


def proof_words(ladder: LadderRecord, best: float | None) -> str:
    """Say how far the best motion of a family can lie above the optimum.

    Parameters
    ----------
    ladder : LadderRecord
    best : float or None [s]

    Returns
    -------
    str
    """
    lower = ladder["ladder"]["family_lower"]["seconds"]
    if best is None:
        return "no optimum"
    if not lower or bound_of(ladder)[1] != "certified":
        return "not proved"
    return f"proved to {percent(best / lower - 1.0)}"
