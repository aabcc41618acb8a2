"""What was found about a judged motion, as tables and sentences: the same in a terminal and on a page."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from formulations.assessment import Assessment
from formulations.motion.peaks import Peak, unit_of
from formulations.motion.smoothness import Jump

_LINES = 8  # of a table of what holds the motion up
_JOINED = {"linear": "straight lines", "cubic": "cubics", "quintic": "quintics"}


@dataclass(frozen=True)
class FoundTable:
    """A table of what was found; every cell is text.

    Attributes
    ----------
    header : list of str
    rows : list of list of str
    right : tuple of int
        Columns of numbers.
    """

    header: list[str]
    rows: list[list[str]]
    right: tuple[int, ...]


def opening(found: Assessment) -> list[str]:
    """Say how long the motion takes, how its points are joined, and which waypoints it passes.

    Parameters
    ----------
    found : Assessment

    Returns
    -------
    list of str
    """
    judged, count = found.judgement, len(found.problem.waypoints)
    pieces = len(judged.motion.durations)
    how = _JOINED.get(judged.interpolation)
    lines = [
        f"{judged.seconds:.6g} s; {pieces} exact polynomial{'s' if pieces > 1 else ''}"
        if how is None
        else f"{judged.seconds:.6g} s; {how} between {pieces + 1} points, as a controller joins them",
        f"{count - len(judged.missed)} of {count} waypoints passed within {judged.tolerance:g} rad",
    ]
    if judged.missed_total is not None:
        lines.append(f"it takes {judged.seconds:.9g} s; asked for were {judged.missed_total:.9g} s")
    lines += judged.unkept
    return lines


def fault_tables(found: Assessment) -> list[FoundTable]:
    """Make a table for each kind of fault that there is.

    Parameters
    ----------
    found : Assessment

    Returns
    -------
    list of FoundTable
        Broken limits, jumps, motion where there should be none, missed waypoints.
    """
    judged = found.judgement
    tables = []
    if judged.violations:
        header = ["broken limit", "joint", "time", "value", "limit", "factor"]
        rows = [_limit_row(found, peak) for peak in judged.violations]
        tables.append(FoundTable(header, rows, (2, 3, 4, 5)))
    jumps = [(jump, f"{jump.count} of {len(judged.motion.durations) - 1}") for jump in judged.jumps]
    rests = [(jump, _place(jump)) for jump in judged.not_at_rest]
    for title, found_jumps in (
        ("jump between pieces", jumps),
        ("not at rest" if judged.conditions.none else "not as asked for", rests),
    ):
        if found_jumps:
            header = [title, "joint", "time", "size", "where"]
            rows = [_jump_row(found, jump, where) for jump, where in found_jumps]
            tables.append(FoundTable(header, rows, (2, 3)))
    if judged.missed:
        header = ["missed waypoint", "joint", "nearest at", "off by"]
        asked = judged.conditions.passage
        if asked:
            header[2] = "nearest, or asked, at"
        rows = [
            [
                f"{miss.waypoint + 1} of {len(found.problem.waypoints)}",
                _joint(found, miss.joint),
                f"{miss.time:.4f} s",
                found.problem.amount(miss.distance, miss.joint, digits=3),
            ]
            for miss in judged.missed
        ]
        tables.append(FoundTable(header, rows, (2, 3)))
    return tables


def mending(found: Assessment) -> list[str]:
    """Say what a uniform stretch would do.

    Parameters
    ----------
    found : Assessment

    Returns
    -------
    list of str
        Empty where nothing is to be said.
    """
    judged = found.judgement
    factor = judged.stretch_for_limits
    if judged.feasible:
        if 0.0 < factor < 1.0 - 1e-6 and not judged.is_paced:
            return [f"at the same pace throughout it could take {factor:.6g} times its time"]
        return []
    if judged.is_mended_by_stretch:
        return [
            f"stretched by {factor:.6g}, to {factor * judged.seconds:.6g} s, it would keep everything"
        ]
    places = dict.fromkeys(_place(jump) for jump in judged.not_at_rest)
    kinds = " and ".join(dict.fromkeys(jump.quantity for jump in judged.jumps))
    reasons = {
        "a position limit is broken": any(p.quantity == "position" for p in judged.violations),
        "waypoints are missed": judged.missed,
        f"the {kinds} jumps": judged.jumps,
        f"it moves {' and '.join(places)}": places,
        "something that is asked for is not kept": judged.unkept,
        "times or velocities are asked for": judged.is_paced,
    }
    why = [reason for reason, holds in reasons.items() if holds]
    lines = [f"no uniform stretch mends it: {', '.join(why)}"]
    if factor > 1.0:
        lines.append(f"stretched by {factor:.6g} it would keep the limits that a stretch can mend")
    return lines


def distance(found: Assessment) -> list[str]:
    """Say how far the motion is from the bound.

    Parameters
    ----------
    found : Assessment

    Returns
    -------
    list of str
        Empty without a bound.
    """
    judged, bound = found.judgement, found.bound
    if bound is None or found.gap is None:
        return []
    what = "the limits" if judged.conditions.none else "the limits and conditions"
    lines = [f"no motion that keeps {what} takes less than {bound.seconds:.6g} s (proved)"]
    if judged.feasible:
        lines[0] += f"; this one: {100.0 * found.gap:.3g} % more"
    elif found.gap < 0.0:
        lines.append(f"this one is {-100.0 * found.gap:.3g} % faster than any such motion can be")
    if not judged.feasible and found.gap_when_mended is not None:
        lines.append(f"stretched until it keeps them: {100.0 * found.gap_when_mended:.3g} % more")
    return lines


def holding(found: Assessment) -> FoundTable | None:
    """Say what holds the motion up: near the optimum the shares of the limits, else the limits used most.

    Parameters
    ----------
    found : Assessment

    Returns
    -------
    FoundTable or None
        None for a motion that breaks something.
    """
    judged = found.judgement
    if found.is_near_the_optimum and found.holds:
        header = ["held up by", "joint", "segment", "for"]
        rows = [
            [hold.quantity, _joint(found, hold.joint), f"{hold.segment + 1}", f"{hold.seconds:.3g} s"]
            for hold in found.holds[:_LINES]
        ]
        return FoundTable(header, rows, (2, 3))
    used = [peak for peak in judged.peaks if peak.quantity != "position" and peak.factor > 0.0]
    if not judged.feasible or not used:
        return None
    header = ["limit used most", "joint", "time", "value", "limit", "factor"]
    rows = [_limit_row(found, peak) for peak in used[:_LINES]]
    return FoundTable(header, rows, (2, 3, 4, 5))


def _place(jump: Jump) -> str:
    """Where the motion moves though it should not."""
    return "at the ends" if jump.waypoint is None else f"at waypoint {jump.waypoint + 1}, a stop"


def _limit_row(found: Assessment, peak: Peak) -> list[str]:
    unit, scale = _unit(found, peak.quantity, peak.joint)
    limit = peak.limit if peak.quantity == "position" else np.copysign(peak.limit, peak.value)
    return [
        f"{peak.quantity} [{unit}]",
        _joint(found, peak.joint),
        f"{peak.time:.4f} s",
        f"{peak.value / scale:.6g}",
        f"{limit / scale:.6g}",
        f"{peak.factor:.6g}",
    ]


def _jump_row(found: Assessment, jump: Jump, where: str) -> list[str]:
    unit, scale = _unit(found, jump.quantity, jump.joint)
    name = f"{jump.quantity} [{unit}]"
    return [name, _joint(found, jump.joint), f"{jump.time:.4f} s", f"{jump.size / scale:.3g}", where]


def _unit(found: Assessment, quantity: str, joint: int) -> tuple[str, float]:
    """The unit in which a quantity of a joint is shown, and SI units per unit."""
    if joint < 0:  # the tool, which all joints move
        return "m/s", 1.0
    own, angle = found.problem.units[joint], found.problem.display_unit
    return unit_of(quantity, own, angle)


def _joint(found: Assessment, joint: int) -> str:
    if joint < 0:
        return "tool"
    names = found.judgement.names
    return f"{joint + 1} {names[joint]}" if names else f"{joint + 1}"
