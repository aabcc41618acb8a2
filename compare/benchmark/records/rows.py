"""One row per run, one type from grading to the report: its columns, and their text in ``rows.csv``.

The columns are the fields of `Row`, in their order. Reading is strict: each cell is parsed to the type
of its column, and a cell that does not fit is named in the error.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, fields, replace
from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, get_type_hints

import numpy as np

from compare.benchmark.protocol import Coordinates, Track, variant
from compare.benchmark.records.cells import cell_text, parser_of
from formulations import InputError
from formulations.problem.arrays import Array

TIMING_COLUMNS = ("seconds_algorithm", "seconds_objective")
"""Columns that differ when the same run is repeated: they hold measured times."""


class RowStatus(StrEnum):
    """How a run ended. ``Row.note`` holds the reason.

    The driver's own statuses stand first (`metaheuristics.Status`), then those of grading, then that
    of a stored row which its own durations contradict.
    """

    ok = "ok"
    stopped_early = "stopped-early"
    over_budget = "over-budget"
    raised = "raised"
    exited = "exited"
    timed_out = "timed-out"
    bad_message = "bad-message"
    wrong_shape = "wrong-shape"
    out_of_box = "out-of-box"
    not_finite = "not-finite"
    changed_input = "changed-input"
    false_fitness = "false-fitness"
    global_random = "global-random"
    no_feasible_point = "no-feasible-point"
    nothing_moves = "nothing-moves"
    breaks_position_limits = "breaks-position-limits"
    check_failed = "check-failed"
    contradicted = "contradicted"


class BoundProof(StrEnum):
    """What stands behind the time that a gap is measured against."""

    certified = "certified"
    local_optimum = "local optimum"
    none = "none"


class RunKey(NamedTuple):
    """What tells one run of a comparison from another."""

    case: str
    coding: str
    swarm: str
    seed: int
    budget: int
    population: int
    track: Track = Track.equal
    coordinates: Coordinates = Coordinates.printed


@dataclass(frozen=True, slots=True)
class Row:
    """One graded run: what was run, what the swarm claims, what the check verified, what made it.

    Attributes
    ----------
    library : str
        Versions of the library that the swarm comes from; empty for this package's own swarms.
    parameters : str
        Parameters of the swarm as JSON.
    code : str
        Digest of the source code of swarm, driver and coding; empty if it cannot be read.
    claimed : float or None [s]
        Time of the motion as the coding gives it, None if nothing was found.
    keeps_limits : bool or None
        Whether that motion keeps its limits.
    stretch : float or None
        Least factor on its durations that keeps the velocity, acceleration and jerk limits.
    seconds : float or None [s]
        Time of the verified motion, None if there is none.
    bound : float or None [s]
        The time that gaps are measured against; ``proof`` says what stands behind it.
    gap, claimed_gap : float or None
        ``seconds / bound - 1`` and ``claimed / bound - 1``.
    budget : int
        Evaluations over the whole motion; ``evaluations`` counts those made.
    durations : tuple of float, n_segments [s]
        Durations of the verified motion, or of the one that the check refused; empty if none.
    worst : str
        Where the claimed motion breaks a limit most; empty if it keeps them.
    note : str
        Reason of the status.
    isolated : bool
        Whether the swarm ran in a process of its own, for at most ``time_limit`` [s].
    seconds_algorithm, seconds_objective : float [s]
        Time spent in the swarm and in its objective.
    problem : str
        Digest of waypoints, limits and family.
    """

    case: str
    family: str
    coding: str
    swarm: str
    library: str
    parameters: str
    code: str
    seed: int
    status: RowStatus
    claimed: float | None
    keeps_limits: bool | None
    stretch: float | None
    seconds: float | None
    bound: float | None
    proof: BoundProof
    gap: float | None
    claimed_gap: float | None
    budget: int
    population: int
    track: Track
    coordinates: Coordinates
    evaluations: int
    durations: tuple[float, ...]
    worst: str
    note: str
    isolated: bool
    time_limit: float | None
    seconds_algorithm: float
    seconds_objective: float
    problem: str
    versions: str
    machine: str

    @property
    def key(self) -> RunKey:
        """The run that the row belongs to."""
        return RunKey(
            self.case,
            self.coding,
            self.swarm,
            self.seed,
            self.budget,
            self.population,
            self.track,
            self.coordinates,
        )

    @property
    def variant(self) -> str:
        """Its coding, with track and coordinates where they are not the usual ones."""
        return variant(self.coding, self.track, self.coordinates)

    def measured_against(self, bound: float | None, proof: BoundProof) -> Row:
        """Return the same row with its gaps measured against another time.

        Parameters
        ----------
        bound : float or None [s]
        proof : BoundProof
            What stands behind it.

        Returns
        -------
        Row
        """
        return replace(
            self,
            bound=bound,
            proof=proof,
            gap=relative_gap(self.seconds, bound),
            claimed_gap=relative_gap(self.claimed, bound),
        )

    def to_json(self) -> dict[str, Any]:
        """Plain numbers and text, ready for ``json.dumps``."""
        return asdict(self)

    def to_cells(self) -> list[str]:
        """The text of every column."""
        return [cell_text(getattr(self, name)) for name in COLUMNS]

    @staticmethod
    def from_cells(cells: Mapping[str, str]) -> Row:
        """Parse the text of every column.

        Parameters
        ----------
        cells : mapping of str to str
            Text by column.

        Returns
        -------
        Row

        Raises
        ------
        ValueError
            If a cell does not fit its column; the message names the column.
        """
        values = {}
        for name, parse in _parsers().items():
            try:
                values[name] = parse(cells[name])
            except ValueError as error:
                raise ValueError(f"{name}: {error}") from None
        return Row(**values)


COLUMNS: tuple[str, ...] = tuple(field.name for field in fields(Row))


def relative_gap(seconds: float | None, bound: float | None) -> float | None:
    """Return ``seconds / bound - 1``, None if either is missing.

    Parameters
    ----------
    seconds, bound : float or None [s]

    Returns
    -------
    float or None
    """
    if seconds is None or not bound:
        return None
    return seconds / bound - 1.0


def durations_of(row: Row) -> Array:
    """Return the durations of a row's motion as an array.

    Parameters
    ----------
    row : Row

    Returns
    -------
    Array, shape (n_segments,) [s]
        Empty if the row has no motion.
    """
    return np.array(row.durations, dtype=np.float64)


def csv_text(rows: Iterable[Row], *, header: bool = True) -> str:
    """Return rows as the text of a CSV table.

    Parameters
    ----------
    rows : iterable of Row
    header : bool
        Whether the line of column names comes first.

    Returns
    -------
    str
        Whole lines.
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    if header:
        writer.writerow(COLUMNS)
    writer.writerows(row.to_cells() for row in rows)
    return buffer.getvalue()


def read_csv(path: Path) -> list[Row]:
    """Read every whole line of a table of rows. A last line that was cut short is left out.

    Parameters
    ----------
    path : Path
        A file that need not exist.

    Returns
    -------
    list of Row
        Empty if there is no such file.

    Raises
    ------
    InputError
        If the file is another table, or a line does not fit; the message names the line.
    """
    try:
        text = path.read_text("utf-8")
    except FileNotFoundError:
        return []
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    whole = text[: text.rfind("\n") + 1]
    found = []
    try:
        lines = csv.reader(io.StringIO(whole), strict=True)
        if next(lines, None) != list(COLUMNS):
            raise InputError(f"{path}: not a table of this version of timebound")
        for cells in lines:
            if len(cells) != len(COLUMNS):
                raise InputError(
                    f"{path}: line {lines.line_num} has {len(cells)} columns, not {len(COLUMNS)}"
                )
            try:
                found.append(Row.from_cells(dict(zip(COLUMNS, cells, strict=True))))
            except ValueError as error:
                raise InputError(f"{path}: line {lines.line_num}: {error}") from None
    except csv.Error as error:
        raise InputError(f"{path}: line {lines.line_num}: {error}") from None
    return found


@cache
def _parsers() -> dict[str, Callable[[str], Any]]:
    """The parser of each column, by the type of its field."""
    return {name: parser_of(kind) for name, kind in get_type_hints(Row).items()}
