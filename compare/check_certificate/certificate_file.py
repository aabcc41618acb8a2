"""A certificate as a file, and whether it is about a given problem."""

from __future__ import annotations

import json
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.claim import FORMAT
from compare.check_certificate.demands import KEYS, TOOL

_LARGEST_FILE = 400_000_000  # bytes
_MOST_LISTS = 10_000_000
_HEAD = 10_000  # bytes in which a certificate names its format


def read(path: Path) -> Any:
    """Read the data of a certificate.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    Any
        Its JSON, not yet judged.

    Raises
    ------
    BadInput
        It cannot be read, is too large, or is not JSON.
    """

    def no_constant(name: str) -> Any:
        raise BadInput(f"{path}: {name} in the file")

    try:
        if path.stat().st_size > _LARGEST_FILE:
            raise BadInput(f"{path}: larger than {_LARGEST_FILE} bytes")
        data = path.read_bytes()
        if FORMAT.encode() not in data[:_HEAD]:
            raise BadInput(f"{path}: not a certificate: {FORMAT!r} is not in its first {_HEAD} bytes")
        if data.count(b"[") > _MOST_LISTS:
            raise BadInput(f"{path}: more than {_MOST_LISTS} events and rows")
        return json.loads(data.decode("utf-8"), parse_constant=no_constant)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        raise BadInput(f"{path}: not valid JSON: {str(error)[:100]}") from None


def compare_with(data: Any, file_or_case: str) -> None:
    """Refuse a certificate of another problem.

    This is the one place that uses the project's own loader.

    Parameters
    ----------
    data : Any
        A certificate that was verified.
    file_or_case : str
        The problem it must be about.

    Raises
    ------
    Refused
        Waypoints, limits, conditions or family differ.
    BadInput
        The problem cannot be read.
    """
    from formulations import InputError, load
    from formulations.problem.demands import Demands

    try:
        problem = load(file_or_case)
    except InputError as error:
        raise BadInput(str(error)) from None

    def same(key: str, ours: Any, theirs: Any) -> None:
        ours = [[float(x) for x in row] for row in ours]
        theirs = [[-inf if x is None else float.fromhex(x) for x in row] for row in theirs]
        ours = [[-inf if abs(x) == inf else x for x in row] for row in ours]
        need(ours == theirs, f"{key} differ from those of {file_or_case}")

    limits, claimed = problem.limits, data["limits"]
    need(
        data["family"] in (problem.family, "every-motion"),
        f"family differs from that of {file_or_case}",
    )
    same("waypoints", problem.waypoints, data["waypoints"])
    for key in ("velocity", "acceleration", "jerk"):
        same(f"limits.{key}", [getattr(limits, key)], [claimed[key]])
    same("limits.position", limits.position, claimed["position"])
    demands = data.get("demands")
    if demands is None:
        need(problem.plain, f"the certificate is about no conditions, {file_or_case} has some")
    else:
        asked = (
            problem.conditions
        )  # the fastest motion is bounded without a total time that is asked for
        ways = [Demands.of(problem, one) for one in (asked, asked.without_total(problem))]
        for key in KEYS:
            ours = [_floats(np.asarray(getattr(one, key)).tolist()) for one in ways]
            need(_floats(demands[key]) in ours, f"demands: {key} differ from those of {file_or_case}")
        tool = _tool(problem.tool, ways[0]) if ways[0].on_tool else None
        theirs = demands.get(TOOL)
        if theirs is not None:  # the places are a part of the proof, not of the problem
            theirs = {key: _floats(one) for key, one in theirs.items() if key != "passes"}
        need(theirs == tool, f"demands: the tool differs from that of {file_or_case}")
    slack = float.fromhex(data["position_slack"])
    need(slack >= problem.position_slack, "position_slack is less than the check allows")


def _tool(chain: Any, demands: Any) -> Any:
    """The chain to the tool of a problem and the limits on it, under the keys of a certificate."""
    from formulations.kinematics.plain_chain import plain_chain

    speed, radius = (_floats(x.tolist()) for x in (demands.tool_speed, demands.tool_radius))
    return {**plain_chain(chain), "speed": speed, "radius": radius}


def _floats(value: Any) -> Any:
    """Nested lists with numbers for hexadecimal text, and null for what is infinite."""
    if isinstance(value, list):
        return [_floats(x) for x in value]
    if isinstance(value, dict):
        return {key: _floats(x) for key, x in value.items()}
    if isinstance(value, str):
        return float.fromhex(value)
    return None if isinstance(value, float) and abs(value) == inf else value
