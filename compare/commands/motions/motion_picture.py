"""``timebound motion_picture FILE``: the arm of a problem in motion, as an SVG."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from compare.commands import DONE
from compare.commands.motions.problem_options import FileOrRobot, OwnRobotOptions, known_arm, problem_of
from compare.commands.options import writable
from compare.files import write_text
from compare.report.motion_picture import arm_of, draw_motion_picture
from compare.screen import stages
from formulations import CASES, FAMILIES, InputError, family_optimum


def motion_picture(
    file: FileOrRobot = None,
    /,
    *,
    own: OwnRobotOptions = None,
    out: Annotated[str | None, Parameter(metavar="FILE", validator=writable)] = None,
) -> int:
    """Draw the arm of a problem as it moves along the fastest spline of its family.

    The arm is that of the case, of the key robot or arm in FILE, or of --robot. The picture shows two views in
    true time. It moves in any browser, without a script.

    Parameters
    ----------
    out
        The file to be written; named after the problem if left out.
    """
    problem = problem_of(file, own)
    arm = known_arm(file, own)
    if arm is None:
        known = ", ".join(case for case in CASES if arm_of(case) is not None)
        raise InputError(
            f"{file or '--limits'}: no arm is known (cases with one: {known}); "
            "the key or option robot names a URDF"
        )
    with stages(problem.name) as stage:
        stage(f"fastest {problem.family} spline")
        optimum = family_optimum(problem)
    trajectory = FAMILIES[problem.family].trajectory(problem, optimum.durations)
    title = (
        f"{getattr(arm, 'title', arm.name)}: fastest {problem.family} spline, {optimum.seconds:.4f} s"
    )
    path = Path(out or f"{problem.name if file is None else Path(file).stem}.svg")
    write_text(path, draw_motion_picture(arm, trajectory, title))
    print(f"{path}: {optimum.seconds:.4f} s, {path.stat().st_size / 1000:.0f} kB")
    return DONE
