"""Read a small text file whole, and say in one line why one cannot be read.

All readers of this package open files here alone. A file is refused before a byte of it is parsed when it
is a folder, a device or a pipe, when it is too large for its kind, or when it is not UTF-8.
"""

from __future__ import annotations

import difflib
import os
import re
import stat
from collections.abc import Iterable
from pathlib import Path

from formulations.problem.errors import InputError

_BOM = "\ufeff"
_MARKS = (  # the longer marks first: that of UTF-32 begins with that of UTF-16
    (b"\xff\xfe\x00\x00", "UTF-32"),
    (b"\x00\x00\xfe\xff", "UTF-32"),
    (b"\xff\xfe", "UTF-16"),
    (b"\xfe\xff", "UTF-16"),
)
_GROWTH = 100_000  # bytes
_SHOWN = 50  # characters of a value in a message
_COMPARED = 100  # characters of a name that are compared with known names
_LONGEST_NUMBER = 10_000  # characters
_NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)  # linear in the length


def read_bytes(path: str | Path, *, largest: int) -> bytes:
    """Read a file whole.

    Parameters
    ----------
    path : str or Path
        The file.
    largest : int
        Size that is still read [byte].

    Returns
    -------
    bytes
        What the file holds.

    Raises
    ------
    InputError
        The file is missing, too large, or not a regular file.
    """
    if not isinstance(path, str | os.PathLike):  # a number would be an open file
        raise InputError(f"{shown(path)}: not the name of a file")
    try:
        mode = os.stat(path)
        if not stat.S_ISREG(mode.st_mode):
            kind = "a folder" if stat.S_ISDIR(mode.st_mode) else "a device or a pipe"
            raise InputError(f"{path}: is {kind}, not a file")
        if mode.st_size > largest:
            raise InputError(f"{path}: {mode.st_size} bytes; at most {largest} are read")
        with open(path, "rb") as stream:
            # the memory asked for is what the file takes, and a little more if it grows meanwhile
            data = stream.read(min(largest, mode.st_size + _GROWTH) + 1)
    except InputError:
        raise
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    except (TypeError, ValueError):  # a null character in the name, say
        raise InputError(f"{shown(path)}: not the name of a file") from None
    if len(data) > min(largest, mode.st_size + _GROWTH):
        raise InputError(f"{path}: grew beyond {len(data) - 1} bytes while it was read")
    return data


def decode(data: bytes, file: str) -> str:
    """Turn the bytes of a file into text; a byte-order mark of UTF-8 is dropped.

    Parameters
    ----------
    data : bytes
        What a file holds.
    file : str
        Its name, for messages.

    Returns
    -------
    str
        The text.

    Raises
    ------
    InputError
        The bytes are empty, not UTF-8, or hold a null character.
    """
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            raise InputError(f"{file}: is {encoding}; save it as UTF-8")
    try:
        text = data.decode("utf-8").removeprefix(_BOM)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{file}: line {line}: byte 0x{data[error.start]:02x} is not UTF-8; save the file as UTF-8"
        ) from None
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise InputError(f"{file}: line {line}: holds a null character, so it is not a text file")
    if not text or text.isspace():
        raise InputError(f"{file}: is empty")
    return text


def number_of(text: str) -> float | None:
    """Read a decimal number as a person writes it.

    Parameters
    ----------
    text : str
        ``1.5``, ``-2`` or ``3e-4``, with spaces around it at most.

    Returns
    -------
    float or None
        None where the text is anything else: ``nan``, ``inf`` and ``1_000`` too.
    """
    if len(text) > _LONGEST_NUMBER:
        return None
    text = text.strip()
    return float(text) if _NUMBER.fullmatch(text) else None


def shown(value: object) -> str:
    """Show a value as a person would recognise it, cut to one short line.

    Parameters
    ----------
    value : object
        Anything that was read from a file.

    Returns
    -------
    str
        Its ``repr``, or the first characters of it.
    """
    try:
        text = repr(value[: 2 * _SHOWN] if isinstance(value, str) else value)
    except (ValueError, RecursionError):  # a whole number beyond 4300 digits
        return "a number of thousands of digits"
    return text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."


def nearest_of(name: str, known: Iterable[str], *, alike: float = 0.6) -> str | None:
    """Find the known name that a mistyped one was probably meant to be.

    Parameters
    ----------
    name : str
        A name that is not known.
    known : iterable of str
        The names that are.
    alike : float, optional
        Least similarity, from 0 to 1.

    Returns
    -------
    str or None
        None where no known name is alike.
    """
    names = {entry[:_COMPARED].lower(): entry for entry in reversed(list(known))}
    found = difflib.get_close_matches(name[:_COMPARED].lower(), names, n=1, cutoff=alike)
    return names[found[0]] if found else None


def known_names(name: str, known: Iterable[str]) -> str:
    """Say which names there are: the end of a message about an unknown one.

    Parameters
    ----------
    name : str
        A name that is not known.
    known : iterable of str
        The names that are.

    Returns
    -------
    str
        ``the nearest known one is 'a'``, or the first known names where none is alike.
    """
    names = list(known)
    nearest = nearest_of(name, names)
    if nearest is not None:
        return f"the nearest known one is {shown(nearest)}"
    if not names:
        return "none is known"
    rest = f" and {len(names) - 12} more" if len(names) > 12 else ""
    return f"known: {', '.join(shown(entry)[1:-1] for entry in names[:12])}{rest}"
