"""The certificate of a proof: plain data, and a JSON file with every float as hexadecimal text.

    format, family, name; names of the joints, none or one each; waypoints, limits (null: unlimited),
    position_slack [rad]; seconds: the bound
    short      null, or for a middle segment of 3-5-3 on which nothing moves: tau, and what discards
               T2 <= tau, from the longest T1 down: ["p", lo, hi, joint, order, place, sign] a limit
               inside it, ["l", lo, hi] the last segment, for T1 in [lo, hi]
    horizon    null, or for a bound of every motion ("every-motion"): H [s]; its events are those of
               ``every_motion.events``
    demands    null, or for a bound under conditions the arrays of ``formulations.problem.demands``, and
               ``tool`` where the tool is limited: chain, end, speed, radius, passes;
               ``without`` beside it: inner waypoints that the proof does not need
    events     in depth-first order (see ``events``), the first letter says which:
               ["T"] ["E"] ["S", k, value] ["L", rows] ["B", k, value, rows] ["A", k, value, rows]
               ["W", start, end, b, H] (4-3-4): what follows proves that segments start .. end - 1 take
               more than b seconds in every motion of at most H >= the bound; the whole comes last, as
               ["W", 0, n, bound, bound]. ["V", joint, end, value] there: a split of the velocity at the
               part's start (end 0) or end (1)
               an event without rows has those of the event before; the quintic's are in ``quintic.bound``
               a B-spline's ["T", lo, hi] states the times of the inner waypoints that a turn leaves
    a row      ["p", joint, segment, order, place, sign, multiplier]   a limit inside a piece (of a
                                                                       B-spline: a knot span)
               ["j", joint, segment, sign, multiplier]                 the jerk across an open segment
               ["w", start, end, multiplier]                           the least time of a part
               ["t", multiplier] total   ["f", multiplier] first   ["l", multiplier] last

Joints and segments count from 0. ``compare.check_certificate`` replays it in ball arithmetic, that of
a B-spline in arrays rounded outward.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from formulations.kinematics.plain_chain import plain_chain
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.problem.files import write_text
from formulations.problem.problem import Problem
from formulations.proofs.conditions import (
    FIRST,
    JOINT,
    JUMP,
    KIND,
    LAST,
    MULTIPLIER,
    ORDER,
    PART,
    PLACE,
    SCALE,
    SEGMENT,
    SIGN,
    TOTAL,
)
from formulations.proofs.events import ABOVE, BELOW, EMPTY, LEAF, SPLIT, TURN, Log
from formulations.proofs.part import PartBound
from formulations.proofs.proof import Proof
from formulations.proofs.tool.passing import places_passed

FORMAT = "timebound certificate 1"
_LETTER_OF_EVENT = {TURN: "T", EMPTY: "E", LEAF: "L", BELOW: "B", ABOVE: "A", SPLIT: "S"}
_LETTER_OF_ROW = {TOTAL: "t", FIRST: "f", LAST: "l"}


def certificate_of(
    problem: Problem,
    seconds: float,
    events: list[list[Any]] | None = None,
    short: dict[str, Any] | None = None,
    horizon: float | None = None,
    demands: Demands | None = None,
) -> dict[str, Any]:
    """Write down what proves a bound.

    Parameters
    ----------
    problem : Problem
        The problem that the bound is about.
    seconds : float [s]
        The bound.
    events : list, optional
        What proves it; without events, displacement over speed does.
    short : dict, optional
        For 3-5-3 with a middle segment on which nothing moves, see above.
    horizon : float [s], optional
        For a bound of every motion, not of the family alone.
    demands : Demands, optional
        What the motions have to keep beyond waypoints and limits.

    Returns
    -------
    dict
        Plain data, ready for ``json.dumps``.
    """
    limits = problem.limits
    return {
        "format": FORMAT,
        "family": problem.family if horizon is None else "every-motion",
        "name": problem.name,
        "names": list(problem.names),
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
        "demands": None if demands is None else _of_demands(demands),
        "events": events or [],
    }


def certificate_of_proof(problem: Problem, proof: Proof) -> dict[str, Any]:
    """Write down what a recorded attempt has proved so far.

    Parameters
    ----------
    problem : Problem
        The problem it is about.
    proof : Proof
        The attempt.

    Returns
    -------
    dict
        The certificate.
    """
    return certificate_of(problem, proof.seconds, _events(problem, proof), _short(problem, proof))


def write_certificate(path: str | Path, certificate: dict[str, Any]) -> None:
    """Write a certificate to a file, whole or not at all.

    Parameters
    ----------
    path : str or Path
        The file.
    certificate : dict
        Plain data.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    head = json.dumps({key: value for key, value in certificate.items() if key != "events"}, indent=1)
    lines = ",\n".join(json.dumps(event, separators=(",", ":")) for event in certificate["events"])
    write_text(path, f'{head[:-2]},\n "events": [\n{lines}\n]\n}}\n')


def _hex(values: Array) -> Any:
    """Nested lists of hexadecimal floats; null for no limit."""
    if values.ndim > 1:
        return [_hex(row) for row in values]
    return [float(x).hex() if np.isfinite(x) else None for x in values]


def _of_demands(demands: Demands) -> dict[str, Any]:
    """All arrays of the demands, floats as hexadecimal text."""
    found = {
        key: _hex(getattr(demands, key))
        for key in (
            *("waypoints", "velocity", "acceleration", "jerk", "position"),
            *("end_velocity", "end_acceleration", "waits", "durations", "passages"),
        )
    }
    tool = {"tool": _of_tool(demands)} if demands.on_tool else {}
    return {**found, "stops": demands.stops.tolist(), "cyclic": demands.cyclic, **tool}


def _of_tool(demands: Demands) -> dict[str, Any]:
    """The chain to the tool, pose by pose, and the limits on it."""
    chain = demands.problem.tool
    assert chain is not None  # conditions on the tool ask for it
    place = places_passed(demands, chain)
    return {
        **_hex_all(plain_chain(chain)),
        "speed": _hex(demands.tool_speed),
        "radius": _hex(demands.tool_radius),
        "passes": [
            [k, int(place.joint[k]), _hex(place.value[[k]]), [_hex(place.a[k]), _hex(place.b[k])]]
            for k in np.flatnonzero(place.joint >= 0).tolist()
        ],
    }


def _hex_all(value: Any) -> Any:
    """Plain data with hexadecimal text for floats."""
    if isinstance(value, dict):
        return {key: _hex_all(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_hex_all(one) for one in value]
    return value.hex() if isinstance(value, float) else value


def _short(problem: Problem, proof: Proof) -> Any:
    if proof.search.short is None:
        return None
    tau, leaves = proof.search.short
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
    if proof.search.anytime is not None:
        return proof.search.anytime.events
    moving, n = problem.moving_joints, problem.n_segments
    events: list[list[Any]] = []
    known = proof.search.parts
    for part in known:
        if part.log is not None:
            events.append(["W", part.start, part.end, part.seconds.hex(), part.horizon.hex()])
            events += _tree(part.log, (part.start, part.end), part.known, moving)
    if known:
        events.append(["W", 0, n, proof.L.hex(), proof.L.hex()])
    stated = proof.search.turns_cut
    return events + _tree(proof.log(), (0, n), known, moving, stated=stated)


def _tree(
    log: Log,
    part: tuple[int, int],
    known: tuple[PartBound, ...],
    moving: list[int],
    *,
    stated: bool = False,
) -> list[list[Any]]:
    """Events of one tree; variables beyond the part's segments are velocities at its free ends.

    stated: whether a turn states the box that it leaves.
    """
    start, end = part
    events: list[list[Any]] = []
    before = b""
    for (code, k, count), value, box, rows in zip(
        log.codes.tolist(), log.values, log.boxes, log.rows, strict=True
    ):
        event: list[Any] = [_LETTER_OF_EVENT[code]]
        if code == TURN and stated:
            event += _hex(box[:, 1:-1])
        if code == SPLIT and k >= end - start:
            side, j = divmod(k - (end - start), len(moving))
            event = ["V", moving[j], side if start > 0 else 1, float(value).hex()]
        elif code in (BELOW, ABOVE, SPLIT):
            event += [start + k, float(value).hex()]
        if code in (BELOW, ABOVE, LEAF):
            same = rows[:count].tobytes()
            if same != before:
                event.append([_row(row, start, known, moving) for row in rows[:count].tolist()])
            before = same
        events.append(event)
    return events


def _row(row: list[float], start: int, known: tuple[PartBound, ...], moving: list[int]) -> list[Any]:
    multiplier = (row[MULTIPLIER] / row[SCALE]).hex()
    if row[KIND] in _LETTER_OF_ROW:
        return [_LETTER_OF_ROW[row[KIND]], multiplier]
    if row[KIND] == PART:
        part = known[int(row[SEGMENT])]
        return ["w", part.start, part.end, multiplier]
    joint, segment, sign = moving[int(row[JOINT])], start + int(row[SEGMENT]), int(row[SIGN])
    if row[KIND] == JUMP:
        return ["j", joint, segment, sign, multiplier]
    return ["p", joint, segment, int(row[ORDER]), row[PLACE].hex(), sign, multiplier]
