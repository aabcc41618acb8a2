"""``timebound rivals``: the fastest motion beside other planners."""

from __future__ import annotations

import sys
from typing import Annotated

from cyclopts import Parameter

from compare.commands import DONE, FAILED
from compare.commands.options import Json, Resume, listed, positive
from compare.commands.studies import alone
from compare.screen import show
from compare.studies import rivals as study

Count = Annotated[int, Parameter(validator=positive)]


def rivals(
    *,
    rivals: Annotated[
        tuple[str, ...] | None,
        listed(lambda: study.PACKAGES, "drake, pyroboplan; those installed if left out.", "--rivals"),
    ] = None,
    count: Count = 4,
    points: Count = 14,
    evaluations: Count = 60,
    out: Annotated[str | None, Parameter(metavar="DIR")] = None,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Set the fastest motion beside the trajectory optimisation of Drake and pyroboplan.

    Every motion is judged by the same check. One problem is solved at a time, as times are measured.

    Parameters
    ----------
    count
        Random problems beside the cases.
    points
        Control points per segment for Drake.
    evaluations
        Splines that Drake may try per problem.
    out
        Folder for the rows; nothing is written if left out.
    """
    wanted = list(rivals or study.PACKAGES)
    present = study.installed(wanted)
    for name in wanted:
        if name not in present:
            print(f"{name}: not installed (pip install {name})", file=sys.stderr)
    if not present:
        return FAILED
    found = alone(study.STUDY, study.calls(present, count, points, evaluations), out=out, resume=resume)
    show(found.as_text(), found.to_json(), json)
    return DONE
