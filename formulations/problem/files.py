"""Write a file whole or not at all: the one place for it, for problems, motions, proofs and reports."""

from __future__ import annotations

import os
from pathlib import Path

from formulations.problem.errors import InputError


def write_text(path: str | Path, text: str) -> None:
    """Write a text file whole or not at all.

    Parameters
    ----------
    path : str or Path
        The file; it is replaced if it is there.
    text : str
        All that the file shall hold, written as UTF-8.

    Raises
    ------
    InputError
        The file cannot be written; the message is one line that names it.
    """
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: str | Path, data: bytes) -> None:
    """Write a file whole or not at all.

    The bytes go to a file beside it, which then takes its name: a reader never sees half a file.

    Parameters
    ----------
    path : str or Path
        The file; it is replaced if it is there.
    data : bytes
        All that the file shall hold.

    Raises
    ------
    InputError
        The file cannot be written; the message is one line that names it.
    """
    path = Path(path)
    temporary = path.with_name(path.name + ".part")
    try:
        with temporary.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())  # or a power cut could leave the new name on an empty file
        os.replace(temporary, path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
