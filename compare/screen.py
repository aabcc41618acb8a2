"""What a person sees: tables, progress, and an answer as text or as JSON.

Progress goes to standard error, and only to a terminal: what is piped holds text alone, without escape
codes, and its tables are as wide as they need to be.
"""

from __future__ import annotations

import io
import json as strict
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from rich.box import Box
from rich.cells import cell_len
from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

_RULED = Box("    \n    \n -- \n    \n    \n    \n    \n    \n")  # one line below the header
_NARROWEST = 16  # columns that the last cell of a row keeps on a narrow terminal
_UNLIMITED = 10_000


def table(header: Sequence[str], rows: Sequence[Sequence[str]], right: Sequence[int] = ()) -> str:
    """Set a plain text table.

    Nothing is cut off. On a terminal that is too narrow, the last column is wrapped.

    Parameters
    ----------
    header : sequence of str
        A title for each column; its line breaks are kept.
    rows : sequence of sequences of str
        The cells; all rows as long as the header.
    right : sequence of int
        Columns that are aligned to the right, counted from 0.

    Returns
    -------
    str
        The lines of the table, without a line break at the end.
    """
    drawn = Table(box=_RULED, show_edge=False, pad_edge=False, padding=(0, 1, 0, 0))
    for index, title in enumerate(header):
        last = index == len(header) - 1
        drawn.add_column(
            Text(title),
            justify="right" if index in right else "left",
            no_wrap=not last,
            overflow="fold",
        )
    for row in rows:
        drawn.add_row(*(Text(cell) for cell in row))
    buffer = io.StringIO()
    screen = Console(file=buffer, width=_width(header, rows), color_system=None, force_terminal=False)
    screen.print(drawn, soft_wrap=False)
    return "\n".join(line.rstrip() for line in buffer.getvalue().splitlines())


def _width(header: Sequence[str], rows: Sequence[Sequence[str]]) -> int:
    """Columns of the terminal if the table can be fitted to them, else as many as it needs."""
    if not sys.stdout.isatty():
        return _UNLIMITED
    widest = [
        max(cell_len(part) for line in (header, *rows) for part in line[i].split("\n"))
        for i in range(len(header))
    ]
    columns = shutil.get_terminal_size().columns
    return columns if sum(widest[:-1]) + 2 * len(header) + _NARROWEST <= columns else _UNLIMITED


def show(text: str, data: Any, json: str | None) -> None:
    """Show an answer: as text, and as JSON where that was asked for.

    Parameters
    ----------
    text : str
        The answer for a person, printed unless ``json`` is ``-``.
    data : Any
        The same as plain data.
    json : str or None
        The option ``--json``, as ``save`` takes it.
    """
    if json != "-":
        print(text)
    save(data, json)


def save(data: Any, json: str | None) -> None:
    """Write an answer as strict JSON where that was asked for.

    Parameters
    ----------
    data : Any
        Plain data.
    json : str or None
        The option ``--json``: a file, or ``-`` for standard output, which then holds nothing else;
        None if it was left out.
    """
    if json == "-":
        print(strict.dumps(data, indent=2, allow_nan=False))
    elif json is not None:
        from compare.files import write_json  # loads the solvers, which a certificate does not need

        write_json(json, data)


@contextmanager
def bar(title: str, total: int) -> Iterator[Callable[[], None]]:
    """Show a progress bar with the time left, on a terminal; one line elsewhere.

    What is printed while it is shown appears above it.

    Parameters
    ----------
    title : str
        What is being done.
    total : int
        The number of steps.

    Yields
    ------
    Callable
        To be called after each step.
    """
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    screen = Console(stderr=True)
    if not screen.is_terminal:
        print(f"{title}: {total}", file=sys.stderr, flush=True)
        yield lambda: None
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=screen, transient=True, redirect_stdout=False) as progress:
        task = progress.add_task(escape(title), total=total)
        yield lambda: progress.advance(task)


@contextmanager
def stages(title: str) -> Iterator[Callable[[str], None]]:
    """Show the stage that a long computation is at, on a terminal; nothing elsewhere.

    Parameters
    ----------
    title : str
        What is being computed.

    Yields
    ------
    Callable
        To be called with the name of each stage as it begins.
    """
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    screen = Console(stderr=True)
    if not screen.is_terminal:
        yield lambda stage: None
        return
    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=screen, transient=True, redirect_stdout=False) as progress:
        task = progress.add_task(escape(title), total=None)
        yield lambda stage: progress.update(task, description=escape(f"{title}: {stage}"))
