"""Rows of rivals in the terminal: tables that fit into 80 columns, and words that are wrapped at its edge."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from compare.rivals.rows import KEEPS, NOT_GIVEN, RivalRow
from compare.rivals.shown import by_task, factor_of, name_of, number, remarks
from compare.screen import table

_HEADER = (
    "\nprogram",
    "\nverdict",
    "time\n[s]",
    "over\nfastest",
    "slowed\nto [s]",
    "worst\nlimit",
    "work\n[s]",
)
_SUMMARY = (
    "\n\nprogram", "\nkeeps\nall", "\n\nbreaks", "\nfinds\nnone", "over\nfastest\nmedian",
    "over\nfastest\nmost", "\nworst\nlimit", "\nwork\n[s]",
)  # fmt: skip
_EXACTLY = "points passed exactly:"  # as long as the longest name of a program
_MEANING = """\
over fastest: time over that of the fastest motion of the task that keeps all
slowed to: time once stretched until it keeps all; - where no stretch mends it
worst limit: largest value over its limit
work: of the program itself, over all tasks the median"""
_EXACT_MEANING = """
points passed exactly: by programs that know no zones; their motions are valid
  within them"""


def as_text(rows: Sequence[RivalRow], summary: Sequence[dict[str, Any]]) -> str:
    """Set two tables per task, the times and what is broken, and then a line per program.

    Paths and distances from the waypoints are left out; CSV, JSON and page have them.

    Parameters
    ----------
    rows : sequence of RivalRow
    summary : sequence of dict
        A ``RivalSummary`` each, as plain data.

    Returns
    -------
    str
    """
    parts = [_task(name, mine) for name, mine in by_task(rows).items()]
    lines = [
        (entry["exact"], [
            name_of(entry["rival"]), *(f"{entry[key]}" for key in ("kept", "broken", "none")),
            *(number(value, ".4f") for value in entry["over"] or (None, None)),
            _short(entry["factor"]), number(entry["work"], ".2f"),
        ])
        for entry in summary
        if entry["tasks"]
    ]  # fmt: skip
    parts.append(f"all tasks\n{table(_SUMMARY, _grouped(lines), right=range(1, len(_SUMMARY)))}")
    if away := _not_given(rows):
        parts.append(f"not given a task\n{away}")
    meaning = _MEANING + (_EXACT_MEANING if any(row.exact for row in rows) else "")
    return "\n\n".join([*parts, meaning])


def _task(name: str, rows: Sequence[RivalRow]) -> str:
    """Both tables of one task under its name."""
    given = [row for row in rows if row.status not in NOT_GIVEN]
    lines = [
        (row.exact, [
            name_of(row.rival), row.status, number(row.seconds, ".4f"), number(row.over_fastest, ".4f"),
            number(row.mended, ".4f"), _short(row.factor), number(row.computation, ".2f"),
        ])
        for row in given
    ]  # fmt: skip
    said = [_head(name, rows), table(_HEADER, _grouped(lines), right=range(2, len(_HEADER)))]
    if words := [[name_of(row.rival), remarks(row)] for row in given if remarks(row)]:
        said.append(f"\n{table(('program', 'what is broken, and notes'), words)}")
    return "\n".join(said)


def _head(name: str, rows: Sequence[RivalRow]) -> str:
    """The task with its fastest motion and the bound."""
    best = next((row for row in rows if row.status == KEEPS and row.seconds == row.fastest), None)
    said = [] if best is None else [f"fastest {best.seconds:.4f} s, {name_of(best.rival)}"]
    bound = next((row.bound for row in rows if row.bound), None)
    if bound:
        over = f" (over bound: {best.over_bound:.4f})" if best and best.over_bound else ""
        said.append(f"proved: none below {bound:.4f} s{over}")
    return "\n".join([name, *(f"  {line}" for line in said)])


def _grouped(lines: Iterable[tuple[bool, list[str]]]) -> list[list[str]]:
    """Lines of a table; those of programs that pass the points of zones exactly are last, and said to be."""
    kept = list(lines)
    exact = [line for is_exact, line in kept if is_exact]
    head = [[_EXACTLY, *[""] * (len(exact[0]) - 1)]] if exact else []
    return [*(line for is_exact, line in kept if not is_exact), *head, *exact]


def _not_given(rows: Sequence[RivalRow]) -> str:
    """Each program with each reason why it was not given a task, and how many tasks."""
    found: dict[tuple[str, str], int] = {}
    for row in (row for row in rows if row.status in NOT_GIVEN):
        name = name_of(row.rival)
        words = name, f"{row.status}: {row.reason.removeprefix(f'{name}: ')}"
        found[words] = found.get(words, 0) + 1
    lines = [[name, str(count), why] for (name, why), count in found.items()]
    return table(("program", "tasks", "why"), lines, right=(1,)) if lines else ""


def _short(factor: float | None) -> str:
    return factor_of(factor).replace(" ", "")
