"""A file that is judged before it is written: its bytes, read back and joined as a controller does."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from formulations.motion.files.motion_file import decode_motion, encode_motion
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.errors import NoFeasibleMotion
from formulations.problem.files import write_bytes
from formulations.problem.problem import Problem


@dataclass(frozen=True)
class JudgedFile:
    """The bytes of a file that does not exist yet, and what was found about them.

    Make one with ``JudgedFile.of``.

    Attributes
    ----------
    path : str
        The file.
    data : bytes
        What it shall hold.
    motion : Trajectory
        What a controller makes of these bytes.
    verdict : Verdict
        About this motion.
    """

    path: str
    data: bytes
    motion: Trajectory
    verdict: Verdict

    @staticmethod
    def of(
        path: str | Path,
        problem: Problem,
        content: MotionPoints | Trajectory,
        passages: Array | None,
        *,
        names: tuple[str, ...] = (),
        conditions: Conditions | None = None,
    ) -> JudgedFile:
        """Make the bytes of a file, read them back, and judge the motion that they hold.

        Parameters
        ----------
        path : str or Path
            The file, for its format; it is not touched.
        problem : Problem
            Waypoints and limits.
        content : MotionPoints or Trajectory
            Points, or for ``.pieces.json`` a motion.
        passages : Array, shape (n_waypoints,) [s], or None
            When points pass the waypoints; a file of pieces says it itself.
        names : tuple of str
            Names of the joints of a Trajectory.
        conditions : Conditions, optional
            What else was asked of the motion.

        Returns
        -------
        JudgedFile

        Raises
        ------
        InputError
            As ``encode_motion``.
        """
        data = encode_motion(path, content, names)
        back = decode_motion(path, data)
        motion = back.motion("auto", passages) if isinstance(back, MotionPoints) else back[0]
        return JudgedFile(str(path), data, motion, check(problem, motion, conditions=conditions))

    def write(self) -> None:
        """Write the file if it keeps everything.

        Raises
        ------
        NoFeasibleMotion
            It does not; nothing is written.
        InputError
            The file cannot be written.
        """
        if not self.verdict.feasible:
            raise NoFeasibleMotion(
                f"{self.path}: not written: its points, joined as a controller does, fail: "
                f"{self.verdict.faults[0]}"
            )
        write_bytes(self.path, self.data)
