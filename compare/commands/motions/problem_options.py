"""How a command is told its problem: a file, or files of limits and waypoints, with a URDF or without.

Every command about a problem has two parameters for it, ``file: FileOrRobot = None`` and
``own: OwnRobotOptions = None``, and calls ``problem_of(file, own)``; with the options of ``condition_options``,
``problem_of(file, own, asked)``.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Group, Parameter

from compare.commands.motions.condition_options import AskedConditions, conditions_of

if TYPE_CHECKING:
    from formulations import Limits, Problem
    from formulations.arms import Arm
    from formulations.motion.files.motion_points import MotionPoints
    from formulations.problem.toml_file.robot_files import RobotFiles
    from formulations.robot import Robot

_ROBOT = Group("In place of FILE", sort_key=10)

FileOrRobot = Annotated[
    str | None,
    Parameter(
        name="FILE",
        help="A problem file (TOML), or the name of a shipped case; or --robot, --limits and --waypoints.",
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
        Parameter(
            metavar="NAME,..",
            help="The joints that move, in order; all if left out, or without --robot those that the "
            "waypoints name.",
        ),
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

    prismatic: Annotated[
        str | None,
        Parameter(metavar="NAME,..", help="Without --robot: the joints whose positions are in m."),
    ] = None

    @property
    def files(self) -> RobotFiles:
        """The files that these options name."""
        from formulations.problem.toml_file.robot_files import RobotFiles

        return RobotFiles(
            robot=_path(self.robot),
            joints=names(self.joints),
            group=self.group,
            srdf=_path(self.srdf),
            limits=tuple(Path(path) for path in self.limits),
            unlimited=names(self.unlimited) or (),
            tip=self.tip,
            prismatic=names(self.prismatic) or (),
            waypoints=_path(self.waypoints),
        )

    def problem(self) -> Problem:
        """Read the problem that these options state; raises InputError in one line."""
        from formulations import InputError
        from formulations.problem.toml_file.robot_files import problem_from

        if self.robot is None and not self.limits:
            raise InputError("--robot: missing: --robot URDF or --limits YAML goes with --waypoints")
        if self.robot is not None and self.prismatic is not None:
            raise InputError("--prismatic: given beside --robot, whose URDF says it; leave it out")
        if self.waypoints is None:
            raise InputError("--waypoints: missing; it goes with --robot URDF or --limits YAML")
        return problem_from(self.files, unit=self.unit or "rad")


def _path(text: str | None) -> Path | None:
    return None if text is None else Path(text)


OwnRobotOptions = Annotated[OwnRobot | None, Parameter(name="*")]


def problem_of(file: str | None, own: OwnRobot | None, asked: AskedConditions | None = None) -> Problem:
    """Read the problem that a command is called with, and say on standard error what looks odd.

    Parameters
    ----------
    file : str or None
        A problem file, or the name of a shipped case.
    own : OwnRobot or None
        The options that stand in its place.
    asked : AskedConditions, optional
        The options that lie over its conditions.

    Returns
    -------
    Problem

    Raises
    ------
    InputError
        Neither is given, or both are, one of the files cannot be used, or an option does not fit.
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
    problem = replace(problem, conditions=conditions_of(asked, problem))
    for hint in problem.hints:
        print(f"hint: {hint}", file=sys.stderr)
    return problem


def known_arm(file: str | None, own: OwnRobot | None) -> Arm | Robot | None:
    """Return the arm that a command's problem is about, to draw it.

    Parameters
    ----------
    file : str or None
        A problem file, or the name of a shipped case.
    own : OwnRobot or None
        The options that stand in its place.

    Returns
    -------
    Arm or Robot or None
        That of the case, of the key ``robot`` or ``arm`` in the file, or of ``--robot``; None where no arm is
        known.
    """
    from compare.report.motion_picture import arm_of
    from formulations import CASES
    from formulations.problem.toml_file.problem_file import arm_in

    if file is None:
        return own.files.read() if own is not None and own.robot is not None else None
    return arm_of(file) if file in CASES else arm_in(file)


def limits_for(points: MotionPoints, own: OwnRobot | None) -> tuple[MotionPoints, Limits]:
    """Read the limits that a path is to be timed under, and put its joints in their order.

    Parameters
    ----------
    points : MotionPoints
        The path; its names say which joints move where the options do not.
    own : OwnRobot or None
        ``--limits`` names YAML files, with ``--robot`` or alone, or else a problem file or a shipped case.

    Returns
    -------
    points : MotionPoints
    limits : Limits

    Raises
    ------
    InputError
        There are no limits, or the joints do not fit.
    """
    from formulations import InputError, load
    from formulations.motion.judgement import in_order_of

    own = own or OwnRobot()
    if own.waypoints is not None:
        raise InputError("--waypoints: not used here: the points of MOTION are the path")
    if own.robot is None and not own.limits:
        raise InputError(
            "--limits: missing: a problem file, a shipped case, or YAML with --robot or alone"
        )
    problem_file = [f for f in own.limits if Path(f).suffix.lower() not in (".yaml", ".yml")]
    if problem_file:
        (file, *more) = problem_file
        if more or own != OwnRobot(limits=(file,)):
            raise InputError(f"--limits: {file} is a problem file, which stands alone")
        posed = load(file)
        limits, wanted, whose = posed.limits, posed.names, file
        if not posed.conditions.none:
            print(
                f"hint: --limits {file}: its [conditions] are about its waypoints and are not used",
                file=sys.stderr,
            )
    else:
        files = own.files
        if files.joints is None and files.group is None and points.names:
            files = replace(files, joints=points.names)
        elif files.joints is None and own.robot is None:
            raise InputError(
                f"MOTION: names no joints, so {own.limits[0]} does not say which limit is whose; "
                "give --joints NAME,.. or --robot URDF"
            )
        robot = files.read()
        limits, wanted, whose = robot.limits, robot.names, own.robot or own.limits[0]
    count, given = len(limits.velocity), points.positions.shape[1]
    if given != count:
        raise InputError(f"MOTION: {given} joints, {whose} has {count}")
    return in_order_of(wanted, points), limits


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
