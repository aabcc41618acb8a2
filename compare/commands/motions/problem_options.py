"""How a command is told its problem: a file, or a robot's files and its waypoints in place of one.

A command has two parameters for it, ``file: FileOrRobot = None`` and ``own: OwnRobotOptions = None``, and
calls ``problem_of(file, own)``.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Group, Parameter

if TYPE_CHECKING:
    from formulations import Problem

_ROBOT = Group("In place of FILE", sort_key=10)

FileOrRobot = Annotated[
    str | None,
    Parameter(
        name="FILE",
        help="A problem file (TOML), or the name of a shipped case; or --robot and --waypoints in its place.",
    ),
]


@Parameter(name="*", group=_ROBOT)
@dataclass(frozen=True)
class OwnRobot:
    """The options that stand in place of a problem file: a robot's files and its waypoints."""

    robot: Annotated[str | None, Parameter(metavar="URDF", help="The robot; in place of FILE.")] = None
    limits: Annotated[
        tuple[str, ...],
        Parameter(
            metavar="YAML",
            n_tokens=1,
            consume_multiple=False,
            show_default=False,
            help="MoveIt's joint_limits.yaml, laid over the limits of the URDF; several times if needed.",
        ),
    ] = ()
    waypoints: Annotated[
        str | None,
        Parameter(metavar="FILE", help="A .csv table of positions or poses, or a JointTrajectory."),
    ] = None
    joints: Annotated[
        str | None,
        Parameter(metavar="NAME,..", help="The joints that move, in order; all if left out."),
    ] = None
    group: Annotated[str | None, Parameter(help="A group of the SRDF in place of --joints.")] = None
    srdf: Annotated[
        str | None, Parameter(metavar="FILE", help="MoveIt's description of the groups.")
    ] = None
    unit: Annotated[
        Literal["rad", "deg"] | None,
        Parameter(help="Unit of the angles in --waypoints; rad if left out."),
    ] = None
    unlimited: Annotated[
        str | None,
        Parameter(
            metavar="NAME,..", help="acceleration, jerk or position: joints may have no such limit."
        ),
    ] = None
    tip: Annotated[str | None, Parameter(metavar="LINK", help="The link that poses are given for.")] = (
        None
    )

    def problem(self) -> Problem:
        """Read the problem that these options state; raises InputError in one line."""
        from formulations import InputError
        from formulations.problem.toml_file.robot_files import RobotFiles, problem_from

        for key, needed in (("robot", self.robot), ("waypoints", self.waypoints)):
            if needed is None:
                raise InputError(f"--{key}: missing; --robot URDF and --waypoints FILE go together")
        files = RobotFiles(
            robot=Path(self.robot or ""),
            joints=names(self.joints),
            group=self.group,
            srdf=None if self.srdf is None else Path(self.srdf),
            limits=tuple(Path(path) for path in self.limits),
            unlimited=names(self.unlimited) or (),
            tip=self.tip,
        )
        return problem_from(files, Path(self.waypoints or ""), unit=self.unit or "rad")


OwnRobotOptions = Annotated[OwnRobot | None, Parameter(name="*")]


def problem_of(file: str | None, own: OwnRobot | None) -> Problem:
    """Read the problem that a command is called with, and say on standard error what looks odd.

    Parameters
    ----------
    file : str or None
        A problem file, or the name of a shipped case.
    own : OwnRobot or None
        The options that stand in its place.

    Returns
    -------
    Problem

    Raises
    ------
    InputError
        Neither is given, or both are, or one of the files cannot be used.
    """
    from formulations import InputError, load

    if file is not None and own is not None and own != OwnRobot():
        given = next(f.name for f in fields(own) if getattr(own, f.name) != f.default)
        raise InputError(f"--{given}: given beside FILE, {file}; leave one of them out")
    if file is None and (own is None or own == OwnRobot()):
        raise InputError(
            "FILE: missing: a problem file, a shipped case, or --robot URDF --limits YAML --waypoints CSV"
        )
    problem = load(file) if file is not None else own.problem() if own is not None else None
    assert problem is not None
    for hint in problem.hints:
        print(f"hint: {hint}", file=sys.stderr)
    return problem


def names(text: str | None) -> tuple[str, ...] | None:
    """Read names that are separated by commas.

    Parameters
    ----------
    text : str or None
        What was typed; None if the option was left out.

    Returns
    -------
    tuple of str, or None
    """
    return None if text is None else tuple(name.strip() for name in text.split(",") if name.strip())
