"""``timebound tool_gaps``: how near motions under a limit of the tool's speed come to their bounds."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.commands.options import CORES, Jobs, Json, Resume, positive
from compare.commands.studies import in_workers
from compare.studies import tool_gaps as study


def tool_gaps(
    *,
    count: Annotated[int, Parameter(validator=positive)] = 100,
    time_limit: Annotated[float | None, Parameter(validator=positive, metavar="SECONDS")] = None,
    out: Annotated[str, Parameter(metavar="DIR")] = "report",
    jobs: Jobs = CORES,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Find motions of a UR5 under a limit of the tool's speed, and prove how near they are to the fastest.

    The gap is the time of the motion over the proved bound, minus 1. The bound is not tight under such limits:
    gaps of 4 to 26 % are usual.

    Parameters
    ----------
    count
        Random problems.
    time_limit
        Seconds that each search has, no limit if left out; the best motion until then counts.
    out
        Folder for the rows: DIR/tool_gaps.csv and .json.
    """
    calls = study.calls(count, time_limit)
    return in_workers(study.STUDY, calls, out=out, jobs=jobs, resume=resume, json=json)
