"""Changes of signs and of order: one sign, two columns or rows, the limits of another table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np

from compare.audit.hints.hint import Change
from compare.audit.hints.units import scaled, table_of
from compare.audit.paper import Paper, PrintedTimes, StatedLimits
from formulations.motion.verdict import QUANTITIES

_AXES = "xyz"
_ALL_PAIRS = 20  # rows or columns of which every two are swapped; of more, only neighbours


def signs(paper: Paper) -> Iterator[Change]:
    """Change one sign in the waypoints, or in the position of a point.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Yields
    ------
    Change
    """
    if paper.waypoints is not None:
        for i, j in zip(*np.nonzero(paper.waypoints), strict=True):
            waypoints = paper.waypoints.copy()
            waypoints[i, j] *= -1.0
            told = f"joint {j + 1} of waypoint {i + 1} with the other sign"
            yield Change("sign", told, replace(paper, waypoints=waypoints))
    for k, point in enumerate(paper.points):
        for axis, number in enumerate(point.position):
            if number.value:
                position = list(point.position)
                position[axis] = scaled(number, -1.0)
                position[axis] = replace(position[axis], half=number.half)
                points = list(paper.points)
                points[k] = replace(point, position=tuple(position))
                told = f"{_AXES[axis]} of {point.where} with the other sign"
                yield Change("sign", told, replace(paper, points=tuple(points)))


def swaps(paper: Paper) -> Iterator[Change]:
    """Swap two columns or two rows of a table.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Yields
    ------
    Change
        Joints or waypoints of the waypoints, joints of limits, joints of time vectors, two points, two
        coordinates of all points.
    """
    yield from _waypoint_swaps(paper)
    for name, stated in paper.stated.items():
        yield from _limit_swaps(paper, name, stated)
    for table in dict.fromkeys(table_of(row) for row in paper.rows):
        places = [
            i
            for i, row in enumerate(paper.rows)
            if table_of(row) == table and not row.of and row.joint is not None
        ]
        for a, b in _pairs(places):
            rows = list(paper.rows)
            first, second = rows[a], rows[b]
            rows[a] = replace(first, times=second.times, total=second.total)
            rows[b] = replace(second, times=first.times, total=first.total)
            told = f"the times of {first.where} and {second.where} swapped"
            yield Change("swap", told, replace(paper, rows=tuple(rows)))
    for a, b in _pairs(range(len(paper.points))):
        changed = list(paper.points)
        p, q = changed[a], changed[b]
        changed[a] = replace(p, position=q.position, rpy=q.rpy, metre=q.metre, radian=q.radian)
        changed[b] = replace(q, position=p.position, rpy=p.rpy, metre=p.metre, radian=p.radian)
        told = f"{p.where} and {q.where} swapped"
        yield Change("swap", told, replace(paper, points=tuple(changed)))
    for a, b in _pairs(range(3 if paper.points else 0)):
        order = _swapped(3, a, b)
        points = tuple(replace(p, position=tuple(p.position[k] for k in order)) for p in paper.points)
        told = f"{_AXES[a]} and {_AXES[b]} of the points swapped"
        yield Change("swap", told, replace(paper, points=points), whole=True)


def other_tables(paper: Paper) -> Iterator[Change]:
    """Put the time vectors and totals of a table under the limits of another table.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Yields
    ------
    Change
        All that stands under these limits, or one table of it.
    """
    for old, new in ((a, b) for a in paper.stated for b in paper.stated if a != b):
        if paper.stated[old].joint != paper.stated[new].joint:
            continue
        tables = list(
            dict.fromkeys(
                [
                    *(table_of(row) for row in paper.rows if row.limits == old),
                    *(total.table for total in paper.totals if total.limits == old),
                ]
            )
        )
        for chosen in [tables, *([table] for table in tables if len(tables) > 1)]:
            told = f"{' and '.join(chosen)} under the limits of {new} (stated: {old})"
            yield Change("other table", told, _under(paper, old, new, chosen), whole=True)


def _under(paper: Paper, old: str, new: str, tables: list[str]) -> Paper:
    def moved(row: PrintedTimes) -> PrintedTimes:
        limits = new if row.limits == old and table_of(row) in tables else row.limits
        return replace(row, limits=limits, of=tuple(moved(one) for one in row.of))

    totals = tuple(
        replace(t, limits=new) if t.limits == old and t.table in tables else t for t in paper.totals
    )
    return replace(paper, rows=tuple(moved(row) for row in paper.rows), totals=totals)


def _waypoint_swaps(paper: Paper) -> Iterator[Change]:
    if paper.waypoints is None or paper.halves is None:
        return
    for axis, what in ((1, "joints"), (0, "waypoints")):
        for a, b in _pairs(range(paper.waypoints.shape[axis])):
            order = _swapped(paper.waypoints.shape[axis], a, b)
            waypoints = np.take(paper.waypoints, order, axis)
            told = f"{what} {a + 1} and {b + 1} of the waypoints swapped"
            halves = np.take(paper.halves, order, axis)
            yield Change("swap", told, replace(paper, waypoints=waypoints, halves=halves))


def _limit_swaps(paper: Paper, name: str, stated: StatedLimits) -> Iterator[Change]:
    dof = stated.derivatives.shape[1]
    limited = [k for k in range(3) if np.isfinite(stated.derivatives[k]).any()]
    chosen = [("limits", limited, True)]
    chosen += [(f"{QUANTITIES[k + 1]} limits", [k], False) for k in limited]
    for what, quantities, position in chosen:
        for a, b in _pairs(range(dof)):
            changed = _ordered(stated, quantities, _swapped(dof, a, b), position=position)
            same = np.array_equal(changed.derivatives, stated.derivatives)
            if not same or not np.array_equal(changed.position, stated.position):
                told = f"joints {a + 1} and {b + 1} of the {what} of {name} swapped"
                yield Change("swap", told, replace(paper, stated=paper.stated | {name: changed}))


def _ordered(
    stated: StatedLimits, quantities: list[int], order: list[int], *, position: bool
) -> StatedLimits:
    derivatives, halves = stated.derivatives.copy(), stated.derivative_halves.copy()
    derivatives[quantities], halves[quantities] = (
        part[quantities][:, order] for part in (stated.derivatives, stated.derivative_halves)
    )
    return replace(
        stated,
        derivatives=derivatives,
        derivative_halves=halves,
        position=stated.position[order] if position else stated.position,
        position_halves=stated.position_halves[order] if position else stated.position_halves,
    )


def _pairs(places: Sequence[int]) -> Iterable[tuple[int, int]]:
    return combinations(places, 2) if len(places) <= _ALL_PAIRS else pairwise(places)


def _swapped(count: int, a: int, b: int) -> list[int]:
    return [b if k == a else a if k == b else k for k in range(count)]
