"""``timebound free_form_study``: the fastest motion on many problems."""

from __future__ import annotations

from typing import Annotated, Literal

from cyclopts import Parameter

from compare.commands import DONE
from compare.commands.options import Gap, Json, Resume, Seed, positive
from compare.commands.studies import alone
from compare.screen import show
from compare.studies import free_form_study as study


def free_form_study(
    *,
    count: Annotated[int, Parameter(validator=positive)] = 200,
    seed: Seed = 0,
    tolerance: Annotated[float, Parameter(validator=positive)] = 1e-3,
    solver: Literal["ipopt", "highs"] = "ipopt",
    gap: Gap = 1e-3,
    each: bool = False,
    out: Annotated[str | None, Parameter(metavar="DIR")] = None,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Find the fastest motion on the shipped cases, on extremes, and on random problems of two arms.

    Every motion is judged by the independent check, and set beside its certified bound and beside
    Ruckig with a full stop at each waypoint. One problem is solved at a time, as times are measured.

    Parameters
    ----------
    count
        Random problems.
    tolerance
        Relative tolerance of the motion.
    solver
        Solver of the nonlinear program.
    each
        Show a line per random problem too.
    out
        Folder for the rows; nothing is written if left out.
    """
    listed = study.calls(count, seed, tolerance, solver, gap)
    found = alone(study.STUDY, listed, out=out, resume=resume)
    text = found.as_text()
    if each:
        drawn = [answer for answer in found.rows if answer.series == "random"]
        text = f"{study.as_table(drawn)}\n\n{text}"
    show(text, found.to_json(), json)
    return DONE
