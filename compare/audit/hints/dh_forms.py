"""Other readings of a DH table: its form, its units, its columns, joint offsets, one sign, one length."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import combinations, product

import numpy as np

from compare.audit.findings.points import position_of, residual
from compare.audit.hints.hint import Change
from compare.audit.paper import Paper
from compare.audit.paper.dh import PrintedDH
from formulations.arms import DHTable
from formulations.arms.dh_table import FORMS
from formulations.problem.arrays import Array
from formulations.problem.joint_words import METRES, UNITS

_TURNS = (-90.0, 90.0, 180.0)  # deg: offsets that papers leave out
_MOST_OFFSETS = 3  # joints with such an offset
_MOST_JOINTS, _MOST_POINTS = 9, 12  # of an arm that is searched; points that the search looks at
_DIGITS = {"mm": 0, "m": 3}  # decimals of a length to begin with
# Of a reading that explains no fault: how near it has to come, and how probable that may be by chance.
_NEARER, _CHANCE = 0.25, 0.01
_KEPT = 40  # readings with the smallest misses, which are judged with their rounding


def dh_readings(paper: Paper) -> list[tuple[int, Change]]:
    """Find the readings of the printed DH table that lead nearest to the printed points.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Returns
    -------
    list of (int, Change)
        How many things each reading changes, and the reading; the fewest first. Empty without a DH table,
        points or waypoints.
    """
    if paper.dh is None or paper.waypoints is None or not paper.points:
        return []
    if paper.dh.table.dof > _MOST_JOINTS:
        return []
    points = paper.points[:_MOST_POINTS]
    joints = paper.waypoints[[point.waypoint for point in points]]
    wanted = np.array([position_of(point) for point in points])
    shifts = _offsets(paper.dh.table.dof)
    found: list[tuple[float, int, list[str], DHTable, Array]] = []
    for told, table in _tables(paper.dh.table):
        chain = table.chain()
        turned = joints + (chain.sign * shifts)[:, None]
        miss = np.linalg.norm(chain.forward(turned)[..., :3, 3] - wanted, axis=-1)
        # a misprinted point must not hide the reading that leads to the others
        score = np.median(miss, axis=1) if len(wanted) > 2 else miss.max(axis=1)
        cost = len(told) + (shifts != 0.0).sum(axis=1)
        found += [
            (round(float(score[i]), 5), int(cost[i]), told, table, shifts[i])
            for i in np.lexsort((cost, np.round(score, 5)))[:_KEPT]
            if cost[i]
        ]
    found.sort(key=lambda entry: entry[:2])
    readings = [
        (cost, _change(paper, paper.dh, told, table, shift))
        for _, cost, told, table, shift in found[:_KEPT]
    ]
    readings += [
        (1, _change(paper, paper.dh, [told], table, np.zeros(table.dof)))
        for told, table in _lengths(paper.dh.table, joints, wanted)
    ]
    return sorted(readings, key=lambda reading: reading[0])


def largest_miss(paper: Paper) -> float:
    """Largest distance between the tool and a printed point.

    Parameters
    ----------
    paper : Paper
        With an arm and points.

    Returns
    -------
    float [m]
    """
    return max(float(np.linalg.norm(residual(paper, point).apart)) for point in paper.points)


def by_chance(paper: Paper, read: Paper) -> bool:
    """Whether some of so many readings may come nearer to the points by chance as much as this one does.

    A reading that has nothing to do with the arm puts the tool anywhere. It brings all three coordinates of n
    points to a share r of the former miss with a probability of about r^(3 n).

    Parameters
    ----------
    paper, read : Paper
        Before and after the change.

    Returns
    -------
    bool
        True, too, if it does not come four times as near.
    """
    assert paper.dh is not None
    readings = len(list(_tables(paper.dh.table))) * len(_offsets(paper.dh.table.dof))
    share = largest_miss(read) / largest_miss(paper)
    return bool(share > _NEARER or readings * share ** (3 * len(paper.points)) > _CHANCE)


def _change(paper: Paper, dh: PrintedDH, told: list[str], table: DHTable, shift: Array) -> Change:
    offset = table.offset + shift / UNITS[table.angle]
    read = replace(dh, table=replace(table, offset=offset))
    turns = [
        f"theta{j + 1} {'+' if turn > 0.0 else '-'} {abs(np.rad2deg(turn)):.0f} deg"
        for j, turn in enumerate(shift)
        if turn
    ]
    words = [*told, *([f"joint offsets {', '.join(turns)}"] if turns else [])]
    told_all = f"{dh.where} read with {' and '.join(words)}"
    return Change("dh", told_all, replace(paper, dh=read, arm=read.arm(paper.name)))


def _tables(table: DHTable) -> Iterator[tuple[list[str], DHTable]]:
    """Readings of the table without offsets: form, units and columns together, or form and one sign."""
    for form in FORMS:
        other_form = [] if form == table.form else [f"the {form} form (stated: {table.form})"]
        for length, angle, crossed in product(METRES, UNITS, (False, True)):
            told = list(other_form)
            if length != table.length:
                told.append(f"lengths in {length} (stated: {table.length})")
            if angle != table.angle:
                told.append(f"angles in {angle} (stated: {table.angle})")
            if crossed:
                told.append("columns a and d swapped")
            a, d = (table.d, table.a) if crossed else (table.a, table.d)
            yield told, replace(table, form=form, length=length, angle=angle, a=a, d=d)
        for part in ("alpha", "a", "d", "sign"):
            for j in np.flatnonzero(getattr(table, part)):
                column = getattr(table, part).copy()
                column[j] *= -1.0
                what = "sense of rotation" if part == "sign" else part
                told = [*other_form, f"the other {what} of joint {j + 1}"]
                if part != "sign":
                    told[-1] = f"the other sign of {part} of joint {j + 1}"
                yield told, replace(table, form=form, **{part: column})


def _lengths(table: DHTable, joints: Array, wanted: Array) -> Iterator[tuple[str, DHTable]]:
    """Tables with one other length, which the points (n, 3) [m] ask for: a misprint, a base or a tool.

    The tool moves along a line when one length changes, so each point asks for a length; the median is taken.
    """
    metre, last = METRES[table.length], table.dof - 1
    tools = table.chain().forward(joints)[:, :3, 3]
    for part, j in product("da", range(table.dof)):
        column = getattr(table, part).copy()
        column[j] += 1.0
        along = (replace(table, **{part: column}).chain().forward(joints)[:, :3, 3] - tools) / metre
        asked = float(np.median(((wanted - tools) * along).sum(axis=1))) / metre
        meaning = {("d", 0): ", the height of the base", ("d", last): ", as with a tool"}.get(
            (part, j), ""
        )
        printed = float(getattr(table, part)[j])
        first = _DIGITS[table.length]
        lengths = dict.fromkeys(round(printed + asked, first + more) for more in range(4))
        for length in lengths:
            if length != printed:
                column = column.copy()
                column[j] = length
                told = (
                    f"{part} of joint {j + 1} {length:g} {table.length}{meaning} (printed: {printed:g})"
                )
                yield told, replace(table, **{part: column})


@cache
def _offsets(dof: int) -> Array:
    """No offset, and quarter and half turns of up to three joints, (n, dof) [rad]."""
    found = [np.zeros(dof)]
    for count in range(1, min(_MOST_OFFSETS, dof) + 1):
        for which in combinations(range(dof), count):
            for turns in product(_TURNS, repeat=count):
                one = np.zeros(dof)
                one[list(which)] = np.deg2rad(turns)
                found.append(one)
    return np.array(found)
