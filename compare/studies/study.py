"""What every study has in common: a record that declares it, and one runner.

A study is a function of plain arguments that gives rows, called many times, and what is told of all
rows: a summary, a text, a picture. The runner keeps the rows of each call as it ends, so that an
interrupted study can be resumed, and writes at the end

    DIR/NAME.csv           a line per row
    DIR/NAME.json          the summary, the machine and the versions
    DIR/figures/NAME.svg   the picture, as .png too
    DIR/studies/NAME.jsonl a line per finished call, for --resume
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any, ClassVar, Generic, Protocol, TypedDict, TypeVar, get_type_hints

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.benchmark.records.provenance import machine, problem_digest, versions_text
from compare.engines import Engine, each
from compare.files import write_json, write_text
from compare.plain_data import parse_json, typed, whole_lines
from compare.screen import bar
from compare.sources import source_digest
from formulations import InputError, Problem, family_optimum


class IsDataclass(Protocol):
    """A row: any dataclass whose fields are text, numbers, booleans or None."""

    __dataclass_fields__: ClassVar[dict[str, Any]]


R = TypeVar("R", bound=IsDataclass)
Call = tuple[Any, ...]

# studies that the report shows if they are there: title, what the picture says
STUDIES = {
    "proofs": (
        "What a proof costs",
        "Random problems, proved one by one (<code>timebound proofs</code>).",
    ),
    "zones": (
        "What a zone at each inner waypoint saves",
        "Seconds that each arm saves if it may pass its inner waypoints within a zone, each joint by the same"
        " angle, against the motion through the waypoints themselves. Bars: what is proved.",
    ),
    "bias": (
        "Who is drawn to zero",
        "How much worse each swarm does when the optimum is moved away from x = 0, or the coordinates"
        " are: median error there over median error here; 1 is unbiased"
        " (<code>timebound bias</code>).",
    ),
    "table8": (
        "Table 8 of Wang 2025, run again",
        "Joint 1 of the SR4C alone, 50 particles, 50 iterations: every run, the printed values, and the"
        " certified bound that none can beat (<code>timebound table8</code>).",
    ),
    "ablation": (
        "The ablation of Wang 2025, run again",
        "Factor by which the mean best fitness grows without one strategy, beside the printed one"
        " (<code>timebound ablation</code>).",
    ),
    "readings": (
        "As printed, and as it can be meant",
        "Gap in the stretched coding for each reading of what a paper leaves open"
        " (<code>timebound readings</code>).",
    ),
}


@dataclass(frozen=True)
class Study(Generic[R]):
    """The declaration of a study.

    Parameters
    ----------
    name : str
        Name of its files.
    row : type
        The dataclass of its rows.
    compute : Callable
        Gives the rows of one call; it runs in a worker process, so it and its arguments are picklable.
    summarise : Callable
        All rows -> plain data, ready for strict JSON.
    text : Callable
        Rows and summary -> what is printed.
    figure : Callable, optional
        Rows and summary -> the picture.
    complete : Callable, optional
        All rows -> all rows, with what only all of them together tell.
    """

    name: str
    row: type[R]
    compute: Callable[..., Iterable[R]]
    summarise: Callable[[list[R]], Any]
    text: Callable[[list[R], Any], str]
    figure: Callable[[list[R], Any], Figure] | None = None
    complete: Callable[[list[R]], list[R]] | None = None


@dataclass(frozen=True)
class Findings(Generic[R]):
    """What a study found."""

    study: Study[R]
    rows: list[R]
    summary: Any

    def as_text(self) -> str:
        """Tables of the summary, then the machine and the versions."""
        return f"{self.study.text(self.rows, self.summary)}\n{machine()}. {versions_text()}"

    def to_json(self) -> dict[str, Any]:
        """Plain data, ready for strict JSON; a number that is not finite is None."""
        rows = [{name: _finite(value) for name, value in asdict(row).items()} for row in self.rows]
        return {"study": self.study.name, **_facts(self.summary), "rows": rows}


def run(
    study: Study[R],
    calls: Sequence[Call],
    *,
    folder: Path | None = None,
    pool: Engine | None = None,
    resume: bool = False,
) -> Findings[R]:
    """Compute all rows of a study, and write its files.

    Parameters
    ----------
    study : Study
        What is computed and told.
    calls : sequence of tuples
        The arguments of each call of ``study.compute``.
    folder : Path, optional
        Where the files go; nothing is written if left out.
    pool : Engine, optional
        The workers; if left out, the calls run one after the other in this process, as a measurement
        of time needs it.
    resume : bool
        Keep the calls that an earlier run in this folder has finished, where arguments, versions and
        code are the same.

    Returns
    -------
    Findings
        Rows and summary.
    """
    keys = [_key(study, call) for call in calls]
    kept = _kept(study, folder) if folder is not None else None
    found = _finished(study, kept, set(keys)) if kept is not None and resume else {}
    if kept is not None:
        kept.parent.mkdir(parents=True, exist_ok=True)
        write_text(kept, "".join(_line(key, rows) for key, rows in found.items()))
    left = [index for index, key in enumerate(keys) if key not in found]
    for index, rows in _answers(study, [(i, *calls[i]) for i in left], pool):
        found[keys[index]] = rows
        if kept is not None:
            with kept.open("a", encoding="utf-8") as lines:
                lines.write(_line(keys[index], rows))
    findings = _findings(study, keys, found)
    if folder is not None:
        _write(study, findings.rows, findings.summary, folder)
    return findings


def finished(study: Study[R], calls: Sequence[Call], folder: Path) -> Findings[R]:
    """Read what interrupted runs of a study have finished.

    Parameters
    ----------
    study : Study
        What is computed and told.
    calls : sequence of tuples
        The arguments of each call of ``study.compute``.
    folder : Path
        Where its files are.

    Returns
    -------
    Findings
        Of the calls that are finished, with the same arguments, versions and code.
    """
    keys = [_key(study, call) for call in calls]
    return _findings(study, keys, _finished(study, _kept(study, folder), set(keys)))


def _findings(study: Study[R], keys: Sequence[str], found: dict[str, list[R]]) -> Findings[R]:
    """All rows in the order of the calls, with their summary."""
    rows = [row for key in keys if key in found for row in found[key]]
    if study.complete is not None:
        rows = study.complete(rows)
    return Findings(study, rows, study.summarise(rows))


def _kept(study: Study[Any], folder: Path) -> Path:
    return folder / "studies" / f"{study.name}.jsonl"


def optima_of(problems: dict[str, Problem]) -> dict[str, float]:
    """Find the optimum of each problem's family, under a progress bar.

    Parameters
    ----------
    problems : dict
        Problems by name.

    Returns
    -------
    dict
        Times by name [s].
    """
    found = {}
    with bar("optima", len(problems)) as advance:
        for name, problem in problems.items():
            found[name] = family_optimum(problem).seconds
            advance()
    return found


def median_and_largest(values: list[float]) -> tuple[float, float]:
    """Sum a quantity of many rows up.

    Parameters
    ----------
    values : list of float
        At least one.

    Returns
    -------
    (float, float)
    """
    return float(np.median(values)), max(values)


def _answers(
    study: Study[R], calls: Sequence[Call], pool: Engine | None
) -> Iterator[tuple[int, list[R]]]:
    """Rows by the number of their call, as the calls end."""
    if pool is not None:
        yield from each(pool, study.name, _numbered, [(study.compute, *call) for call in calls])
        return
    with bar(study.name, len(calls)) as advance:
        for call in calls:
            yield _numbered(study.compute, *call)
            advance()


def _numbered(compute: Callable[..., Iterable[R]], index: int, *call: Any) -> tuple[int, list[R]]:
    return index, list(compute(*call))


def _write(study: Study[R], rows: list[R], summary: Any, folder: Path) -> None:
    lines = io.StringIO()
    writer = csv.DictWriter(lines, [field.name for field in fields(study.row)], lineterminator="\n")
    writer.writeheader()
    writer.writerows(asdict(row) for row in rows)
    write_text(folder / f"{study.name}.csv", lines.getvalue())
    write_json(folder / f"{study.name}.json", _facts(summary))
    if study.figure is None:
        return
    mpl.use("Agg")
    figure = study.figure(rows, summary)
    (folder / "figures").mkdir(exist_ok=True)
    figure.savefig(folder / "figures" / f"{study.name}.svg", metadata={"Date": None})
    figure.savefig(folder / "figures" / f"{study.name}.png")
    plt.close(figure)


def _facts(summary: Any) -> dict[str, Any]:
    return {"summary": summary, "machine": machine(), "versions": versions_text()}


def _key(study: Study[Any], call: Call) -> str:
    """What tells a call from another, with the versions and the code that it ran with."""
    text = "\n".join([*map(_plain, (study.compute, *call)), versions_text(), source_digest()])
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _plain(part: Any) -> str:
    if isinstance(part, Problem):
        return f"{part.name} {problem_digest(part)}"
    return f"{part.__module__}.{part.__qualname__}" if callable(part) else repr(part)


def _line(key: str, rows: Iterable[Any]) -> str:
    plain = [{name: _stored(value) for name, value in asdict(row).items()} for row in rows]
    return json.dumps({"call": key, "rows": plain}, allow_nan=False, default=_number) + "\n"


def _number(value: Any) -> Any:
    return value.item()  # a scalar of NumPy


def _stored(value: Any) -> Any:
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _finished(study: Study[R], path: Path, wanted: set[str]) -> dict[str, list[R]]:
    """The wanted calls among those on disk; a last line cut short is passed over."""
    found = {}
    for number, line in whole_lines(path):
        where = f"{path}: line {number}: holds no rows of {study.name}"
        entry = parse_json(line, _Line, where)
        if entry["call"] in wanted:
            try:
                found[entry["call"]] = [_row(study.row, row) for row in entry["rows"]]
            except ValueError as error:
                raise InputError(f"{where}: {error}") from None
    return found


class _Line(TypedDict):
    """What a finished call left."""

    call: str
    rows: list[dict[str, Any]]


def _row(kind: type[R], stored: dict[str, Any]) -> R:
    """One row; text stands for a number that is not finite, where a number is expected."""
    kinds = get_type_hints(kind)
    odd = {
        name: float(value)
        for name, value in stored.items()
        if isinstance(value, str) and kinds.get(name) in (float, float | None)
    }
    found: R = typed(kind, stored | dict.fromkeys(odd, 0.0))
    return replace(found, **odd)
