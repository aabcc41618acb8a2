"""``timebound condition_gaps``: how near motions under conditions come to their bounds."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.commands.options import CORES, Jobs, Json, Resume, positive
from compare.commands.studies import in_workers
from compare.studies import condition_gaps as study


def condition_gaps(
    *,
    count: Annotated[int, Parameter(validator=positive)] = 100,
    out: Annotated[str, Parameter(metavar="DIR")] = "report",
    jobs: Jobs = CORES,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Find motions under each kind of condition on random problems, and prove how near they are to the fastest.

    Nine kinds: zones, windows, least times, waits, cycles, given ends, free ends, limits of a segment, limits
    that differ by direction. The gap is the time of the motion over the proved bound, minus 1; certificates
    are proved again by the checker. 100 of each kind took 6.5 minutes on two idle cores.

    Parameters
    ----------
    count
        Random problems of each kind.
    out
        Folder for the rows: DIR/condition_gaps.csv and .json.
    """
    return in_workers(study.STUDY, study.calls(count), out=out, jobs=jobs, resume=resume, json=json)
