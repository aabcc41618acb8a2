"""The text of a new problem file: commented, with every key a person needs, and checked by reading it."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from formulations.problem.errors import InputError
from formulations.problem.files import write_text
from formulations.problem.limits import LIMITED
from formulations.problem.problem import Problem
from formulations.problem.toml_file.problem_file import parse
from formulations.problem.toml_file.robot_files import RobotFiles

Numbers = Mapping[str, float]  # by joint name
_PER = {"velocity": "/s", "acceleration": "/s^2", "jerk": "/s^3"}


@dataclass(frozen=True)
class NewFile:
    """What a new problem file shall say.

    Attributes
    ----------
    name : str
        Name of the problem.
    unit : {"rad", "deg"}
        Unit of angles; lengths are in m.
    robot : RobotFiles or None
        The files of the robot, of its limits and of its waypoints; None where all of it is written out.
    joints : tuple of str
        Without files: names of the joints.
    prismatic : tuple of str
        Those of them whose positions are in m.
    waypoints : sequence of sequences of float
        Without a file of them: a row per waypoint [unit or m].
    limits : mapping of str to mapping of str to float
        By quantity and joint [unit or m, s]; with files, those that these do not give.
    """

    name: str
    unit: str = "rad"
    robot: RobotFiles | None = None
    joints: tuple[str, ...] = ()
    prismatic: tuple[str, ...] = ()
    waypoints: Sequence[Sequence[float]] = ()
    limits: Mapping[str, Numbers] = field(default_factory=dict)

    def text(self, folder: Path) -> str:
        """Write the text.

        Parameters
        ----------
        folder : Path
            Folder of the file; the paths in it are relative to it.

        Returns
        -------
        str
            TOML.
        """
        lines = [
            "# A problem for timebound: waypoints, and the limits that the motion must keep.",
            "# timebound plan FILE finds the fastest motion, timebound solve FILE every bound.",
            "",
            f"name = {_quoted(self.name)}",
            f"unit = {_quoted(self.unit)}    # of all angles in this file: rad or deg; lengths are in m",
            "",
            *(self._joint_lines() if self.robot is None else _robot_lines(self.robot, folder)),
            "",
            *self._waypoint_lines(folder),
            "",
            *self._limit_lines(),
            "",
            "# [conditions]    # zones, times, stops, waits, cycles, states at the ends; left out: none",
            f"# tolerance = 0.01    # {self.unit}: how far from each inner waypoint each joint may pass it",
        ]
        return "\n".join(lines).rstrip() + "\n"

    def write(self, path: Path, *, force: bool = False) -> Problem:
        """Write the file, after reading its text as a problem.

        Parameters
        ----------
        path : Path
            The file.
        force : bool
            Whether a file that is there may be replaced.

        Returns
        -------
        Problem
            What the file says.

        Raises
        ------
        InputError
            The file is there, cannot be written, or would not be a problem.
        """
        if path.exists() and not force:
            raise InputError(f"{path}: is there already; --force replaces it")
        text = self.text(path.parent)
        problem = parse(text, where=str(path), folder=path.parent)
        write_text(path, text)
        return problem

    def _joint_lines(self) -> list[str]:
        lines = [f"joints = {_listed(self.joints)}    # names, in the order of the columns below"]
        return [*lines, *_prismatic_lines(self.prismatic)]

    def _waypoint_lines(self, folder: Path) -> list[str]:
        if self.robot is not None and self.robot.waypoints is not None:
            return [
                "# a column per joint, or poses; or waypoints = [[...], ...] here",
                f"waypoints_file = {_path(self.robot.waypoints, folder)}",
            ]
        rows = ",\n".join(f"  [{', '.join(_number(x) for x in row)}]" for row in self.waypoints)
        return [f"waypoints = [    # a row per waypoint, in {self.unit}", f"{rows},", "]"]

    def _limit_lines(self) -> list[str]:
        if self.robot is not None and not any(self.limits.values()):
            return [
                "# [limits]    # lays other limits over those of the files, by joint:",
                f"# velocity = {{NAME = 1.0}}    # in {self.unit}/s",
            ]
        why = "by joint" if self.robot is None else "by joint; what the files do not give"
        lines = [f"[limits]    # {why}"]
        for quantity in LIMITED[:3]:
            values = self.limits.get(quantity, {})
            if values:
                entries = ", ".join(f"{_quoted(name)} = {_number(x)}" for name, x in values.items())
                lines.append(f"{quantity} = {{{entries}}}    # {self.unit}{_PER[quantity]}")
            elif self.robot is None:
                lines.append(f"# {quantity} = 1.0    # left out: unlimited")
        if self.robot is None:
            lines.append("# position = {NAME = [-170, 170]}    # left out: unlimited")
        return lines


def _robot_lines(files: RobotFiles, folder: Path) -> list[str]:
    lines = [] if files.robot is None else [f"robot = {_path(files.robot, folder)}"]
    if files.srdf is not None:
        lines.append(f"srdf = {_path(files.srdf, folder)}")
    if files.group is not None:
        lines.append(f"group = {_quoted(files.group)}    # whose joints move")
    if files.joints is not None:
        lines.append(f"joints = {_listed(files.joints)}    # the joints that move, in this order")
    if files.limits:
        paths = ", ".join(_path(path, folder) for path in files.limits)
        over = "laid over the limits of the URDF" if files.robot is not None else "each over the last"
        lines.append(f"limits_file = [{paths}]    # {over}")
    lines += _prismatic_lines(files.prismatic)
    if files.unlimited:
        lines.append(
            f"unlimited = {_listed(files.unlimited)}    # joints without such a limit may go without"
        )
    if files.tip is not None:
        lines.append(f"tip = {_quoted(files.tip)}    # the link that poses are given for")
    return lines


def _prismatic_lines(names: Sequence[str]) -> list[str]:
    return [f"prismatic = {_listed(names)}    # joints whose positions are in m"] if names else []


def _number(value: float) -> str:
    return repr(float(value))


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _listed(texts: Sequence[str]) -> str:
    return f"[{', '.join(_quoted(text) for text in texts)}]"


def _path(path: Path, folder: Path) -> str:
    """A path relative to a folder, where there is one (none between drives of Windows)."""
    if path.is_absolute():
        return _quoted(path.as_posix())
    return _quoted(Path(os.path.relpath(path, folder)).as_posix())
