"""Tuned constants as plain data: the file that ``timebound tune`` writes, and the one that is shipped."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from importlib.resources import files
from pathlib import Path

from compare.plain_data import typed_or_line
from formulations import InputError
from formulations.problem.toml_file.toml_text import LARGEST, parse_toml
from formulations.robot.text.files import decode, read_bytes, shown

_MOST = 1e12  # size of a constant
Constants = dict[str, float | int]
"""Constants of one algorithm by name."""


def read_constants(file: str | Path | None = None) -> dict[str, Constants]:
    """Read tuned constants.

    Parameters
    ----------
    file : str or Path, optional
        What ``timebound tune`` wrote; the shipped file if left out.

    Returns
    -------
    dict of str to dict
        By swarm; a swarm without constants to tune has an empty entry.

    Raises
    ------
    InputError
        If the file cannot be read; the message names the swarm and the constant.
    """
    where = "tuned.toml" if file is None else str(file)
    if file is None:
        text = (files("compare.benchmark.tuning") / "tuned.toml").read_text("utf-8")
    else:
        text = decode(read_bytes(Path(file), largest=LARGEST), where)
    data = parse_toml(text, where)
    if "constants" not in data:
        raise InputError(f"{where}: constants: missing; `timebound tune` writes such files")
    found: dict[str, Constants] = typed_or_line(
        dict[str, dict[str, int | float]], data["constants"], where
    )
    for swarm, constants in found.items():
        for name, value in constants.items():
            if abs(value) > _MOST:
                raise InputError(
                    f"{where}: constants.{swarm}.{name}: {shown(value)} is beyond {_MOST:g}"
                )
    return found


def constants_for(swarms: Iterable[str], file: str | Path | None = None) -> dict[str, Constants]:
    """Return the tuned constants of the swarms of a plan.

    Parameters
    ----------
    swarms : iterable of str
    file : str or Path, optional
        As in `read_constants`.

    Returns
    -------
    dict of str to dict

    Raises
    ------
    InputError
        If one of the swarms has not been tuned.
    """
    known = read_constants(file)
    missing = [name for name in swarms if name not in known]
    if missing:
        raise InputError(
            f"--tracks tuned: {', '.join(missing)}: not tuned in {file or 'the shipped constants'};"
            f" `timebound tune --swarms {','.join(missing)}` does it"
        )
    return {name: known[name] for name in swarms}


def constants_text(made: Mapping[str, str | int], constants: Mapping[str, Constants]) -> str:
    """Return tuned constants as TOML.

    Parameters
    ----------
    made : mapping of str to str or int
        How they were made.
    constants : mapping of str to dict
        By swarm.

    Returns
    -------
    str
    """
    lines = ["# Written by `timebound tune`; see compare/benchmark/tuning.", "", "[made]"]
    # JSON's words for text and numbers are TOML's too
    lines += [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in made.items()]
    for swarm, found in constants.items():
        lines += ["", f"[constants.{json.dumps(swarm, ensure_ascii=False)}]"]
        lines += [
            f"{json.dumps(name, ensure_ascii=False)} = {value!r}" for name, value in found.items()
        ]
    return "\n".join(lines) + "\n"
