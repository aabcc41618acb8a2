"""``timebound proofs``: what a certified bound costs."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.commands.options import CORES, Jobs, Json, Out, Resume, positive
from compare.commands.studies import in_workers
from compare.studies.proofs import STUDY, calls

Count = Annotated[int, Parameter(validator=positive)]


def proofs(
    *,
    count: Count = 100,
    segments: Count = 6,
    each: Count = 2,
    out: Out = "report",
    jobs: Jobs = CORES,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Measure what a certified bound costs: boxes and time, on random problems.

    Files: DIR/proofs.csv, proofs.json, figures/proofs.svg.

    Parameters
    ----------
    count
        Random 3-5-3 problems.
    segments
        Most segments of the problems with six joints.
    each
        Problems per size, limits and gap.
    """
    return in_workers(STUDY, calls(count, segments, each), out=out, jobs=jobs, resume=resume, json=json)
