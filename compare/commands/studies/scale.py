"""``timebound scale``: time and memory against the number of waypoints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

from cyclopts import Parameter, Token

from compare.commands import DONE
from compare.commands.options import Gap, Json, Resume, Seed, not_negative, positive
from compare.commands.studies import alone
from compare.screen import show
from compare.studies import scale as study
from formulations.problem.size import MOST_WAYPOINTS


def _read_counts(kind: Any, tokens: Sequence[Token]) -> tuple[int, ...]:
    counts = [part.strip() for part in tokens[0].value.split(",") if part.strip()]
    for count in counts:
        if not (count.isdecimal() and 2 <= int(count) <= MOST_WAYPOINTS):
            raise ValueError(f"{count} is no number of waypoints (2 to {MOST_WAYPOINTS})")
    if not counts:
        raise ValueError("none given (2,10,100, say)")
    return tuple(sorted({int(count) for count in counts}))


Counts = Annotated[
    tuple[int, ...],
    Parameter(
        converter=_read_counts, n_tokens=1, metavar="N,..", show_default=lambda v: ",".join(map(str, v))
    ),
]


def scale(
    *,
    joints: Annotated[int, Parameter(validator=positive)] = 7,
    counts: Counts = (10, 30, 100, 300, 1000),
    step: Annotated[float, Parameter(metavar="RAD", validator=positive)] = 2.5,
    zones: Annotated[float, Parameter(metavar="RAD", validator=not_negative)] = 0.0,
    seed: Seed = 0,
    gap: Gap = 1e-3,
    time_limit: Annotated[float, Parameter(metavar="SECONDS", validator=positive)] = 600.0,
    out: Annotated[str, Parameter(metavar="DIR")] = "report",
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Plan and prove random problems with more and more waypoints: the time, gap and memory that each takes.

    One problem is solved at a time, in a process of its own, as times and memory are measured. Files:
    DIR/scale.csv, scale.json, figures/scale.svg.

    Parameters
    ----------
    joints
        Joints of every problem.
    counts
        Numbers of waypoints.
    step
        Longest step of a joint between two waypoints [rad].
    zones
        How far from each inner waypoint every joint may pass it [rad].
    time_limit
        Seconds that each proof has; the search for a motion has no limit.
    out
        Folder of the files.
    """
    listed = study.calls(joints, counts, step, zones, seed, gap, time_limit)
    found = alone(study.STUDY, listed, out=out, resume=resume)
    show(found.as_text(), found.to_json(), json)
    return DONE
