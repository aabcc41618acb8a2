"""``timebound motion_picture CASE``: the arm of a case in motion, as an SVG."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from compare.commands import DONE
from compare.commands.options import writable
from compare.files import write_text
from compare.report.motion_picture import arm_of, fastest_spline
from compare.screen import stages
from formulations import CASES, InputError, family_optimum, load

_WITH_ARM = [case for case in CASES if arm_of(case) is not None]


def motion_picture(
    case: Annotated[
        str, Parameter(name="CASE", help=f"A shipped case with an arm: {', '.join(_WITH_ARM)}.")
    ],
    /,
    *,
    out: Annotated[str | None, Parameter(metavar="FILE", validator=writable)] = None,
) -> int:
    """Draw the arm of a case as it moves along the fastest spline of its family.

    The picture shows two views in true time. It moves in any browser, without a script.

    Parameters
    ----------
    out
        The file to be written; CASE.svg if left out.
    """
    if case not in _WITH_ARM:
        raise InputError(f"CASE: no arm is known for {case!r} (known: {', '.join(_WITH_ARM)})")
    problem = load(case)
    with stages(case) as stage:
        stage(f"fastest {problem.family} spline")
        optimum = family_optimum(problem)
    picture = fastest_spline(case, problem, optimum.durations)
    assert picture is not None  # the case has an arm
    path = Path(out or f"{case}.svg")
    write_text(path, picture)
    print(f"{path}: {optimum.seconds:.4f} s, {path.stat().st_size / 1000:.0f} kB")
    return DONE
