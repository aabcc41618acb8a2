"""The ladder of one case as it is stored: `formulations.Ladder` as plain data, and a few facts more."""

from __future__ import annotations

from typing import NotRequired, TypedDict, cast

from formulations import Ladder
from formulations.diagnosis import diagnose


class RungRecord(TypedDict):
    """One rung: its time [s] and what is behind it; ``runtime`` in s of the machine that made it."""

    seconds: float | None
    kind: str
    status: str
    certified: bool
    runtime: float
    note: str


class PiecesRecord(TypedDict):
    """A motion as exact pieces: durations [s], coefficients (piece, joint, power), passage times [s]."""

    durations: list[float]
    coefficients: list[list[list[float]]]
    passages: list[float]


class LadderRecord(TypedDict):
    """Every bound of one case.

    ``ladder``: rungs by key. ``durations``: by key, those of the motions that have some [s].
    ``alone``: optimum of each joint alone [s], None where a joint does not move. ``held_up_by``: what
    holds the fastest motion up, a sentence each. ``fastest``: the fastest motion known.
    """

    problem: str
    ladder: dict[str, RungRecord]
    durations: dict[str, list[float]]
    versions: dict[str, str]
    alone: NotRequired[list[float | None]]
    title: NotRequired[str]
    family: NotRequired[str]
    held_up_by: NotRequired[list[str]]
    fastest: NotRequired[PiecesRecord]


def ladder_record(ladder: Ladder) -> LadderRecord:
    """Return a climbed ladder as plain data, with what holds its fastest motion up.

    Parameters
    ----------
    ladder : Ladder

    Returns
    -------
    LadderRecord
    """
    found = cast(LadderRecord, ladder.to_json())
    found["alone"] = [None if one is None else one.seconds for one in ladder.alone]
    found["title"], found["family"] = ladder.problem.title, ladder.problem.family
    if ladder.free_form is not None:
        found["held_up_by"] = diagnose(ladder.problem, ladder.free_form).lines()
    motion = ladder.trajectories.get("free_form")
    if motion is not None:
        found["fastest"] = {
            "durations": motion.durations.tolist(),
            "coefficients": motion.coefficients.tolist(),
            "passages": motion.passage_times.tolist(),
        }
    return found
