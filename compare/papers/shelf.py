"""The store of items: one JSON file each, written whole as soon as the item is made.

DIR/papers/KEY/ITEM.json   full, status, note, seconds, versions, machine, data
"""

from __future__ import annotations

import json
import time
import traceback
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from compare.benchmark.records.provenance import machine, versions_text
from compare.files import write_json
from compare.papers.item import Item
from compare.plain_data import read_json, typed

OK, FAILED, DIED, MISSING = "ok", "failed", "died", "not made"


@dataclass(frozen=True)
class Made:
    """An item as it is stored.

    Attributes
    ----------
    full : bool
        Whether it was made with the paper's own budgets.
    status : str
        ok, failed or died.
    note : str
        Why it is not ok.
    seconds : float [s]
        What it took.
    versions, machine : str
        By what and where it was made.
    data : dict or None
        What ``Item.make`` returned.
    """

    full: bool
    status: str
    note: str
    seconds: float
    versions: str
    machine: str
    data: dict[str, Any] | None


def make(folder: str, paper: str, item: Item, full: bool) -> tuple[str, Item, Made]:
    """Make an item and store it. What it raises becomes its status.

    Parameters
    ----------
    folder : str
        Of the report.
    paper : str
        Case of the paper.
    item : Item
        The table or figure.
    full : bool
        Whether with the paper's own budgets.

    Returns
    -------
    (str, Item, Made)
        Paper, item and the result.
    """
    started = time.perf_counter()
    status, note, data = OK, "", None
    try:
        data = item.make(full)
        json.dumps(data, allow_nan=False)
    except Exception as error:
        status, data = FAILED, None
        place = traceback.extract_tb(error.__traceback__)[-1]
        note = f"{type(error).__name__}: {error} ({Path(place.filename).name}, line {place.lineno})"
    seconds = time.perf_counter() - started
    made = Made(full, status, " ".join(note.split()), seconds, versions_text(), machine(), data)
    keep(Path(folder), paper, item, made)
    return paper, item, made


def died(folder: str, paper: str, item: Item, full: bool) -> Made:
    """Store that the process of an item ended without an answer.

    Parameters
    ----------
    folder : str
        Of the report.
    paper : str
        Case of the paper.
    item : Item
        The table or figure.
    full : bool
        Whether with the paper's own budgets.

    Returns
    -------
    Made
    """
    note = "its process ended without an answer"
    made = Made(full, DIED, note, 0.0, versions_text(), machine(), None)
    keep(Path(folder), paper, item, made)
    return made


def keep(folder: Path, paper: str, item: Item, made: Made) -> None:
    """Write one item.

    Parameters
    ----------
    folder : Path
        Of the report.
    paper : str
        Case of the paper.
    item : Item
        The table or figure.
    made : Made
        What to store.
    """
    path = _path(folder, paper, item)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_json(path, {"label": item.label, **asdict(made)})


def kept(folder: Path, paper: str, item: Item) -> Made | None:
    """Read one item.

    Parameters
    ----------
    folder : Path
        Of the report.
    paper : str
        Case of the paper.
    item : Item
        The table or figure.

    Returns
    -------
    Made or None
        None if nothing is stored, or nothing that can be read.
    """
    try:
        found = read_json(_path(folder, paper, item), dict[str, Any], "an item")
        made: Made = typed(Made, {name: found[name] for name in Made.__annotations__ if name in found})
    except ValueError:  # an InputError too
        return None
    return made


def finished(folder: Path, paper: str, item: Item, full: bool) -> bool:
    """Whether an item is stored already, in this size and by these versions.

    Parameters
    ----------
    folder : Path
        Of the report.
    paper : str
        Case of the paper.
    item : Item
        The table or figure.
    full : bool
        Whether with the paper's own budgets.

    Returns
    -------
    bool
    """
    made = kept(folder, paper, item)
    return made is not None and (made.status, made.full, made.versions) == (OK, full, versions_text())


def forget(folder: Path, paper: str, item: Item) -> None:
    """Drop what is stored of an item.

    Parameters
    ----------
    folder : Path
        Of the report.
    paper : str
        Case of the paper.
    item : Item
        The table or figure.
    """
    _path(folder, paper, item).unlink(missing_ok=True)


def _path(folder: Path, paper: str, item: Item) -> Path:
    return folder / "papers" / paper / f"{item.key}.json"
