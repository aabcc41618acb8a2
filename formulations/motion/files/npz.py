"""Points of a motion as arrays of NumPy in one file (.npz): nothing is lost.

The arrays are ``time`` (n_points,), ``position``, ``velocity``, ``acceleration`` (n_points, dof)
[s, rad, rad/s, rad/s^2] and ``joint_names`` (dof,). Objects of Python are never loaded.
"""

from __future__ import annotations

import io
import re
import sys
import zipfile
import zlib
from typing import Any

import numpy as np

from formulations.motion.files.checked import QUANTITIES, named, numbered
from formulations.motion.files.motion_points import MotionPoints
from formulations.problem.errors import InputError
from formulations.robot.text.files import known_names, shown

_LARGEST = 1_000_000_000  # bytes of all arrays
_LONGEST_ITEM = 4000  # bytes of a name or a number
_MOST_MEMBERS = 1000  # far more than are known, for the bytes of numbers may look like an entry
_LONGEST_HEADER = 10_000  # bytes
_HEADER = re.compile(
    rb"\s*\{\s*'descr'\s*:\s*'([<>|=]?[fiuUb]\d{1,9})'\s*,\s*'fortran_order'\s*:\s*(False|True)\s*,"
    rb"\s*'shape'\s*:\s*\(([\d, ]*)\)\s*,?\s*\}\s*"
)
_KEYS = ("time", *QUANTITIES, "joint_names")


def write_npz(points: MotionPoints) -> bytes:
    """Write points as an NPZ file.

    Parameters
    ----------
    points : MotionPoints
        The points, checked.

    Returns
    -------
    bytes
        The file.
    """
    values = (points.positions, points.velocities, points.accelerations)
    arrays: dict[str, Any] = {"time": points.times}
    arrays |= {key: value for key, value in zip(QUANTITIES, values, strict=True) if value is not None}
    names = points.names or numbered(points.positions.shape[1], "joint_")
    stream = io.BytesIO()
    np.savez(stream, joint_names=np.array(names), allow_pickle=False, **arrays)
    return stream.getvalue()


def read_npz(data: bytes, file: str) -> MotionPoints:
    """Read points from an NPZ file.

    Parameters
    ----------
    data : bytes
        A file.
    file : str
        Its name, for messages.

    Returns
    -------
    MotionPoints
        Not checked yet.

    Raises
    ------
    InputError
        Names the array.
    """
    arrays = _arrays(data, file)
    for key in ("time", "position"):
        if key not in arrays:
            raise InputError(f"{file}: array {key!r} is missing")
    names = arrays.pop("joint_names", np.array([], dtype=np.str_))
    if names.dtype.kind != "U" and names.size:
        raise InputError(f"{file}: joint_names: expected text, got {names.dtype}")
    letters = np.ascontiguousarray(names.astype(names.dtype.newbyteorder("="))).view(np.uint32)
    if names.size and letters.max() > sys.maxunicode:
        raise InputError(f"{file}: joint_names: holds what is no letter")
    for key, array in arrays.items():
        if array.dtype.kind not in "fiu":
            raise InputError(f"{file}: {key}: expected numbers, got {array.dtype}")
        rank = 1 if key == "time" else 2
        if array.ndim != rank or len(array) != len(arrays["time"]):
            expected = "(n_points,)" if rank == 1 else "(n_points, n_joints)"
            raise InputError(f"{file}: {key}: expected the shape {expected}, got {array.shape}")
        if key != "time" and array.shape != arrays["position"].shape:
            raise InputError(
                f"{file}: {key}: the shape {array.shape} is not that of position, "
                f"{arrays['position'].shape}"
            )
    found = [arrays[key].astype(np.float64) if key in arrays else None for key in ("time", *QUANTITIES)]
    time, position, velocity, acceleration = found
    assert time is not None
    assert position is not None
    return MotionPoints(
        time,
        position,
        velocity,
        acceleration,
        named(tuple(str(name) for name in names.ravel()), "joint_"),
    )


def _arrays(data: bytes, file: str) -> dict[str, Any]:
    """All arrays; their sizes are known before memory is asked for."""
    arrays = {}
    if data.count(b"PK\1\2") > _MOST_MEMBERS:  # entries of its directory
        raise InputError(f"{file}: more than {_MOST_MEMBERS} arrays")
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            size = sum(member.file_size for member in members)
            if size > _LARGEST:
                raise InputError(f"{file}: unpacked {size} bytes; at most {_LARGEST} are read")
            for member in members:
                key = member.filename.removesuffix(".npy")
                if key not in _KEYS:
                    raise InputError(f"{file}: unknown array {shown(key)}; {known_names(key, _KEYS)}")
                if key in arrays:
                    raise InputError(f"{file}: array {shown(key)} is there twice")
                with archive.open(member) as stream:
                    arrays[key] = _array(stream, member.file_size, f"{file}: {key}")
    except InputError:
        raise
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, NotImplementedError, RuntimeError,
            ValueError, SyntaxError, TypeError, OverflowError, RecursionError, MemoryError,
            UnicodeError, LookupError) as error:  # fmt: skip
        raise InputError(f"{file}: not an NPZ file: {type(error).__name__}: {error}") from None
    return arrays


def _array(stream: Any, size: int, place: str) -> Any:
    """One array; what its header claims is compared with its size before more is unpacked."""
    shape, by_columns, dtype = _header(stream, place)
    rest = size - stream.tell()
    if dtype.itemsize > _LONGEST_ITEM:
        raise InputError(f"{place}: {dtype}: at most {_LONGEST_ITEM} bytes of a value are read")
    count = 1
    for length in shape:
        count *= int(length)
    if len(shape) > 2 or count * dtype.itemsize != rest:
        raise InputError(f"{place}: the shape {shape} of {dtype} does not fit {rest} bytes")
    body = stream.read()
    if len(body) != rest:
        raise InputError(f"{place}: {len(body)} bytes are there, {rest} are expected")
    if count == 0:
        return np.empty(shape, dtype=dtype)
    return np.frombuffer(body, dtype=dtype).reshape(shape, order="F" if by_columns else "C")


def _header(stream: Any, place: str) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Shape, whether columns come first, and type. NumPy's own reader evaluates the header and may warn."""
    magic = stream.read(8)
    if magic[:7] not in (b"\x93NUMPY\1", b"\x93NUMPY\2"):
        raise InputError(f"{place}: expected an array of the NPY format 1 or 2, got {shown(magic)}")
    length = int.from_bytes(stream.read(2 * magic[6]), "little")
    if length > _LONGEST_HEADER:
        raise InputError(f"{place}: a header of {length} bytes; at most {_LONGEST_HEADER} are read")
    header = stream.read(length)
    found = _HEADER.fullmatch(header)
    if found is None:
        raise InputError(f"{place}: expected numbers or text, got {shown(header.decode('latin-1'))}")
    kind, by_columns, shape = (part.decode() for part in found.groups())
    lengths = tuple(int(part) for part in shape.split(",") if part.strip())
    return lengths, by_columns == "True", np.dtype(kind)
