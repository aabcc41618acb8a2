"""The ladder of one case as it is stored: `formulations.Ladder` as plain data, and a few facts more."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NotRequired, TypedDict, cast

from formulations import InputError, Ladder
from formulations.diagnosis import diagnose


class RungRecord(TypedDict):
    """One rung: its time [s] and what is behind it; ``runtime`` in s of the machine that made it."""

    seconds: float | None
    kind: str
    status: str
    certified: bool
    runtime: float
    note: str


class LadderRecord(TypedDict):
    """Every bound of one case.

    ``ladder``: rungs by key. ``durations``: by key, those of the motions that have some [s].
    ``alone``: optimum of each joint alone [s], None where a joint does not move. ``held_up_by``: what
    holds the fastest motion up, a sentence each.
    """

    problem: str
    ladder: dict[str, RungRecord]
    durations: dict[str, list[float]]
    versions: dict[str, str]
    alone: NotRequired[list[float | None]]
    title: NotRequired[str]
    family: NotRequired[str]
    held_up_by: NotRequired[list[str]]


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
    return found


def checked_ladder_record(data: Any, path: Path) -> LadderRecord:
    """Return plain data as the record that it is.

    Parameters
    ----------
    data : object
        What was read from a JSON file.
    path : Path
        The file, for the message.

    Returns
    -------
    LadderRecord
        The same data.

    Raises
    ------
    InputError
        If an entry is missing or is of another type.
    """
    try:
        for key, kind in (("problem", str), ("ladder", dict), ("durations", dict)):
            if not isinstance(data[key], kind):
                raise ValueError(f"{key}: not a {kind.__name__}")
        for key, rung in data["ladder"].items():
            for name, kinds in _RUNG.items():
                if not isinstance(rung[name], kinds):
                    raise ValueError(f"{key}: {name}: {rung[name]!r}")
    except (KeyError, TypeError, ValueError) as error:
        what = f"{error.args[0]}: missing" if isinstance(error, KeyError) else str(error)
        raise InputError(f"{path}: not a ladder: {what}") from None
    return cast(LadderRecord, data)


_RUNG: dict[str, Any] = {
    "seconds": (float, int, type(None)),
    "kind": str,
    "status": str,
    "certified": bool,
    "note": str,
}
