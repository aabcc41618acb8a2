"""``timebound rivals``: the fastest motion beside other programs, on the same tasks."""

from __future__ import annotations

import sys
from typing import Annotated

from cyclopts import Parameter

from compare.commands import DONE, INTERRUPTED
from compare.commands.options import Json, Resume, listed, positive, writable
from compare.files import output_folder, write_text
from compare.rivals import RIVALS
from compare.rivals import run_study as study
from compare.rivals.shown import as_page
from compare.screen import show
from compare.studies.free_form_study import random_problems
from compare.studies.study import finished, run
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
    tolerance: Annotated[float, Parameter(metavar="RAD", validator=positive)] = 0.1,
    time_limit: Annotated[float, Parameter(metavar="SECONDS", validator=positive)] = 20.0,
    memory: Annotated[float, Parameter(metavar="GB", validator=positive)] = 4.0,
    page: Annotated[str | None, Parameter(metavar="FILE", validator=writable)] = None,
    out: Annotated[str, Parameter(metavar="DIR")] = "report",
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Run other programs on the same tasks, and judge every motion by the same check.

    Each runs in a process of its own; one that is missing, crashes or hangs is said to. Ctrl-C ends the run
    and shows the rows that are finished; --resume goes on from there. A program that knows no zones is given
    the points of a task with zones: its motion passes them exactly, which is valid there too, and is marked.
    --json, --page and DIR/rivals.csv have more columns than the terminal.

    Parameters
    ----------
    random
        So many random problems of two real arms (panda, xarm6) too; without FILE, these alone.
    tolerance
        Where a program that blends corners is run, each task is given once more, with zones of this size at
        its inner waypoints: how far each joint may pass them [rad].
    time_limit
        Seconds that each program has for each task.
    memory
        GB that each program may hold (on Linux).
    page
        Write a page with charts to this file.
    out
        Folder for the rows.
    """
    tasks: list[Problem] = [load(file) for file in files]
    if not files and random is None:
        tasks = [load(name) for name in CASES]
    tasks += random_problems(random or 0, 0)
    listed_calls = study.calls(
        tasks,
        list(rivals or RIVALS),
        zone=tolerance,
        seconds=time_limit,
        memory=int(memory * _GIGA),
    )
    folder, code = output_folder(out), DONE
    try:
        found = run(study.STUDY, listed_calls, folder=folder, resume=resume)
    except KeyboardInterrupt:
        found, code = finished(study.STUDY, listed_calls, folder), INTERRUPTED
        rows = study.count_rows(listed_calls)
        left = rows - len(found.rows)
        print(f"interrupted: {left} of {rows} rows are left for --resume", file=sys.stderr)
    show(found.as_text(), found.to_json(), json)
    if page is not None:
        write_text(page, as_page(found.rows, found.summary))
    return code
