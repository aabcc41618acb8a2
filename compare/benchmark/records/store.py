"""The results of one comparison on disk: written as each run ends, read back by whoever needs them.

rows.csv               one line per run; lines are appended whole, so a killed run leaves whole rows
traces.jsonl           one line per run: best fitness against evaluations
rows-set-aside.csv     rows that ``--resume`` could not use
ladders/CASE.json      every bound of a case
known_times/CASE.json  what a case's paper printed, beside all that is known of its task
papers/KEY/audit.json  the audit of a paper and of its variants
settings.json          what was asked for
"""

from __future__ import annotations

import json
import os
from collections.abc import Collection, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from compare.benchmark.grade import Graded, Run, Trace
from compare.benchmark.known_times import KnownTime
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row, RunKey, csv_text, read_csv
from compare.benchmark.records.stored import (
    Settings,
    read_audits,
    read_known_times,
    read_ladder,
    read_settings,
    read_traces,
)
from compare.files import write_json, write_text
from formulations import InputError


class Store:
    """The results of one comparison in one folder.

    Parameters
    ----------
    folder : Path
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.rows_file = folder / "rows.csv"
        self.traces_file = folder / "traces.jsonl"
        self.set_aside_file = folder / "rows-set-aside.csv"

    def clear(self) -> None:
        """Start afresh: a table without rows, and nothing of an earlier comparison."""
        self._replace([], {})
        self.set_aside_file.unlink(missing_ok=True)
        for pattern in ("ladders/*.json", "known_times/*.json", "papers/*/audit.json"):
            for old in self.folder.glob(pattern):
                old.unlink()

    def mend(self) -> None:
        """Drop a last line that was cut short. Each file is replaced whole, in one step."""
        self._replace(self.rows(), self.traces())

    def keep(self, rows: Collection[Row]) -> None:
        """Keep these rows and their traces alone; the others go to ``rows-set-aside.csv``.

        Parameters
        ----------
        rows : collection of Row
            Some of the stored rows; their gaps may have been measured again.
        """
        kept = {row.key for row in rows}
        others, seen = [], set()
        for row in self.rows():
            if row.key not in kept or row.key in seen:
                others.append(row)
            seen.add(row.key)
        if others:  # first, so that an interrupt loses none
            aside = [row for row in self.set_aside() if row not in others]
            write_text(self.set_aside_file, csv_text([*aside, *others]))
        self._replace(rows, {key: found for key, found in self.traces().items() if key in kept})

    def add(self, graded: Graded) -> None:
        """Append one finished run; its traces first, so that every row has them.

        Parameters
        ----------
        graded : Graded
        """
        _append(self.traces_file, _trace_line(graded.run.key, graded.traces))
        _append(self.rows_file, csv_text([graded.row], header=False))

    def sort(self, order: list[Run]) -> None:
        """Write the rows again in the order of the runs, whatever order they ended in.

        Parameters
        ----------
        order : list of Run
        """
        place = {run.key: i for i, run in enumerate(order)}
        rows = sorted(self.rows(), key=lambda row: place.get(row.key, len(place)))
        write_text(self.rows_file, csv_text(rows))

    def rows(self) -> list[Row]:
        """Every whole row as it stands in the file; a last line that was cut short is left out."""
        return read_csv(self.rows_file)

    def set_aside(self) -> list[Row]:
        """Rows that an earlier ``--resume`` could not use."""
        return read_csv(self.set_aside_file)

    def traces(self) -> dict[RunKey, list[Trace]]:
        """Traces by run; a last line that was cut short is left out."""
        return read_traces(self.traces_file)

    def write_settings(self, settings: Settings) -> None:
        """Keep what was asked for.

        Parameters
        ----------
        settings : Settings
        """
        write_json(self.folder / "settings.json", asdict(settings))

    def settings(self) -> Settings:
        """What was asked for. Raises InputError if the folder holds no comparison."""
        try:
            return read_settings(self.folder / "settings.json")
        except InputError as error:
            raise InputError(f"{self.folder}: holds no comparison: {error}") from None

    def write_ladder(self, case: str, ladder: LadderRecord) -> None:
        """Keep the bounds of a case.

        Parameters
        ----------
        case : str
        ladder : LadderRecord
        """
        self._write(f"ladders/{case}.json", ladder)

    def ladders(self) -> dict[str, LadderRecord]:
        """Bounds by case, in alphabetical order."""
        paths = sorted(self.folder.glob("ladders/*.json"))
        return {path.stem: read_ladder(path) for path in paths}

    def write_known_times(self, case: str, lines: list[KnownTime]) -> None:
        """Keep what is known of the task of a case.

        Parameters
        ----------
        case : str
        lines : list of KnownTime
        """
        self._write(f"known_times/{case}.json", [asdict(line) for line in lines])

    def known_times(self) -> dict[str, list[KnownTime]]:
        """What is known of the task of each case."""
        paths = sorted(self.folder.glob("known_times/*.json"))
        return {path.stem: read_known_times(path) for path in paths}

    def write_audit(self, paper: str, made_of: Mapping[str, str], audits: list[dict[str, Any]]) -> None:
        """Keep the audits of a paper and its variants.

        Parameters
        ----------
        paper : str
        made_of : mapping of str to str
            Digest of the paper's text, versions and machine.
        audits : list of dict
            As `compare.audit.Audit.to_json` gives them.
        """
        self._write(f"papers/{paper}/audit.json", {**made_of, "audits": audits})

    def audits(self) -> dict[str, dict[str, Any]]:
        """By paper: what its audit was made of, and ``audits``, a list."""
        paths = sorted(self.folder.glob("papers/*/audit.json"))
        return {path.parent.name: read_audits(path) for path in paths}

    def _replace(self, rows: Collection[Row], traces: Mapping[RunKey, list[Trace]]) -> None:
        """Write both files anew, each whole or not at all."""
        lines = [_trace_line(key, found) for key, found in traces.items()]
        write_text(self.rows_file, csv_text(rows))
        write_text(self.traces_file, "".join(lines))

    def _write(self, name: str, data: Any) -> None:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        write_json(path, data)


def _append(path: Path, line: str) -> None:
    """Append one whole line in one write."""
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o644)
        try:
            data = line.encode()
            if os.write(descriptor, data) != len(data):
                raise OSError("no space left on device")
        finally:
            os.close(descriptor)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None


def _trace_line(key: RunKey, traces: list[Trace]) -> str:
    plain = []
    for trace in traces:
        entry = asdict(trace)
        # JSON has no infinity: nothing feasible so far
        entry["best"] = [b if b < float("inf") else None for b in trace.best]
        plain.append(entry)
    return json.dumps({"run": list(key), "traces": plain}, allow_nan=False) + "\n"
