"""``timebound rivals``: the fastest motion beside other programs, on the same tasks."""

from __future__ import annotations

import sys
from typing import Annotated

from cyclopts import Parameter

from compare.commands import DONE, INTERRUPTED
from compare.commands.options import Json, listed, positive, writable
from compare.files import write_text
from compare.interrupts import ctrl_c_stops
from compare.rivals import RIVALS
from compare.rivals import rows as running
from compare.rivals.shown import as_json, as_page, as_text
from compare.screen import show, stages
from compare.studies.free_form_study import random_problems
from formulations import CASES, Problem, load

_GIGA = 1_000_000_000


def rivals(
    *files: Annotated[
        str, Parameter(name="FILE", help="Problem files or shipped cases; all cases if left out.")
    ],
    rivals: Annotated[
        tuple[str, ...] | None,
        listed(lambda: RIVALS, "The programs to run; all if left out.", "--rivals"),
    ] = None,
    random: Annotated[int | None, Parameter(metavar="COUNT", validator=positive)] = None,
    time_limit: Annotated[float, Parameter(metavar="SECONDS", validator=positive)] = 20.0,
    memory: Annotated[float, Parameter(metavar="GB", validator=positive)] = 4.0,
    page: Annotated[str | None, Parameter(metavar="FILE", validator=writable)] = None,
    json: Json = None,
) -> int:
    """Run other programs on the same tasks, and judge every motion by the same check.

    Each runs in a process of its own; one that is missing, crashes or hangs has a row that says so. Ctrl-C
    ends the run and keeps the rows that are finished.

    Parameters
    ----------
    random
        So many random problems of two real arms too.
    time_limit
        Seconds of each program on each task.
    memory
        GB that each program may hold (on Linux).
    page
        Write a page with charts to this file.
    """
    tasks: list[Problem] = [load(file) for file in files]
    if not files and random is None:
        tasks = [load(name) for name in CASES]
    tasks += random_problems(random or 0, 0)
    found: list[running.RivalRow] = []
    with ctrl_c_stops() as stop, stages("rivals") as stage:
        for row in running.rows(
            tasks,
            [RIVALS[key] for key in rivals or RIVALS],
            seconds=time_limit,
            memory=int(memory * _GIGA),
            stop=stop,
            stage=stage,
        ):
            found.append(row)
            print(f"{row.problem}: {row.rival}: {row.status}", file=sys.stderr, flush=True)
        interrupted = stop()
    show(as_text(found), as_json(found, time_limit), json)
    if page is not None:
        write_text(page, as_page(found, time_limit))
    return INTERRUPTED if interrupted else DONE
