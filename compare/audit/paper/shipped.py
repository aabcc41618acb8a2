"""The papers that are shipped, each in compare/papers/KEY/printed.toml, and files of other papers."""

from __future__ import annotations

import os
import tomllib
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from compare.audit.paper.reader import parse_papers
from compare.audit.paper.records import Paper
from formulations import InputError
from formulations.problem.toml_file.toml_text import LARGEST
from formulations.robot.text.files import decode, nearest_of, read_bytes


def _shipped_files() -> dict[str, tuple[str, str]]:
    """Case and text of each compare/papers/KEY/printed.toml, by KEY."""
    found = {}
    # from ``compare``: ``compare.papers`` imports this module
    for folder in (files("compare") / "papers").iterdir():
        entry = folder / "printed.toml"
        if folder.is_dir() and entry.is_file():
            text = entry.read_text("utf-8")
            try:
                case = tomllib.loads(text).get("case", folder.name)
            except ValueError as error:
                raise InputError(f"{entry}: not valid TOML: {error}") from None
            found[folder.name] = str(case), text
    return found


_SHIPPED = _shipped_files()
CASE_OF: dict[str, str] = {key: case for key, (case, _) in sorted(_SHIPPED.items())}
"""Case of each shipped paper, by its author and year: wang_2025 -> sr4c."""
PAPERS: tuple[str, ...] = tuple(sorted(CASE_OF.values()))
"""Names of the shipped papers: those of their cases."""


def published_text(name: str) -> str:
    """Read the TOML text of a shipped paper.

    Parameters
    ----------
    name : str
        Its case (sr4c) or its author and year (wang_2025).

    Returns
    -------
    str
    """
    return next(text for key, (case, text) in _SHIPPED.items() if name in (key, case))


def load_papers(name_or_file: str) -> list[Paper]:
    """Read a paper and its variants.

    Parameters
    ----------
    name_or_file : str
        Case (sr4c) or author and year (wang_2025) of a shipped paper, or the path of a TOML file.

    Returns
    -------
    list of Paper
        The paper as printed comes first; each variant is another reading of one waypoint.

    Raises
    ------
    InputError
        One line that names the key.
    """
    case = CASE_OF.get(name_or_file, name_or_file)
    if case in PAPERS:
        return list(_shipped(case))
    path = Path(name_or_file)
    if not os.path.exists(path):  # Path.exists raises for a name that is too long
        known = [*PAPERS, *CASE_OF]
        near = nearest_of(name_or_file, known)
        meant = f"; did you mean {near!r}?" if near else ""
        raise InputError(
            f"{path!s:.200}: no such file, and no paper of that name (papers: {', '.join(PAPERS)}){meant}"
        )
    return parse_papers(decode(read_bytes(path, largest=LARGEST), str(path)), path.stem)


@cache
def _shipped(case: str) -> tuple[Paper, ...]:
    return tuple(parse_papers(published_text(case), case))


def settings(name: str) -> dict[str, dict[str, Any]]:
    """What the tables and figures of a shipped paper need beside the audit.

    Parameters
    ----------
    name : str
        Its case (sr4c) or its author and year (wang_2025).

    Returns
    -------
    dict
        Tables by name (``settings_format.SETTINGS``); each says in ``where`` which table or section it is.
    """
    return load_papers(name)[0].settings
