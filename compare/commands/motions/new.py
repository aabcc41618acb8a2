"""``timebound new``: a commented problem file from a robot's files, from options, or from answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from compare.commands import DONE
from compare.commands.motions.problem_options import names
from compare.commands.motions.questions import ask, at_a_terminal, limits, numbers, words
from compare.commands.options import writable
from formulations import InputError
from formulations.problem.joint_words import shown_unit
from formulations.problem.toml_file.new_file import NewFile
from formulations.problem.toml_file.robot_files import RobotFiles
from formulations.problem.toml_file.toml_values import nearest

if TYPE_CHECKING:
    from formulations.robot import Robot

_QUANTITIES = ("velocity", "acceleration", "jerk")
Text = Annotated[str | None, Parameter(metavar="NAME")]
PerJoint = Annotated[str | None, Parameter(metavar="N,..")]


def new(
    *,
    out: Annotated[
        str, Parameter(name=("--out", "-o"), metavar="FILE", validator=writable)
    ] = "problem.toml",
    name: Text = None,
    unit: Literal["rad", "deg"] | None = None,
    from_urdf: Annotated[str | None, Parameter(metavar="URDF")] = None,
    srdf: Annotated[str | None, Parameter(metavar="FILE")] = None,
    group: Text = None,
    joints: Annotated[str | None, Parameter(metavar="NAME,..")] = None,
    limits_file: Annotated[
        tuple[str, ...],
        Parameter(
            name="--limits", metavar="YAML", n_tokens=1, consume_multiple=False, show_default=False
        ),
    ] = (),
    unlimited: Annotated[str | None, Parameter(metavar="NAME,..")] = None,
    velocity: PerJoint = None,
    acceleration: PerJoint = None,
    jerk: PerJoint = None,
    prismatic: Annotated[str | None, Parameter(metavar="NAME,..")] = None,
    waypoints: Annotated[str | None, Parameter(metavar="FILE")] = None,
    waypoint: Annotated[
        tuple[str, ...],
        Parameter(
            metavar="X,..",
            n_tokens=1,
            consume_multiple=False,
            allow_leading_hyphen=True,
            show_default=False,
        ),
    ] = (),
    force: bool = False,
) -> int:
    """Write a problem file, with comments, from options; on a terminal, what is missing is asked for.

    No limit is invented: where the files of a robot leave one out and nobody gives it, nothing is written.

    Parameters
    ----------
    out
        The file. It is not replaced without --force.
    name
        Name of the problem; that of the file if left out.
    unit
        Unit of all angles; rad if left out.
    from_urdf
        The robot. Without it, joints and limits are those of --limits and --waypoints, or are written out.
    srdf
        MoveIt's description of the groups.
    group
        A group of the SRDF in place of --joints.
    joints
        The joints that move, in order.
    limits_file
        MoveIt's joint_limits.yaml; several times if needed.
    unlimited
        acceleration, jerk or position: joints may have no such limit.
    velocity
        Limits that no file gives: one number for all joints, or one for each that lacks it.
    acceleration
        The same for accelerations.
    jerk
        The same for jerks.
    prismatic
        Without --from-urdf: the joints whose positions are in m.
    waypoints
        A .csv table of positions (or of poses, with --from-urdf), or a JointTrajectory.
    waypoint
        One waypoint in place of a file of them, a number per joint; several times, in order.
    force
        Replace a file that is there.
    """
    path = Path(out)
    if path.exists() and not force:
        raise InputError(f"--out: {path} is there already; --force replaces it")
    given = {"velocity": velocity, "acceleration": acceleration, "jerk": jerk}
    if waypoints is not None and waypoint:
        raise InputError("--waypoint: given beside --waypoints; leave one of them out")
    for key, value in (("srdf", srdf), ("group", group)):
        if value and from_urdf is None:
            raise InputError(f"--{key}: needs a robot (--from-urdf URDF)")
    if from_urdf is not None and prismatic is not None:
        raise InputError("--prismatic: given beside --from-urdf, whose URDF says it; leave it out")
    files = RobotFiles(
        robot=None if from_urdf is None else Path(from_urdf),
        joints=names(joints),
        group=group,
        srdf=None if srdf is None else Path(srdf),
        limits=tuple(Path(entry) for entry in limits_file),
        unlimited=names(unlimited) or (),
        prismatic=names(prismatic) or (),
        waypoints=None if waypoints is None else Path(waypoints),
    )
    if from_urdf is None and not limits_file and waypoints is None:
        file = _written_out(name or path.stem, unit, files, given, waypoint)
    else:
        file = _with_files(name or path.stem, unit, files, given, waypoint)
    problem = file.write(path, force=force)
    print(f"{path}: written, {len(problem.waypoints)} waypoints of {problem.dof} joints")
    for hint in problem.hints:
        print(f"hint: {hint}")
    print(f"next: timebound plan {path} --export motion.csv --rate 125")
    return DONE


def _with_files(
    name: str,
    unit: str | None,
    files: RobotFiles,
    given: dict[str, str | None],
    rows: tuple[str, ...],
) -> NewFile:
    """The file for a robot or for limits and waypoints from files: only what these leave out is asked for."""
    robot = files.read()
    angle = unit or _unit()
    found: dict[str, dict[str, float]] = {}
    free: list[str] = []
    for quantity in _QUANTITIES:
        lacking = [joint for joint in robot.joints if quantity in joint.missing]
        text = given[quantity]
        if text is not None:
            of = [joint.name for joint in lacking] or list(robot.names)
            found[quantity] = dict(zip(of, _limits(quantity, text, len(of)), strict=True))
        elif lacking and at_a_terminal():
            for joint in lacking:
                per = shown_unit(joint.unit, angle, _QUANTITIES.index(quantity) + 1)
                values = ask(
                    f"{quantity} limit of joint {joint.name} [{per}]{_or_none(quantity)}",
                    partial(_read_limits, quantity=quantity, count=1),
                )
                if values:
                    found.setdefault(quantity, {})[joint.name] = values[0]
                else:
                    free.append(quantity)
    files = replace(files, unlimited=tuple(dict.fromkeys((*files.unlimited, *free))))
    robot = files.read()
    _require_limits(robot, found)
    points = [_row(row, robot.dof) for row in rows]
    if files.waypoints is None and not points:
        if not at_a_terminal():
            raise InputError("--waypoints: missing: a file, or --waypoint X,.. several times")
        text = ask("file of waypoints; nothing: they are typed here", str)
        if text:
            files = replace(files, waypoints=Path(text))
        else:
            points = _typed_rows(robot.names, robot.units, angle)
    return NewFile(name=name, unit=angle, robot=files, waypoints=points, limits=found)


def _typed_rows(names: Sequence[str], units: Sequence[str], angle: str) -> list[list[float]]:
    """Waypoints that a person types, row by row."""
    columns = ", ".join(f"{n} [{shown_unit(u, angle)}]" for n, u in zip(names, units, strict=True))
    points: list[list[float]] = []
    while row := ask(
        f"waypoint {len(points) + 1}: {columns}"
        + ("; nothing ends the list" if len(points) > 1 else ""),
        lambda text: _row(text, len(names)) if text or len(points) < 2 else [],
    ):
        points.append(row)
    return points


def _require_limits(robot: Robot, found: dict[str, dict[str, float]]) -> None:
    """Refuse a robot with a limit that neither its files nor a person gave."""
    try:
        _ = robot.with_limits(**{key: dict(values) for key, values in found.items()}).limits  # type: ignore[arg-type]
    except InputError as error:
        raise InputError(f"{error}; or give --velocity, --acceleration, --jerk, --unlimited") from None


def _written_out(
    name: str,
    unit: str | None,
    files: RobotFiles,
    given: dict[str, str | None],
    rows: tuple[str, ...],
) -> NewFile:
    """The file with joints and limits written out."""
    asking, joints, unlimited = at_a_terminal(), files.joints, files.unlimited
    if joints is None and not asking:
        raise InputError("--joints: missing: names of the joints, or a robot (--from-urdf URDF)")
    joints = joints or ask("names of the joints, such as shoulder, elbow", words)
    angle = unit or _unit()
    for slide in files.prismatic:
        if slide not in joints:
            raise InputError(f"--prismatic: no joint {slide!r}{nearest(slide, joints)}")
    units = ["m" if joint in files.prismatic else "rad" for joint in joints]
    found: dict[str, dict[str, float]] = {}
    for order, quantity in enumerate(_QUANTITIES, 1):
        if quantity in unlimited:
            continue
        text = given[quantity]
        if text is not None:
            values = _limits(quantity, text, len(joints))
        elif asking:
            per = " or ".join(dict.fromkeys(shown_unit(own, angle, order) for own in units))
            values = ask(
                f"{quantity} limits [{per}], one for all joints or one per joint{_or_none(quantity)}",
                partial(_read_limits, quantity=quantity, count=len(joints)),
            )
        else:
            raise InputError(f"--{quantity}: missing; a joint without one: --unlimited {quantity}")
        found[quantity] = dict(zip(joints, values, strict=bool(values)))
    points = [_row(row, len(joints)) for row in rows]
    if asking and not points:
        points = _typed_rows(joints, units, angle)
    if len(points) < 2:
        raise InputError(f"--waypoint: {len(points)} given; a motion needs two or more")
    return NewFile(
        name=name,
        unit=angle,
        joints=joints,
        prismatic=files.prismatic,
        waypoints=points,
        limits=found,
    )


def _or_none(quantity: str) -> str:
    return "" if quantity == "velocity" else "; none: unlimited"


def _read_limits(text: str, quantity: str, count: int) -> list[float]:
    """Limits, (count,); empty for ``none``, which a velocity cannot be."""
    return [] if text == "none" and quantity != "velocity" else limits(text, count)


def _unit() -> str:
    if not at_a_terminal():
        return "rad"
    return ask("unit of angles, rad or deg", _read_unit)


def _read_unit(text: str) -> str:
    if text not in ("rad", "deg"):
        raise ValueError(f"{text!r} is neither rad nor deg")
    return text


def _limits(quantity: str, text: str, count: int) -> list[float]:
    try:
        return limits(text, count)
    except ValueError as error:
        raise InputError(f"--{quantity}: {error}") from None


def _row(text: str, count: int) -> list[float]:
    """One waypoint; InputError, which is a ValueError, where it is none."""
    try:
        found = numbers(text)
    except ValueError as error:
        raise InputError(f"--waypoint: {text!r}: {error}") from None
    if len(found) != count:
        raise InputError(f"--waypoint: {text!r}: {len(found)} numbers for {count} joints")
    return found
