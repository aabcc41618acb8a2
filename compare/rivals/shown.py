"""Rows of rivals as cells of tables in documents, and as a page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from compare.report.frame import CHARTS, environment
from compare.rivals import RIVALS
from compare.rivals.rows import KEEPS, OURS, RivalRow, limit_factor

HEADER = (
    "task", "program", "verdict", "time [s]", "over fastest", "over bound", "slowed down [s]", "worst limit",
    "work [s]", "path [rad]", "off waypoint [rad]", "what is broken, and notes",
)  # fmt: skip
RIGHT = (3, 4, 5, 6, 7, 8, 9, 10)
SUMMARY = (
    "program", "tasks", "keeps all", "breaks", "no motion", "over fastest: median", "over fastest: largest",
    "slowed down: mends", "slowed down: median", "slowed down: largest", "worst limit", "work: median [s]",
)  # fmt: skip
SUMMARY_RIGHT = tuple(range(1, 12))
EXACTLY = "passes the points exactly"
"""What is noted of a motion in a task with zones, where the program knows none."""


def name_of(key: str) -> str:
    """Return the name of a program in tables.

    Parameters
    ----------
    key : str
        Of ``RIVALS``, or ours.

    Returns
    -------
    str
    """
    return RIVALS[key].name if key in RIVALS else key


def cells(row: RivalRow) -> list[str]:
    """Return the cells of a row.

    Parameters
    ----------
    row : RivalRow

    Returns
    -------
    list of str
    """
    return [
        row.problem,
        name_of(row.rival),
        row.status,
        number(row.seconds, ".4f"),
        number(row.over_fastest, ".4f"),
        number(row.over_bound, ".4f"),
        number(row.mended, ".4f"),
        factor_of(row.factor),
        number(row.computation, ".2f"),
        number(row.length, ".3f"),
        number(row.deviation, ".1e"),
        "; ".join(filter(None, [EXACTLY if row.exact and row.seconds else "", remarks(row)])),
    ]


def remarks(row: RivalRow) -> str:
    """Say what is broken, and what the program says of itself.

    Parameters
    ----------
    row : RivalRow

    Returns
    -------
    str
        Empty where there is nothing to be said.
    """
    why = [row.faults] if row.faults else []
    if row.own_bound is not None and row.rival != OURS:
        why.append(f"own bound {row.own_bound:.6g} s")
    return "; ".join([*why, row.reason] if row.reason else why)


def summary_cells(entry: dict[str, Any]) -> list[str]:
    """Return the cells of a program's summary.

    Parameters
    ----------
    entry : dict
        A ``RivalSummary`` as plain data.

    Returns
    -------
    list of str
    """
    over, mended = entry["over"] or (None, None), entry["mended"] or (None, None)
    return [
        name_of(entry["rival"]),
        *(str(entry[key]) for key in ("tasks", "kept", "broken", "none")),
        *(number(value, ".4f") for value in over),
        str(entry["mendable"]),
        *(number(value, ".4f") for value in mended),
        factor_of(entry["factor"]),
        number(entry["work"], ".2f"),
    ]


def summary_tables(summary: Sequence[dict[str, Any]]) -> list[tuple[str, list[list[str]]]]:
    """Part the summary into tables: tasks as they stand, and tasks with zones whose points are passed exactly.

    Parameters
    ----------
    summary : sequence of dict
        A ``RivalSummary`` each, as plain data.

    Returns
    -------
    list of (str, list of list of str)
        Title and rows of each.
    """
    titles = {False: "Tasks as they stand", True: "Tasks with zones, points passed exactly"}
    tables = ((title, [summary_cells(one) for one in summary if one["exact"] == exact])
              for exact, title in titles.items())  # fmt: skip
    return [(title, rows) for title, rows in tables if rows]


def by_task(rows: Sequence[RivalRow]) -> dict[str, list[RivalRow]]:
    """Collect the rows of each task.

    Parameters
    ----------
    rows : sequence of RivalRow

    Returns
    -------
    dict of str to list of RivalRow
        By name of the task, in the order of first use.
    """
    found: dict[str, list[RivalRow]] = {}
    for row in rows:
        found.setdefault(row.problem, []).append(row)
    return found


def as_page(rows: Sequence[RivalRow], summary: Sequence[dict[str, Any]]) -> str:
    """Return the page as HTML that needs nothing else: a chart and a table per task.

    Parameters
    ----------
    rows : sequence of RivalRow
    summary : sequence of dict
        A ``RivalSummary`` each, as plain data.

    Returns
    -------
    str
    """
    tasks = by_task(rows)
    context = {
        "scripts": CHARTS,
        "charts": {f"task{k}": {"ladder": chart(mine)} for k, mine in enumerate(tasks.values())},
        "tasks": [(f"task{k}", name, [cells(row)[1:] for row in mine])
                  for k, (name, mine) in enumerate(tasks.items())],
        "header": HEADER[1:],
        "left": [index - 1 for index in range(1, len(HEADER)) if index not in RIGHT],
        "summary_header": SUMMARY,
        "summaries": summary_tables(summary),
        "rivals": list(RIVALS.values()),
        "seconds": sorted({row.time_limit for row in rows}),
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
            "name": name_of(row.rival) + ("" if row.status == KEEPS else ": breaks what is asked for"),
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


def number(value: float | None, form: str) -> str:
    """Write a number that may be missing.

    Parameters
    ----------
    value : float or None
    form : str
        As after the colon of a format field.

    Returns
    -------
    str
        ``-`` where it is missing.
    """
    return "-" if value is None else f"{value:{form}}"


def factor_of(factor: float | None) -> str:
    """Write the largest value over a limit, which may be missing.

    Parameters
    ----------
    factor : float or None

    Returns
    -------
    str
        As ``limit_factor`` does; ``-`` where it is missing.
    """
    return "-" if factor is None else limit_factor(factor)
