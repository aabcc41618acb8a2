"""Results on disk: a row and its traces are written as each run ends, and read back from there.

rows.csv     one line per run; lines are appended whole, so a killed run leaves a readable file
traces.jsonl one line per run: best fitness against evaluations
ladders/     one JSON per case
honest/      one JSON per case: what its paper should have found
papers/KEY/audit.json  the audit of a paper and of its variants
settings.json  what was asked for
"""

from __future__ import annotations

import csv
import io
import json
import os
from dataclasses import asdict
from pathlib import Path
from typing import Any

from compare.benchmark.grade import Graded, Run, Trace
from compare.commands import shared as commands
from formulations import InputError

COLUMNS: dict[str, type] = {
    "case": str,
    "family": str,
    "coding": str,
    "swarm": str,
    "library": str,
    "seed": int,
    "status": str,
    "claimed": float,
    "keeps_limits": bool,
    "stretch": float,
    "seconds": float,
    "bound": float,
    "proof": str,
    "gap": float,
    "claimed_gap": float,
    "budget": int,
    "population": int,
    "evaluations": int,
    "durations": str,
    "worst": str,
    "note": str,
    "seconds_algorithm": float,
    "seconds_objective": float,
    "problem": str,
    "versions": str,
    "machine": str,
}
TIMES = ("seconds_algorithm", "seconds_objective")  # the columns that no seed repeats


class Store:
    """The results of one comparison in one folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.rows_file = folder / "rows.csv"
        self.traces_file = folder / "traces.jsonl"

    def clear(self) -> None:
        """Start afresh: a header and nothing else."""
        commands.write_text(self.rows_file, _line(list(COLUMNS)))
        commands.write_text(self.traces_file, "")
        for pattern in ("ladders/*.json", "honest/*.json", "papers/*/audit.json"):
            for old in self.folder.glob(pattern):
                old.unlink()

    def mend(self) -> None:
        """Drop a last line that was cut short. Each file is replaced whole, in one step."""
        rows, traces = self.rows(), self.traces()
        lines = [_line([_text(row[column]) for column in COLUMNS]) for row in rows]
        commands.write_text(self.rows_file, _line(list(COLUMNS)) + "".join(lines))
        trace_lines = [_trace_line(run_key, found) for run_key, found in traces.items()]
        commands.write_text(self.traces_file, "".join(trace_lines))

    def add(self, graded: Graded, facts: dict[str, str]) -> None:
        """Write one finished run; its traces first, so that every row has them."""
        _append(self.traces_file, _trace_line(graded.run.key, graded.traces))
        row = {**graded.row, **facts}
        _append(self.rows_file, _line([_text(row[column]) for column in COLUMNS]))

    def sort(self, order: list[Run]) -> None:
        """Rewrite the rows in the order of the runs, whatever order they ended in."""
        place = {run.key: i for i, run in enumerate(order)}
        rows = sorted(self.rows(), key=lambda row: place.get(key_of(row), len(place)))
        lines = [_line([_text(row[column]) for column in COLUMNS]) for row in rows]
        commands.write_text(self.rows_file, _line(list(COLUMNS)) + "".join(lines))

    def rows(self) -> list[dict[str, Any]]:
        """Every whole row that was written; a last line cut short is passed over."""
        try:
            text = self.rows_file.read_text("utf-8")
        except FileNotFoundError:
            return []
        whole = text[: text.rfind("\n") + 1]
        reader = csv.reader(io.StringIO(whole))
        header = next(reader, None)
        if header != list(COLUMNS):
            raise InputError(f"{self.rows_file}: not a table of this version of timebound")
        found = []
        for number, line in enumerate(reader, start=2):
            if len(line) != len(COLUMNS):
                raise InputError(f"{self.rows_file}: line {number} has {len(line)} columns")
            try:
                found.append(
                    {
                        name: _value(kind, cell)
                        for (name, kind), cell in zip(COLUMNS.items(), line, strict=True)
                    }
                )
            except ValueError as error:
                raise InputError(f"{self.rows_file}: line {number}: {error}") from None
        return found

    def traces(self) -> dict[tuple[Any, ...], list[Trace]]:
        """Traces by run key."""
        try:
            text = self.traces_file.read_text("utf-8")
        except FileNotFoundError:
            return {}
        found = {}
        for line in text[: text.rfind("\n") + 1].splitlines():
            try:
                entry = json.loads(line)
                found[tuple(entry["run"])] = [
                    Trace(t["joint"], t["evaluations"], [_infinite(b) for b in t["best"]])
                    for t in entry["traces"]
                ]
            except (ValueError, KeyError, TypeError) as error:
                raise InputError(f"{self.traces_file}: not a trace: {error}") from None
        return found

    def write_settings(self, settings: dict[str, Any]) -> None:
        """Keep what was asked for."""
        commands.write_json(self.folder / "settings.json", settings)

    def settings(self) -> dict[str, Any]:
        """What was asked for. Raises InputError if the folder holds no comparison."""
        try:
            found = json.loads((self.folder / "settings.json").read_text("utf-8"))
            known = {"size": str, "cases": list, "seeds": int, "budget": str}
            if {name: type(found[name]) for name in known} != known:
                raise ValueError("unexpected entries")
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise InputError(f"{self.folder}: holds no comparison: {error}") from None
        return dict(found)

    def write_ladder(self, case: str, ladder: dict[str, Any]) -> None:
        """Keep the ladder of a case."""
        self._write(f"ladders/{case}.json", ladder)

    def ladders(self) -> dict[str, dict[str, Any]]:
        """Ladders by case name, in alphabetical order."""
        return {path.stem: _read(path) for path in sorted(self.folder.glob("ladders/*.json"))}

    def write_honest(self, case: str, lines: list[dict[str, Any]]) -> None:
        """Keep the honest table of a case."""
        self._write(f"honest/{case}.json", lines)

    def honest(self) -> dict[str, list[dict[str, Any]]]:
        """Lines of the honest tables by case name."""
        return {path.stem: _read(path) for path in sorted(self.folder.glob("honest/*.json"))}

    def write_audit(self, paper: str, facts: dict[str, str], audits: list[dict[str, Any]]) -> None:
        """Keep the audits of a paper and its variants. facts: what they were made of and by."""
        self._write(f"papers/{paper}/audit.json", {**facts, "audits": audits})

    def audits(self) -> dict[str, dict[str, Any]]:
        """By paper: facts and ``audits``, a list."""
        return {
            path.parent.name: _read(path) for path in sorted(self.folder.glob("papers/*/audit.json"))
        }

    def _write(self, name: str, data: Any) -> None:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        commands.write_json(path, data)


def key_of(row: dict[str, Any]) -> tuple[Any, ...]:
    """The run key of a row."""
    return tuple(row[name] for name in ("case", "coding", "swarm", "seed", "budget", "population"))


def _read(path: Path) -> Any:
    """JSON of a file. Raises InputError if it holds none."""
    try:
        return json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None


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


def _trace_line(key: tuple[Any, ...], traces: list[Trace]) -> str:
    plain = []
    for trace in traces:
        entry = asdict(trace)
        entry["best"] = [b if b < float("inf") else None for b in trace.best]
        plain.append(entry)
    return json.dumps({"run": list(key), "traces": plain}, allow_nan=False) + "\n"


def _infinite(value: float | None) -> float:
    return float("inf") if value is None else float(value)


def _line(cells: list[str]) -> str:
    buffer = io.StringIO()
    csv.writer(buffer, lineterminator="\n").writerow(cells)
    return buffer.getvalue()


def _text(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return repr(value) if isinstance(value, float) else str(value).replace("\n", " ")


def _value(kind: type, cell: str) -> Any:
    if kind is str:
        return cell
    if cell == "":
        return None
    if kind is bool:
        if cell not in ("yes", "no"):
            raise ValueError(f"{cell!r} is neither yes nor no")
        return cell == "yes"
    return kind(cell)
