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
    """Find motions of an arm under torque limits, and prove how near they are.

    Parameters
    ----------
    urdf
        The arm, with masses and efforts. Another arm than a UR5 has other waypoints.
    payload
        What it carries.
    count
        Random problems.
    time_limit
        For each search; the best motion so far counts.
    out
        Folder for the rows.
    """
    calls = study.calls(urdf, count, payload=payload, time_limit=time_limit)
    return in_workers(study.STUDY, calls, out=out, jobs=jobs, resume=resume, json=json)
