"""A finished proof as plain data, and on disk: JSON, every float as hexadecimal text, so nothing is
lost.

    format, family, name; waypoints, limits (null: unlimited), position_slack [rad]; seconds: the bound
    short      null, or for a middle segment of 3-5-3 on which nothing moves: tau, and what discards
               T2 <= tau, from the longest T1 down: ["p", lo, hi, joint, order, place, sign] a limit
               inside it, ["l", lo, hi] the last segment, for T1 in [lo, hi]
    horizon    null, or for every motion, whatever its family ("every-motion"): H [s], and events as
               ``every_motion.events`` has them
    events     in depth-first order (see ``log``), the first letter says which:
               ["T"] ["E"] ["S", k, value] ["L", rows] ["B", k, value, rows] ["A", k, value, rows]
               without rows: those of the event before
    a row      ["p", joint, segment, order, place, sign, multiplier]   a limit inside a piece
               ["j", joint, segment, sign, multiplier]                 the jerk across an open segment
               ["t", multiplier] total   ["f", multiplier] first   ["l", multiplier] last

Joints and segments count from 0. ``compare.check_certificate`` replays it in ball arithmetic.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.errors import InputError
from formulations.problem.problem import Problem
from formulations.proofs.events import ABOVE, BELOW, EMPTY, LEAF, SPLIT, TURN
from formulations.proofs.proof import Proof
from formulations.proofs.rows import (
    FIRST,
    JOINT,
    JUMP,
    KIND,
    LAST,
    MULTIPLIER,
    ORDER,
    PLACE,
    SCALE,
    SEGMENT,
    SIGN,
    TOTAL,
)

FORMAT = "timebound certificate 1"
_LETTERS = {TURN: "T", EMPTY: "E", LEAF: "L", BELOW: "B", ABOVE: "A", SPLIT: "S"}
_ALONE = {TOTAL: "t", FIRST: "f", LAST: "l"}


def certificate_of(
    problem: Problem,
    seconds: float,
    events: list[list[Any]] | None = None,
    short: dict[str, Any] | None = None,
    horizon: float | None = None,
) -> dict[str, Any]:
    """The certificate of a bound [s]; without events, that of displacement over speed.

    horizon: H [s], if it is a bound of every motion (``relaxation.record``), not of the family alone.
    """
    limits = problem.limits
    return {
        "format": FORMAT,
        "family": problem.family if horizon is None else "every-motion",
        "name": problem.name,
        "waypoints": _hex(problem.waypoints),
        "limits": {
            "velocity": _hex(limits.velocity),
            "acceleration": _hex(limits.acceleration),
            "jerk": _hex(limits.jerk),
            "position": _hex(limits.position),
        },
        "position_slack": problem.position_slack.hex(),
        "seconds": seconds.hex(),
        "short": short,
        "horizon": None if horizon is None else horizon.hex(),
        "events": events or [],
    }


def certificate_of_proof(problem: Problem, proof: Proof) -> dict[str, Any]:
    """The certificate of what a recorded proof has proved."""
    return certificate_of(problem, proof.seconds, _events(problem, proof), _short(problem, proof))


def write_certificate(path: str | Path, certificate: dict[str, Any]) -> None:
    """Write a certificate whole or not at all. Raises InputError in one line."""
    path = Path(path)
    head = json.dumps({key: value for key, value in certificate.items() if key != "events"}, indent=1)
    lines = ",\n".join(json.dumps(event, separators=(",", ":")) for event in certificate["events"])
    temporary = path.with_name(path.name + ".part")
    try:
        temporary.write_text(f'{head[:-2]},\n "events": [\n{lines}\n]\n}}\n', "utf-8")
        os.replace(temporary, path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None


def _hex(values: Array) -> Any:
    """Nested lists of hexadecimal floats; null for no limit."""
    if values.ndim > 1:
        return [_hex(row) for row in values]
    return [float(x).hex() if np.isfinite(x) else None for x in values]


def _short(problem: Problem, proof: Proof) -> Any:
    if proof.setup.short is None:
        return None
    tau, leaves = proof.setup.short
    discards: list[list[Any]] = []
    for lo, hi, j, order, place, sign in leaves.tolist():
        where = [lo.hex(), hi.hex()]
        if order:
            joint = problem.moving_joints[int(j)]
            discards.append(["p", *where, joint, int(order), place.hex(), int(sign)])
        else:
            discards.append(["l", *where])
    return {"tau": tau.hex(), "discards": discards}


def _events(problem: Problem, proof: Proof) -> list[list[Any]]:
    if proof.setup.anytime is not None:
        return proof.setup.anytime.events
    log = proof.log()
    moving = problem.moving_joints
    events: list[list[Any]] = []
    before = b""
    for (code, k, count), value, rows in zip(log.codes.tolist(), log.values, log.rows, strict=True):
        event: list[Any] = [_LETTERS[code]]
        if code in (BELOW, ABOVE, SPLIT):
            event += [k, float(value).hex()]
        if code in (BELOW, ABOVE, LEAF):
            same = rows[:count].tobytes()
            if same != before:
                event.append([_row(row, moving) for row in rows[:count].tolist()])
            before = same
        events.append(event)
    return events


def _row(row: list[float], moving: list[int]) -> list[Any]:
    multiplier = (row[MULTIPLIER] / row[SCALE]).hex()
    if row[KIND] in _ALONE:
        return [_ALONE[row[KIND]], multiplier]
    joint, segment, sign = moving[int(row[JOINT])], int(row[SEGMENT]), int(row[SIGN])
    if row[KIND] == JUMP:
        return ["j", joint, segment, sign, multiplier]
    return ["p", joint, segment, int(row[ORDER]), row[PLACE].hex(), sign, multiplier]
