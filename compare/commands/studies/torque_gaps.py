"""``timebound torque_gaps``: how near motions under torque limits come to their bounds."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.commands.options import CORES, Jobs, Json, Resume, positive
from compare.commands.studies import in_workers
from compare.studies import torque_gaps as study


def torque_gaps(
    urdf: Annotated[str, Parameter(metavar="URDF")],
    /,
    *,
    payload: Annotated[float, Parameter(validator=positive, metavar="KG")] = 2.0,
    count: Annotated[int, Parameter(validator=positive)] = 100,
    time_limit: Annotated[float | None, Parameter(validator=positive, metavar="SECONDS")] = None,
    out: Annotated[str, Parameter(metavar="DIR")] = "report",
    jobs: Jobs = CORES,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Find motions of an arm under torque limits, and prove how near they are to the fastest.

    The gap is the time of the motion over the proved bound, minus 1. The bound is that of the other limits, so
    that the gap holds what the torques cost. Needs the extras robot and dynamics.

    Parameters
    ----------
    urdf
        The arm, with masses and torque limits (efforts). The waypoints are drawn for it; the figures in
        the documentation are those of a UR5.
    payload
        Mass at the end of the arm [kg].
    count
        Random problems.
    time_limit
        Seconds that each search has, no limit if left out; the best motion until then counts.
    out
        Folder for the rows: DIR/torque_gaps.csv and .json.
    """
    calls = study.calls(urdf, count, payload=payload, time_limit=time_limit)
    return in_workers(study.STUDY, calls, out=out, jobs=jobs, resume=resume, json=json)
