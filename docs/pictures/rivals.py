"""The run of docs/howto/rivals.md: ``python docs/pictures/rivals.py rivals.json`` writes it from the rows of
``timebound rivals --json rivals.json``, and keeps these rows in ``docs/static/rivals.json``.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from compare.rivals.rows import BREAKS, KEEPS, NOT_GIVEN, OURS, RivalRow
from compare.rivals.run_study import summarise
from compare.rivals.shown import HEADER, RIGHT, SUMMARY, SUMMARY_RIGHT, cells, name_of, summary_tables

DOCS = Path(__file__).parents[1]
PAGE, ROWS = DOCS / "howto" / "rivals.md", DOCS / "static" / "rivals.json"
BEGIN, END = "<!-- made by docs/pictures/rivals.py -->\n", "<!-- end -->\n"
PROVED = 1.0 + 2e-4  # over the bound: a gap of 1e-4 is asked for


def stored() -> tuple[list[RivalRow], str]:
    """Return the rows of the run that the page shows, and its machine."""
    data = json.loads(ROWS.read_text("utf-8"))
    return [RivalRow(**row) for row in data["rows"]], data["machine"]


def section(rows: Sequence[RivalRow], machine: str) -> str:
    """Return what the page says of a run.

    Parameters
    ----------
    rows : sequence of RivalRow
    machine : str

    Returns
    -------
    str
        Markdown.
    """
    given = [row for row in rows if row.status not in NOT_GIVEN]
    own = [row for row in given if not row.exact]
    limit = {row.time_limit for row in rows}
    versions = sorted({f"{row.rival.split('_')[0]} {row.version}" for row in rows if row.version})
    tasks = dict.fromkeys(row.problem for row in rows)
    opened = (
        f"{len(tasks)} tasks, {len(rows)} rows, {_joined(f'{one:g}' for one in limit)} s for each program on "
        f"each task (SCIP has four fifths of them), {machine}. Others used the machine too. Versions: "
        f"{', '.join(versions)}. {len(rows) - len(given)} rows of programs that are not run, or that cannot be "
        "asked for the task, are left out of the tables; `timebound rivals` prints them with their reasons.\n"
    )
    summary = [entry for entry in summarise(list(rows)) if entry["tasks"]]
    return "\n".join(
        [
            opened,
            *(f"- {line}" for line in [*_ours(rows), *_others(own), *_scip(own), *_exactly(given)]),
            "\n### By program",
            *(
                f"\n{title}:\n\n{_table(SUMMARY, of, SUMMARY_RIGHT)}"
                for title, of in summary_tables(summary)
            ),
            "\n### SCIP beside the proof\n",
            _beside_scip(own),
            "\n### In the same zones\n",
            _in_zones(rows),
            "\n### Every row\n",
            _table(HEADER, [cells(row) for row in given], RIGHT),
        ]
    )


def _ours(rows: Sequence[RivalRow]) -> list[str]:
    mine = [row for row in rows if row.rival == OURS]
    fastest = sum(row.status == KEEPS and row.over_fastest == 1.0 for row in mine)
    proved = [row for row in mine if (row.over_bound or np.inf) <= PROVED]
    loose = [
        f"{row.problem} ({_percent(row.over_bound)} above the bound)"
        for row in mine
        if row not in proved
    ]
    work = [row.computation for row in mine if row.computation is not None]
    return [
        f"**timebound** has the fastest motion that keeps all on {fastest} of {len(mine)} tasks, and proves on "
        f"{len(proved)} that none is faster by more than a share of "
        f"{max((row.over_bound or 1.0) - 1.0 for row in proved):.0e}"
        + (f", but not on {_joined(loose)}" if loose else "")
        + f". It took {np.median(work):.2g} s at the median, {max(work):.2g} s at most, with the proof."
    ]


def _others(rows: Sequence[RivalRow]) -> list[str]:
    """One sentence or two per program: how far above the fastest motion, and what is broken."""
    lines = []
    for key in dict.fromkeys(row.rival for row in rows if row.rival != OURS):
        mine = [row for row in rows if row.rival == key]
        kept = [row for row in mine if row.status == KEEPS]
        broken = [row for row in mine if row.status == BREAKS]
        line = f"**{name_of(key)}** keeps all on {len(kept)} of {len(mine)} tasks"
        line += _spread([row.over_fastest for row in kept if row.over_fastest is not None])
        if broken:
            line += f". It breaks something on {len(broken)}: {_broken(broken)}"
            mended = [row.mended / row.fastest for row in broken if row.mended and row.fastest]
            if mended:
                line += f"; slowed down, {len(mended)} of them keep all{_spread(mended)}"
        others = [row for row in mine if row not in kept and row not in broken]
        if others:
            reasons = dict.fromkeys(f"{row.status}: {row.reason}" for row in others)
            line += f". Without a motion on {len(others)} ({_joined(reasons)})"
        lines.append(f"{line}.")
    return lines


def _broken(rows: Sequence[RivalRow]) -> str:
    """Each thing that is broken, on how many tasks, and by how much at most."""
    found: dict[str, list[str]] = {}
    for row in rows:
        for fault in row.faults.split("; "):
            words = re.match(r"(\w+) (jumps|not zero at rest|(?=\d))", fault)
            name = f"{words[1]} {words[2] or 'limit'}".strip() if words else fault
            size = re.match(
                r"\w+ (?:jumps by )?([\d.e+-]+(?: \+ [\d.e-]+)?) (?:of its limit|(rad\S*))", fault
            )
            found.setdefault(name, []).append(f"{size[1]} {size[2] or ''}".strip() if size else "")
    worst = {
        name: max((s for s in sizes if s), key=_value, default="") for name, sizes in found.items()
    }
    return _joined(
        f"{name} ({len(sizes)}{f', up to {worst[name]}' if worst[name] else ''})"
        for name, sizes in found.items()
    )


def _value(size: str) -> float:
    return sum(float(part) for part in size.partition(" rad")[0].split(" + "))


def _scip(rows: Sequence[RivalRow]) -> list[str]:
    mine = [row for row in rows if row.rival == "scip" and row.own_bound and row.seconds]
    if not mine:
        return []
    gaps = [row.seconds / row.own_bound - 1.0 for row in mine if row.seconds and row.own_bound]
    done = sum(gap <= 1.1e-4 for gap in gaps)
    above = [row for row in mine if row.fastest and row.own_bound and row.own_bound > row.fastest]
    ours = {row.problem: row for row in rows if row.rival == OURS}
    quicker = sum((ours[row.problem].computation or 0.0) < (row.computation or 0.0) for row in mine)
    return [
        f"SCIP exceeds no limit by more than {max((row.factor or 0.0) - 1.0 for row in mine):.1e} of it; its "
        f"tolerance is 1e-6. It ends within its own gap of 1e-4 on {done} of {len(mine)} tasks; on the others "
        f"that gap is up to {100.0 * max(gaps):.2g} % when its time is over. Its bound is one of its own "
        f"program: on {len(above)} tasks it is above the time of a motion that keeps all. Our motion with its "
        f"proof took less time on {quicker} of {len(mine)}."
    ]


def _beside_scip(rows: Sequence[RivalRow]) -> str:
    ours = {row.problem: row for row in rows if row.rival == OURS}
    header = (
        "task", "timebound [s]", "proved: none below [s]", "work [s]", "SCIP [s]", "slowed down [s]",
        "its own bound [s]", "worst limit", "work [s]",
    )  # fmt: skip
    made = []
    for row in (row for row in rows if row.rival == "scip"):
        mine, shown = ours[row.problem], cells(row)
        made.append(
            [
                row.problem, f"{mine.seconds:.4f}", f"{mine.bound:.4f}", f"{mine.computation:.2f}", shown[3],
                shown[6], "-" if row.own_bound is None else f"{row.own_bound:.4f}", shown[7], shown[8],
            ]
        )  # fmt: skip
    return _table(header, made, range(1, 9))


def _exactly(rows: Sequence[RivalRow]) -> list[str]:
    """How far programs that pass the points exactly stay above the fastest motion within the zones."""
    words = []
    for key in dict.fromkeys(row.rival for row in rows if row.exact):
        mine = [row for row in rows if row.rival == key and row.exact]
        kept = [row.over_fastest for row in mine if row.status == KEEPS and row.over_fastest]
        ends = dict.fromkeys(_percent(one) for one in (min(kept), max(kept))) if kept else {}
        far = f", {' to '.join(ends)}" if ends else ""
        words.append(f"{name_of(key)} ({len(kept)} of {len(mine)}{far})")
    if not words:
        return []
    return [
        "In the tasks with zones, motions that pass the points exactly take longer than the fastest one within "
        f"the zones. Of those that keep all: {_joined(words)}."
    ]


def _in_zones(rows: Sequence[RivalRow]) -> str:
    """Our motion within the zones beside blends, and beside the fastest motions through the points."""
    found = {(row.problem, row.rival): row for row in rows}
    header = (
        "task", "timebound, zones [s]", "justblend, blends [s]", "over ours", "timebound, points [s]",
        "over zones", "fastest other, points [s]", "over zones", "program",
    )  # fmt: skip
    made = []
    for (task, rival), blend in found.items():
        if rival != "justblend_blends" or blend.status in NOT_GIVEN:
            continue
        name, mine = task.partition(", zones")[0], found[task, OURS]
        others = [row for row in rows if row.problem == task and row.exact and row.status == KEEPS]
        best = min(others, key=lambda row: row.seconds or np.inf, default=None)
        cells_ = [f"{mine.seconds:.4f}"]
        for row in (blend, found.get((name, OURS)), best):
            seconds = None if row is None else row.seconds
            cells_ += (
                ["-", "-"] if seconds is None else [f"{seconds:.4f}", f"{seconds / mine.seconds:.4f}"]
            )
        made.append([name, *cells_, "-" if best is None else name_of(best.rival)])
    return _table(header, made, range(1, 8))


def _spread(ratios: Sequence[float]) -> str:
    if not ratios:
        return ""
    low, middle, high = min(ratios), float(np.median(ratios)), max(ratios)
    if len(ratios) == 1:
        return f", {_percent(low)} above the fastest motion"
    return f", {_percent(low)} to {_percent(high)} above the fastest motion (median {_percent(middle)})"


def _percent(ratio: float | None) -> str:
    if ratio is None:
        return "-"
    above = 100.0 * (ratio - 1.0)
    return f"{above:.0f} %" if above >= 10.0 else f"{above:.2g} %"


def _joined(words: Any) -> str:
    *most, last = list(words)
    return f"{', '.join(most)} and {last}" if most else last


def _table(header: Sequence[str], rows: Sequence[Sequence[str]], right: Any) -> str:
    rule = ["---:" if index in right else "---" for index in range(len(header))]
    return "\n".join(f"| {' | '.join(row)} |" for row in (header, rule, *rows))


def write(data: dict[str, Any]) -> None:
    """Keep the rows of a run, and write its section into the page.

    Parameters
    ----------
    data : dict
        What ``timebound rivals --json`` has written.
    """
    rows = ",\n".join(
        json.dumps(
            {key: value for key, value in row.items() if value is not None and value is not False},
            ensure_ascii=False,
        )
        for row in data["rows"]
    )
    machine = json.dumps(data["machine"])
    ROWS.write_text(f'{{"machine": {machine}, "rows": [\n{rows}\n]}}\n', "utf-8")
    before, _, rest = PAGE.read_text("utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    PAGE.write_text(f"{before}{BEGIN}\n{section(*stored())}\n\n{END}{after}", "utf-8")


if __name__ == "__main__":
    write(json.loads(Path(sys.argv[1]).read_text("utf-8")))
