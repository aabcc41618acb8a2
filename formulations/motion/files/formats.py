"""The formats of files of points: one entry each, found by the suffix of a file or by what it holds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from formulations.motion.files.csv_points import read_csv, write_csv
from formulations.motion.files.joint_trajectory import read_json, read_yaml, write_json, write_yaml
from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.files.npz import read_npz, write_npz
from formulations.problem.errors import InputError
from formulations.robot.text.files import shown

PIECES = ".pieces.json"  # a motion rather than points: formulations.motion.files.pieces


@dataclass(frozen=True)
class Format:
    """A way to write points.

    Attributes
    ----------
    name : str
        For people.
    suffixes : tuple of str
        Of its files; the first is the usual one.
    write : callable
        MotionPoints -> bytes.
    read : callable
        bytes and the name of the file -> MotionPoints, not checked yet.
    """

    name: str
    suffixes: tuple[str, ...]
    write: Callable[[MotionPoints], bytes]
    read: Callable[[bytes, str], MotionPoints]


CSV = Format("CSV", (".csv", ".txt"), write_csv, read_csv)
JSON = Format("JointTrajectory, JSON", (".json",), write_json, read_json)
YAML = Format("JointTrajectory, YAML", (".yaml", ".yml"), write_yaml, read_yaml)
NPZ = Format("NPZ", (".npz",), write_npz, read_npz)
FORMATS = (CSV, JSON, YAML, NPZ)


def is_pieces(path: str | Path) -> bool:
    """Whether a file of this name holds exact pieces.

    Parameters
    ----------
    path : str or Path
        The file; it is not touched.

    Returns
    -------
    bool
        By the end of its name, ``.pieces.json``.
    """
    return Path(path).name.lower().endswith(PIECES)


def format_to_write(path: str | Path) -> Format | None:
    """Find the format that a file shall have.

    Parameters
    ----------
    path : str or Path
        The file, by its suffix.

    Returns
    -------
    Format or None
        None stands for exact pieces.

    Raises
    ------
    InputError
        No format has this suffix.
    """
    if is_pieces(path):
        return None
    suffix = Path(path).suffix.lower()
    for entry in FORMATS:
        if suffix in entry.suffixes and suffix != ".txt":
            return entry
    known = ", ".join(entry.suffixes[0] for entry in FORMATS)
    raise InputError(f"{path}: a motion is written as {known} or {PIECES}, not {shown(suffix)}")


def format_to_read(path: str | Path, data: bytes) -> Format:
    """Find the format that a file has.

    Parameters
    ----------
    path : str or Path
        The file; a suffix that is known tells the format.
    data : bytes
        What it holds: this tells the format where the suffix does not.

    Returns
    -------
    Format
        CSV if nothing speaks for another one.
    """
    suffix = Path(path).suffix.lower()
    for entry in FORMATS:
        if suffix in entry.suffixes:
            return entry
    start = data[:1000].removeprefix(b"\xef\xbb\xbf").lstrip()
    if start.startswith(b"PK"):
        return NPZ
    if start.startswith((b"{", b"[")):
        return JSON
    is_yaml = start.startswith((b"---", b"joint_", b"points:", b"trajectory:", b"header:"))
    return YAML if is_yaml else CSV
