"""Rows of rivals as a table in the terminal, as plain data, and as a page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from compare.report.frame import CHARTS, environment
from compare.rivals import RIVALS
from compare.rivals.rows import KEEPS, OURS, RivalRow
from compare.screen import table

HEADER = (
    "task", "program", "time [s]", "over bound [%]", "slowed down [s]", "path [rad]", "off waypoint [rad]",
    "work [s]", "verdict", "why",
)  # fmt: skip
RIGHT = (2, 3, 4, 5, 6, 7)
_FAULTS = 2  # shown in a cell


def cells(row: RivalRow) -> list[str]:
    """Return the cells of a row.

    Parameters
    ----------
    row : RivalRow

    Returns
    -------
    list of str
    """
    why = list(row.faults[:_FAULTS])
    if len(row.faults) > _FAULTS:
        why.append(f"and {len(row.faults) - _FAULTS} more")
    if row.own_bound is not None and row.rival != OURS:
        why.append(f"own bound {row.own_bound:.6g} s")
    why += [row.reason] if row.reason else []
    gap = None if row.gap is None else 100.0 * row.gap
    return [
        row.problem,
        OURS if row.rival == OURS else RIVALS[row.rival].name if row.rival in RIVALS else row.rival,
        _number(row.seconds, ".4f"),
        _number(gap, "+.3f"),
        _number(row.mended, ".4f"),
        _number(row.length, ".3f"),
        _number(row.deviation, ".1e"),
        _number(row.computation, ".2f"),
        row.status,
        "; ".join(why),
    ]


def as_text(rows: Sequence[RivalRow]) -> str:
    """Set the rows as a table.

    Parameters
    ----------
    rows : sequence of RivalRow

    Returns
    -------
    str
    """
    return table(HEADER, [cells(row) for row in rows], right=RIGHT)


def as_json(rows: Sequence[RivalRow], seconds: float) -> dict[str, Any]:
    """Return the rows as plain data.

    Parameters
    ----------
    rows : sequence of RivalRow
    seconds : float
        Time limit of each run [s].

    Returns
    -------
    dict
    """
    return {"time_limit": seconds, "rows": [row.to_json() for row in rows]}


def as_page(rows: Sequence[RivalRow], seconds: float) -> str:
    """Return the page as HTML that needs nothing else: a chart and a table per task.

    Parameters
    ----------
    rows : sequence of RivalRow
    seconds : float
        Time limit of each run [s].

    Returns
    -------
    str
    """
    tasks = list(dict.fromkeys(row.problem for row in rows))
    by_task = [[row for row in rows if row.problem == name] for name in tasks]
    context = {
        "scripts": CHARTS,
        "charts": {f"task{k}": {"ladder": chart(mine)} for k, mine in enumerate(by_task)},
        "tasks": [(f"task{k}", name, [cells(row)[1:] for row in mine])
                  for k, (name, mine) in enumerate(zip(tasks, by_task, strict=True))],
        "header": HEADER[1:],
        "right": [index - 1 for index in RIGHT],
        "rivals": list(RIVALS.values()),
        "seconds": seconds,
        "versions": {row.rival: row.version for row in rows if row.version},
    }  # fmt: skip
    return environment(Path()).get_template("rivals.html.j2").render(context)


def chart(rows: Sequence[RivalRow]) -> dict[str, Any]:
    """Return the motions of one task on one axis of time, with the times that no motion can have.

    Parameters
    ----------
    rows : sequence of RivalRow
        Of one task.

    Returns
    -------
    dict
        As ``compare.report.charts.ladder.ladder_chart`` returns it.
    """
    lines = [
        {
            "name": cells(row)[1] + ("" if row.status == KEEPS else ": breaks what is asked for"),
            "seconds": row.seconds,
            "kind": "faulty" if row.status != KEEPS else "upper" if row.rival == OURS else "given",
            "first": True,
        }
        for row in rows
        if row.seconds is not None
    ]
    lines.sort(key=lambda line: line["seconds"])
    barrier = next((row.bound for row in rows if row.bound), None)
    said = [f"no motion is faster than {barrier:.4f} s"] if barrier else []
    said += [f"{line['name']} {line['seconds']:.4f} s" for line in lines]
    return {
        "lines": lines,
        "barrier": barrier,
        "optimum": None,
        "proved": False,
        "alt": f"{'; '.join(said)}.",
    }


def _number(value: float | None, form: str) -> str:
    return "-" if value is None else f"{value:{form}}"
