"""Files of a comparison read back, each entry by its type: a person may have changed them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any, TypedDict

from compare.audit.judged import JudgedTimes
from compare.benchmark.grade import Trace
from compare.benchmark.known_times import KnownTime
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import RunKey
from compare.plain_data import parse_json, read_json, read_text, typed
from formulations import InputError

_LARGEST_TRACES = 2_000_000_000  # bytes


@dataclass(frozen=True, slots=True)
class Settings:
    """What was asked for: size (default, quick or full), cases, number of seeds, budget in words."""

    size: str
    cases: tuple[str, ...]
    seeds: int
    budget: str


class _OneTrace(TypedDict):
    joint: int
    evaluations: list[int]
    best: list[float | None]  # None: nothing feasible so far, for JSON has no infinity


class _TraceLine(TypedDict):
    run: RunKey
    traces: list[_OneTrace]


class _Finding(TypedDict):
    kind: str
    meaning: str
    fault: bool
    proved: bool
    where: str
    text: str


class _Audit(TypedDict):
    paper: str
    title: str
    source: str
    notes: str
    unit: str
    motions: list[dict[str, Any]]
    findings: list[_Finding]


class _AuditFile(TypedDict):
    digest: str
    versions: str
    machine: str
    audits: list[_Audit]


def read_settings(path: Path) -> Settings:
    """Read what was asked for.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    Settings
        Size, cases, seeds and budget.

    Raises
    ------
    InputError
        It is no such file; one line that names the entry.
    """
    found: Settings = read_json(path, Settings, "the settings of a comparison")
    return found


def read_ladder(path: Path) -> LadderRecord:
    """Read the bounds of a case.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    LadderRecord
        Plain data.

    Raises
    ------
    InputError
        It is no such file; one line that names the entry.
    """
    found: LadderRecord = read_json(path, LadderRecord, "a ladder")
    return found


def read_known_times(path: Path) -> list[KnownTime]:
    """Read what is known of the task of a case.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    list of KnownTime
        The lines of the table.

    Raises
    ------
    InputError
        It is no such file; one line that names the entry.
    """
    found: list[KnownTime] = read_json(path, list[KnownTime], "a table of known times")
    return found


def read_audits(path: Path) -> dict[str, Any]:
    """Read the audits of a paper and of its variants.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    dict
        ``audits``, and what they were made of.

    Raises
    ------
    InputError
        It is no such file; one line that names the entry.
    """
    found: dict[str, Any] = read_json(path, _AuditFile, "the audits of a paper")
    try:
        for index, audit in enumerate(found["audits"]):
            typed(list[JudgedTimes], audit["motions"], f"audits[{index}].motions")
    except ValueError as error:
        raise InputError(f"{path}: not the audits of a paper: {error}") from None
    return found


def read_traces(path: Path) -> dict[RunKey, list[Trace]]:
    """Read the traces of all runs.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    dict of RunKey to list of Trace
        By run; a last line that was cut short is left out.

    Raises
    ------
    InputError
        It is no such file; one line that names the entry.
    """
    found = {}
    for number, line in whole_lines(path):
        entry = parse_json(line, _TraceLine, f"{path}: line {number}: not a trace")
        found[entry["run"]] = [
            Trace(t["joint"], t["evaluations"], [float("inf") if b is None else b for b in t["best"]])
            for t in entry["traces"]
        ]
    return found


def whole_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Read the lines of a file to which lines are appended; a last one that was cut short is left out.

    Parameters
    ----------
    path : Path
        A file that need not exist.

    Yields
    ------
    tuple of int and str
        Number of the line, from 1, and its text.

    Raises
    ------
    InputError
        It cannot be read.
    """
    if not path.exists() or not path.stat().st_size:
        return
    text = read_text(path, largest=_LARGEST_TRACES)
    start = 0
    for number in count(1):
        end = text.find("\n", start)
        if end < 0:
            return
        yield number, text[start:end]
        start = end + 1
