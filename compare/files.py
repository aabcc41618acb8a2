"""Where results go on disk: folders that can be written to, files that are whole or not there."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from formulations import InputError
from formulations.problem.files import write_text

__all__ = ["output_folder", "write_json", "write_text"]


def output_folder(path: str | Path) -> Path:
    """Make a folder, if need be, and make sure that it can be written to.

    Parameters
    ----------
    path : str or Path
        The folder, as given by ``--out``.

    Returns
    -------
    Path
        The same folder.

    Raises
    ------
    InputError
        It cannot be made or written to; the message is one line.
    """
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / ".writable"
        probe.write_bytes(b"timebound")
        probe.unlink()
    except OSError as error:
        raise InputError(f"--out: {path}: cannot be written: {error.strerror or error}") from None
    return folder


def write_json(path: str | Path, data: Any) -> None:
    """Write strict JSON (no NaN, no infinity), whole or not at all.

    Parameters
    ----------
    path : str or Path
        The file; it is replaced if it is there.
    data : Any
        Plain data: dictionaries, lists, text, finite numbers, booleans, None.
    """
    write_text(path, json.dumps(data, indent=2, allow_nan=False) + "\n")
