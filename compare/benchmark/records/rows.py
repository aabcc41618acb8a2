"""One row per run, one type from grading to the report: its columns, and their text in ``rows.csv``.

The columns are the fields of `Row`, in their order. `compare.benchmark.records.store` keeps them.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields, replace
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np

from compare.benchmark.protocol import Coordinates, Track, variant
from compare.benchmark.records.cells import cell_text
from formulations.problem.arrays import Array

_LARGEST = 1_000_000_000  # bytes
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
    ignored_start = "ignored-start"
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
