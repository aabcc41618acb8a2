"""A proof written for people: the inequalities that add up to it, each with its multiplier.

Segments, joints and waypoints count from 1. T2 is the duration of segment 2, T2..4 that of segments 2 to 4;
v5(2) and a5(2) are the velocity and the acceleration of joint 5 at waypoint 2, or v[elbow](2) and a[elbow](2)
where joints have names. e5(2) is the offset of its position from the middle of the zone there.
"""

from __future__ import annotations

from typing import Any

from compare.check_certificate.balls import Interval, R
from compare.check_certificate.demands import ClaimedDemands
from compare.check_certificate.families.every_motion.relaxation import Relaxation
from compare.check_certificate.families.every_motion.setting import PRODUCTS, LegName, Variable
from compare.check_certificate.families.every_motion.terms import Inequality
from compare.check_certificate.reading import number
from compare.check_certificate.tool.words import chain_in_words, tool_in_words

KINDS = {
    "h": "the time assumed",
    "b": "the earliest time of an arrival",
    "l": "the latest time of an arrival",
    "s": "1/T between its bounds",
    "t": "1/T is convex",
    "c": "T^2 beside T and 1/T",
    "w": "T a between bounds",
    "m": "the offset in a zone over T, between bounds",
    "v": "speed while the acceleration fades",
    "a": "speed that can be gained",
    "r": "room to stop",
    "d": "distance, with a piece at top speed",
    "k": "distance",
    "S": "T^2 between its bounds",
    "T": "T^2 is convex",
    "C": "T^3 beside T and T^2",
    "g": "T v between bounds",
    "x": "T^2 a between bounds",
    "j": "acceleration that can be gained",
    "e": "the duration of several segments is their sum",
    "V": "speed while the acceleration fades",
    "R": "room to stop, times T",
    "D": "distance, with a piece at top speed, times T",
    "K": "distance, times T",
}


def demands_in_words(demands: ClaimedDemands) -> str:
    """Say what the motions of a claim have to keep beside waypoints, limits and rest at both ends.

    Parameters
    ----------
    demands : ClaimedDemands
        Of the claim.

    Returns
    -------
    str
        Empty where there is nothing else; otherwise it begins with " with".
    """
    n, waits = len(demands.durations), [bool(wait > 0) for wait in demands.waits]
    limits = zip(demands.velocity, demands.acceleration, demands.jerk, demands.position, strict=True)
    first, *others = [tuple(_texts(row) for row in rows) for rows in limits]
    found = [
        _count(
            [any(bool(lo < hi) for lo, hi in row) for row in demands.waypoints], "zones", "waypoint"
        ),
        _count([_timed(x) for x in demands.passages[1:]], "times of arrival", "waypoint"),
        _count([_timed(x) for x in demands.durations], "times", "segment"),
        _count(waits, "waits", "waypoint"),
        _count(
            [s and not w for s, w in zip(demands.stops, waits, strict=True)][1:n], "stops", "waypoint"
        ),
        _count([row != first for row in others], "limits of their own", "segment"),
        "limits that differ by direction" if _one_sided(demands) else "",
        "the same state at both ends" if demands.cyclic else _ends(demands),
        *tool_in_words(demands.tool),
    ]
    return f" with {', '.join(x for x in found if x)}" if any(found) else ""


def _count(places: list[bool], what: str, where: str) -> str:
    """Name a demand and the number of places that have it."""
    number = sum(places)
    return f"{what} at {number} {where}{'s' if number > 1 else ''}" if number else ""


def _timed(interval: Interval) -> bool:
    return bool(interval[0] > 0) or interval[1] is not None


def _texts(row: list[Any]) -> list[str]:
    """Limits as text: exact numbers that are equal have the same."""
    return [str(x) for x in row]


def _one_sided(demands: ClaimedDemands) -> bool:
    """Whether a limit of velocity or acceleration differs by direction."""
    pairs = (pair for rows in (demands.velocity, demands.acceleration) for row in rows for pair in row)
    return any((lo is None) != (hi is None) or (hi is not None and hi != -lo) for lo, hi in pairs)


def _ends(demands: ClaimedDemands) -> str:
    """Name the ends that are not at rest."""
    moving = [
        any(
            not (lo == 0 and hi == 0)
            for lo, hi in (*v, *(a if demands.jerk[end].count(None) == 0 else ()))
        )
        for end, (v, a) in zip(
            (0, -1), zip(demands.end_velocity, demands.end_acceleration, strict=True), strict=True
        )
    ]
    where = [name for name, one in zip(("start", "end"), moving, strict=True) if one]
    return f"a state of its own at the {' and the '.join(where)}" if where else ""


def proof_in_words(checker: Relaxation) -> list[str]:
    """Write the last sum of a proof, and of each of its parts, in SI units.

    Parameters
    ----------
    checker : Relaxation
        After its replay.

    Returns
    -------
    list of str
        A line per inequality, after the chain to a limited tool.
    """
    lines = chain_in_words(checker.claim.demands())
    for part in checker.tally.ends:
        if part.splits:
            where = [
                f"{_name(key, part)} {'>=' if side else '<='} {float(value):.6g}"
                for key, side, value in part.splits
            ]
            lines.append(f"where {', '.join(where)}:")
        lines += _sum_in_words(part)
    return lines


def _sum_in_words(checker: Relaxation) -> list[str]:
    """A line per inequality of the last sum of a part."""
    lines = []
    for raw in checker.sum:
        of = KINDS[str(raw[0])]
        if str(raw[0]) in "wmvardkgxjVRDK":
            of += f", joint {checker.claim.joint_name(raw[1])}"
        lines.append(
            f"  {float(number(raw[-1])):.6g} x ({_inequality(checker.row(raw), checker)})  [{of}]"
        )
    return lines


def _inequality(row: Inequality, checker: Relaxation) -> str:
    """One inequality: its terms that are not zero, and its right-hand side."""
    terms = [(float(x), _name(key, checker)) for key, x in row[0].items() if not bool(x == R(0))]
    text = " ".join(f"{'-' if x < 0 else '+'} {abs(x):.6g} {what}" for x, what in terms)
    return f"{text.removeprefix('+ ')} <= {float(row[1]):.6g}"


def _number(k: LegName) -> str:
    """The number of a segment or a waypoint, or of the first and the last segment of a leg over several."""
    return f"{k + 1}" if isinstance(k, int) else f"{k[0] + 1}..{k[1]}"


def _name(key: Variable, checker: Relaxation) -> str:
    """A variable as the module's docstring names it."""
    kind, k = key[0], _number(key[1])
    if kind in ("T", "u", "q", "r"):
        return {"T": f"T{k}", "u": f"(1/T{k})", "q": f"T{k}^2", "r": f"T{k}^3"}[kind]
    j = checker.claim.joint_name(key[2])
    if checker.claim.names:
        j = f"[{j}]"
    if kind in PRODUCTS:  # at the waypoint where the segment starts, or at the one where it ends
        i = checker.waypoint(key[1], key[3]) + 1
        state = f"{PRODUCTS[kind][1]}{j}({i})"
        return {
            "W": f"T{k} {state}", "g": f"T{k} {state}", "X": f"T{k}^2 {state}", "p": f"{state}/T{k}",
        }[kind]  # fmt: skip
    return f"{kind}{j}({k})"
