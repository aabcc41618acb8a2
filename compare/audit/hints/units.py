"""Changes of units: degrees and radians, seconds and minutes or milliseconds, metres and millimetres."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from compare.audit.hints.hint import Change
from compare.audit.paper import Paper, Printed, PrintedTimes, StatedLimits
from formulations.motion.verdict import QUANTITIES
from formulations.problem.joint_words import METRES, UNITS

_SECONDS = {"min": 60.0, "ms": 1e-3}
_OTHER_ANGLE = {"rad": "deg", "deg": "rad"}
_OTHER_LENGTH = {"m": "mm", "mm": "m"}


def angle_units(paper: Paper) -> Iterator[Change]:
    """Read angles in the other unit: limits, waypoints, orientations.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Yields
    ------
    Change
        Limits of one table, all or one quantity; all waypoints, one, or one joint of them; all orientations.
    """
    for name, stated in paper.stated.items():
        other = _OTHER_ANGLE[stated.unit]
        factor = UNITS[other] / UNITS[stated.unit]
        limited = [k for k in range(3) if np.isfinite(stated.derivatives[k]).any()]
        if len(limited) > 1:
            told = f"the limits of {name} in {other} (stated: {stated.unit})"
            changed = _scaled(_scaled_range(stated, factor), limited, factor)
            yield _limits(paper, told, name, changed)
        for k in limited:
            told = f"the {QUANTITIES[k + 1]} limits of {name} in {other} (stated: {stated.unit})"
            yield _limits(paper, told, name, _scaled(stated, [k], factor))
        if np.isfinite(stated.position).any():
            told = f"the position limits of {name} in {other} (stated: {stated.unit})"
            yield _limits(paper, told, name, _scaled_range(stated, factor))
    yield from _waypoints(paper)
    turned = [point for point in paper.points if point.rpy is not None]
    if turned:
        here = "rad" if turned[0].radian == 1.0 else "deg"
        other = _OTHER_ANGLE[here]
        points = tuple(replace(p, radian=UNITS[other]) for p in paper.points)
        yield Change(
            "angle unit", f"the orientations of the points in {other} (stated: {here})",
            replace(paper, points=points), whole=True,
        )  # fmt: skip


def time_units(paper: Paper) -> Iterator[Change]:
    """Read times in minutes or milliseconds: the vectors of one table, their totals, other totals.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Yields
    ------
    Change
    """
    for unit, factor in _SECONDS.items():
        for table in dict.fromkeys(table_of(row) for row in paper.rows):
            for what, vector, total in (
                ("times and totals", factor, factor),
                ("times", factor, 1.0),
                ("totals", 1.0, factor),
            ):
                rows = _timed(paper, table, vector, total)
                told = f"the {what} of {table} in {unit} (read: s)"
                yield Change("time unit", told, replace(paper, rows=rows), whole=True)
        for table in dict.fromkeys(total.table for total in paper.totals):
            totals = tuple(
                replace(t, value=scaled(t.value, factor)) if t.table == table else t
                for t in paper.totals
            )
            told = f"the totals of {table} in {unit} (read: s)"
            yield Change("time unit", told, replace(paper, totals=totals), whole=True)


def length_units(paper: Paper) -> Iterator[Change]:
    """Read the positions of the points in the other unit of length.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Yields
    ------
    Change
        All points, or one.
    """
    for chosen in (paper.points, *([point] for point in paper.points if len(paper.points) > 1)):
        if chosen:
            here = next(unit for unit, metre in METRES.items() if metre == chosen[0].metre)
            other = _OTHER_LENGTH[here]
            points = tuple(replace(p, metre=METRES[other]) if p in chosen else p for p in paper.points)
            where = "all points" if len(chosen) > 1 else chosen[0].where
            told = f"the position of {where} in {other} (stated: {here})"
            yield Change("length unit", told, replace(paper, points=points), whole=True)


def table_of(row: PrintedTimes) -> str:
    """Name the table of a time vector.

    Parameters
    ----------
    row : PrintedTimes
        The vector.

    Returns
    -------
    str
        The place without its joint, and the method.
    """
    first = row.of[0] if row.of else row
    place = first.where
    if first.joint is not None:
        place = place.removesuffix(f", joint {first.joint + 1}")
    return f"{place}, {row.by}".rstrip(", ")


def scaled(number: Printed, factor: float) -> Printed:
    """Read a printed number in another unit.

    Parameters
    ----------
    number : Printed
        As printed.
    factor : float
        The stated unit per other unit.

    Returns
    -------
    Printed
    """
    return replace(number, value=number.value * factor, half=number.half * factor)


def _limits(paper: Paper, told: str, name: str, changed: StatedLimits) -> Change:
    return Change("angle unit", told, replace(paper, stated=paper.stated | {name: changed}), whole=True)


def _scaled(stated: StatedLimits, orders: list[int], factor: float) -> StatedLimits:
    column = np.array([factor if k in orders else 1.0 for k in range(3)])[:, None]
    return replace(
        stated,
        derivatives=stated.derivatives * column,
        derivative_halves=stated.derivative_halves * column,
    )


def _scaled_range(stated: StatedLimits, factor: float) -> StatedLimits:
    return replace(
        stated,
        position=stated.position * factor,
        position_halves=stated.position_halves * factor,
    )


def _waypoints(paper: Paper) -> Iterator[Change]:
    if paper.waypoints is None or paper.halves is None:
        return
    other = _OTHER_ANGLE[paper.waypoint_unit]
    factor = UNITS[other] / UNITS[paper.waypoint_unit]
    n, dof = paper.waypoints.shape
    rows, columns = np.indices((n, dof))
    chosen = [
        ("all waypoints", np.ones((n, dof), dtype=bool)),
        *((f"waypoint {i + 1}", rows == i) for i in range(n)),
        *((f"joint {j + 1} of the waypoints", columns == j) for j in range(dof if dof > 1 else 0)),
    ]
    for told, mask in chosen:
        factors = np.where(mask, factor, 1.0)
        yield Change(
            "angle unit", f"{told} in {other} (stated: {paper.waypoint_unit})",
            replace(paper, waypoints=paper.waypoints * factors, halves=paper.halves * factors),
            whole=True,
        )  # fmt: skip


def _timed(paper: Paper, table: str, vector: float, total: float) -> tuple[PrintedTimes, ...]:
    """All vectors of a paper, those of one table in another unit."""

    def timed(row: PrintedTimes) -> PrintedTimes:
        if table_of(row) != table:
            return row
        return replace(
            row,
            times=tuple(scaled(t, vector) for t in row.times),
            total=None if row.total is None else scaled(row.total, total),
            of=tuple(timed(one) for one in row.of),
        )

    return tuple(timed(row) for row in paper.rows)
