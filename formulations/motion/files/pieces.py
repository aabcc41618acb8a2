"""The exact polynomial pieces of a motion as JSON: nothing is lost.

    {"joint_names": ["elbow", "wrist"],
     "pieces": [{"seconds": 0.5, "coefficients": [[0.0, 0.0, 1.5], [0.0, 0.0, -0.5]]}, ...],
     "passage_times": [0.0, 1.25, 3.5]}

The coefficients of each joint are those of ascending powers of the time since the start of the piece
[rad/s^k]. Numbers have as many digits as they need to come back bit by bit. Without ``passage_times`` the
waypoints are passed where pieces meet.
"""

from __future__ import annotations

import json
import math
import re

import numpy as np

from formulations.motion.files.checked import named, numbered
from formulations.motion.trajectory import Trajectory
from formulations.problem.errors import InputError
from formulations.robot.text.entry import LARGEST_NUMBER, TextEntry
from formulations.robot.text.files import decode, shown
from formulations.robot.text.trees import parse_json

_LARGEST = 50_000_000  # bytes of a file that is read
_MOST_NUMBERS = 3_000_000
_MOST_COEFFICIENTS = 50  # per joint and piece
_PIECES = re.compile(rb'"pieces"\s*:')
_HEAD = 100_000  # bytes in which the pieces must begin


def holds_pieces(data: bytes) -> bool:
    """Whether a JSON file holds pieces, rather than points.

    Parameters
    ----------
    data : bytes
        The file.

    Returns
    -------
    bool
        Whether the key ``pieces`` is among its first 100,000 bytes.
    """
    return _PIECES.search(data, 0, _HEAD) is not None


def write_pieces(trajectory: Trajectory, names: tuple[str, ...] = ()) -> bytes:
    """Write a motion as pieces.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.
    names : tuple of str
        Names of the joints.

    Returns
    -------
    bytes
        The file.
    """
    data = {
        "joint_names": list(names or numbered(trajectory.dof, "joint_")),
        "pieces": [
            {"seconds": seconds, "coefficients": coefficients}
            for seconds, coefficients in zip(
                trajectory.durations.tolist(), trajectory.coefficients.tolist(), strict=True
            )
        ],
    }
    if trajectory.passages is not None:
        data["passage_times"] = trajectory.passages.tolist()
    return json.dumps(data, allow_nan=False).encode() + b"\n"


def read_pieces(data: bytes, file: str) -> tuple[Trajectory, tuple[str, ...]]:
    """Read a motion from pieces.

    Parameters
    ----------
    data : bytes
        A file.
    file : str
        Its name, for messages.

    Returns
    -------
    trajectory : Trajectory
        The motion, bit by bit as it was written.
    names : tuple of str
        Names of the joints; empty where they are only counted.

    Raises
    ------
    InputError
        Names the key and the value.
    """
    if len(data) > _LARGEST:
        raise InputError(f"{file}: {len(data)} bytes; pieces are read from at most {_LARGEST} bytes")
    top = parse_json(decode(data, file), file, most=_MOST_NUMBERS)
    entries = top.entries(("joint_names", "pieces", "passage_times"))
    if "pieces" not in entries:
        raise top.error("pieces is missing")
    pieces = [piece.entries(("seconds", "coefficients")) for piece in entries["pieces"].elements()]
    if not pieces:
        raise entries["pieces"].error("a motion needs one piece or more")
    names = (
        tuple(entry.text() for entry in entries["joint_names"].elements())
        if "joint_names" in entries
        else ()
    )
    durations, rows = [], []
    for entry, piece in zip(entries["pieces"].elements(), pieces, strict=True):
        for key in ("seconds", "coefficients"):
            if key not in piece:
                raise entry.error(f"{key} is missing")
        seconds = _number(piece["seconds"])
        if seconds <= 0.0:
            raise piece["seconds"].error(f"{seconds:g} is not positive")
        if seconds > LARGEST_NUMBER:
            raise piece["seconds"].error(f"{seconds:g} is beyond {LARGEST_NUMBER:g}")
        durations.append(seconds)
        joints = piece["coefficients"].elements()
        rows.append([[_number(number) for number in joint.elements()] for joint in joints])
        if not joints or len(joints) != (len(names) or len(rows[0])):
            raise piece["coefficients"].error(
                f"{len(joints)} joints where {len(names) or len(rows[0])} are expected"
            )
        for joint, numbers in zip(joints, rows[-1], strict=True):
            if not 1 <= len(numbers) <= _MOST_COEFFICIENTS:
                raise joint.error(
                    f"{len(numbers)} coefficients; from 1 to {_MOST_COEFFICIENTS} are read"
                )
    width = max(len(numbers) for row in rows for numbers in row)
    coefficients = np.array(
        [[numbers + [0.0] * (width - len(numbers)) for numbers in row] for row in rows]
    )
    passages = None
    if "passage_times" in entries:
        passages = np.array([_number(entry) for entry in entries["passage_times"].elements()])
    return Trajectory(np.array(durations), coefficients, passages), named(names, "joint_")


def _number(entry: TextEntry) -> float:
    """A finite number of any size: coefficients of short pieces are large."""
    value = entry.node.value
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise entry.error(f"expected a finite number, got {shown(value)}")
    return float(value)
