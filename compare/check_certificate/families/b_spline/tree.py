"""The search tree of a B-spline's proof, replayed.

Ends of boxes are floats and exact, so the tree itself needs comparisons alone. What the events claim is
collected, and verified for many boxes at once: what is left of a box by travel, and which slabs of it a sum
of limits discards.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, nextafter
from typing import Any

import numpy as np

from compare.check_certificate.answers import BadInput, Refused, need
from compare.check_certificate.balls import R
from compare.check_certificate.claim import MOST_SEGMENTS, Claim
from compare.check_certificate.families.b_spline.conditions import (
    SplineLimits,
    SumRows,
    least_of,
    sums_of,
)
from compare.check_certificate.families.b_spline.knots import Forms
from compare.check_certificate.families.b_spline.taylor import MOST_VARIABLES
from compare.check_certificate.families.b_spline.travel import Travel, cut
from compare.check_certificate.reading import index, items, real

_CUTS = 2_000  # boxes whose cuts are verified at once
_FLOATS = 4_000_000  # in the models that are made at once
_SLACK = 2.0**-40  # of L, by which the box after a turn is widened
_MOST_OPEN = 10_000  # boxes on the stack
_LEAST, _MOST = 1e-40, 1e40  # sizes of numbers in SI units, beside 0
_ROUNDS = 4  # of cuts by travel; the prover makes two

Ends = tuple[list[float], list[float]]


class BSplineTree:
    """TimeBoxes of the times of the inner waypoints; t_0 = 0 and t_n = L."""

    def __init__(self, claim: Claim) -> None:
        self.claim = claim
        self.forms = Forms(claim.n, int(claim.family[-1]))
        self.L, self.slack = float(claim.L), float(claim.L) * _SLACK
        shortest = claim.shortest()
        self.void = sum(shortest, R(0)) > claim.L
        self.root = (
            [_below(sum(shortest[:k], R(0))) for k in range(claim.n)] + [self.L],
            [0.0] + [_above(claim.L - sum(shortest[k:], R(0))) for k in range(1, claim.n)] + [self.L],
        )
        self.joint = {j: i for i, j in enumerate(claim.moving)}
        self.limits = self._limits()
        self.travel = Travel(
            np.array([[_below(abs(row[j])) for j in claim.moving] for row in claim.d]),
            np.array([[1.0 if row[j] > 0 else -1.0 for j in claim.moving] for row in claim.d]),
            np.array([_above(claim.speed(j)) for j in claim.moving]),
            np.array([_above(claim.acceleration(j)) for j in claim.moving]),
        )
        self.cuts: list[tuple[str, Ends, Ends | None]] = []
        self.sums: list[tuple[Ends, list[Any]]] = []
        self.discards: list[tuple[str, int, int, float, float]] = []
        self.batch = max(_FLOATS // (self.forms.of.K * (claim.n + 5) * (claim.n + 5)), 1)

    def _limits(self) -> SplineLimits:
        claim = self.claim
        level = np.full((4, len(claim.moving), 2), inf)
        for i, j in enumerate(claim.moving):
            for side in range(2):
                if claim.position[j][side] is not None:
                    level[0, i, side] = _above(claim.room(0, j, 2 * side - 1))
                for order in range(1, 4):
                    level[order, i, side] = _above(claim.limits[order - 1][j])
        x = np.array([[float(row[j]) for j in claim.moving] for row in claim.w])
        return SplineLimits(x, level)

    def _moderate(self) -> bool:
        """Whether products of a few numbers of the problem stay far within the range of floats."""
        claim = self.claim
        numbers = [claim.L, *(x for row in claim.limits for x in row if x is not None)]
        numbers += [abs(x) for rows in (claim.w, claim.d) for row in rows for x in row if x != 0]
        return all(bool(x > _LEAST) and bool(x < _MOST) for x in numbers)

    def replay(self) -> int:
        """Verify every event; returns the number of discards."""
        most = MOST_VARIABLES + 1
        need(self.claim.n <= most, f"B-splines of more than {most} segments are not checked")
        need(self._moderate(), f"a number is not 0 and not from {_LEAST:g} to {_MOST:g}")
        discards = 0
        for _ in self._events():
            if len(self.cuts) >= _CUTS:
                self._verify_cuts()
            if len(self.sums) >= self.batch:
                discards += self._verify_discards()
        self._verify_cuts()
        return discards + self._verify_discards()

    def _events(self) -> Iterator[None]:
        """Go through the events, collecting what they claim."""
        stack: list[Ends] = [self.root]
        box: Ends | None = None
        reference: Ends | None = None  # the box after its last turn: sums are models over it
        closed = False  # whether nothing is left of the box
        rows: list[Any] = []  # those of the last event that has some; none prove nothing
        events = self.claim.events
        for count, raw in enumerate(events):
            event = items(raw, 1, 4)
            letter, where = event[0], f"event {count + 1}"
            if box is None:
                need(stack, f"{where}: every box has ended")
                box, reference, closed = stack.pop(), None, False
            if letter == "T":
                if not closed:
                    after = items(events[count + 1], 1, 4)[0] if count + 1 < len(events) else None
                    box, closed = self._turn(where, event, box, after == "E"), after == "E"
                    reference = box
            elif letter == "E":
                need(closed, f"{where}: something is left of the box")
                box = None
            elif letter in ("L", "B", "A"):
                size = 1 if letter == "L" else 3
                items(event, size, size + 1)
                if len(event) > size:
                    rows = [self._row(row) for row in items(event[-1], 1, MOST_SEGMENTS + 1)]
                if letter == "L":
                    if not closed:
                        self._discard(where, reference, rows, 0, 0.0, 0.0)
                    box = None
                else:
                    k, value = self._place(event)
                    lo, hi = box[0][k], box[1][k]
                    slab = (value, hi) if letter == "B" else (lo, value)
                    if not closed and max(slab[0], lo) <= min(slab[1], hi):
                        self._discard(where, reference, rows, k, *slab)
                        ends = (lo, value) if letter == "B" else (value, hi)
                        closed = not ends[0] < ends[1]
                        box = _with(box, k, *ends)
            elif letter == "S":
                items(event, 3, 3)
                k, value = self._place(event)
                lo, hi = box[0][k], box[1][k]
                need(closed or lo < value < hi, f"{where}: the split is outside the box")
                if closed:
                    raise BadInput(f"{where}: a box that has ended is split")
                need(len(stack) < _MOST_OPEN, f"{where}: more than {_MOST_OPEN} open boxes")
                stack += [_with(box, k, lo, value), _with(box, k, value, hi)]
                box = None
            else:
                raise BadInput(f"{where}: unknown event {letter!r:.20}")
            yield
        need(box is None and not stack, "the events end before every box has ended")

    def _place(self, event: list[Any]) -> tuple[int, float]:
        """Waypoint and time of an event."""
        k = index(event[1], self.claim.n)
        if k == 0:
            raise BadInput("a cut of waypoint 0, whose time is 0")
        return k, real(event[2])

    def _turn(self, where: str, event: list[Any], box: Ends, empty: bool) -> Ends:
        """Collect what a turn claims; returns the box that is left."""
        items(event, 3, 3)
        n = self.claim.n
        lo, hi = ([real(x) for x in items(ends, n - 1, n - 1)] for ends in event[1:])
        if empty:
            self.cuts.append((where, box, None))
            return box
        # a root that was found to the last digit is beyond this checker's rounding: go on with a wider box
        left = (
            [0.0, *(max(x - self.slack, y) for x, y in zip(lo, box[0][1:-1], strict=True)), self.L],
            [0.0, *(min(x + self.slack, y) for x, y in zip(hi, box[1][1:-1], strict=True)), self.L],
        )
        need(all(a <= b for a, b in zip(*left, strict=True)), f"{where}: a turn leaves no box")
        self.cuts.append((where, box, left))
        return left

    def _row(self, raw: Any) -> tuple[Any, ...]:
        """Read a row: joint among those that move, span, order, sign, place, multiplier."""
        row = self.claim.row(raw, self.forms.spans)
        need(row[0] == "p", "a row this family does not have")
        _, multiplier, j, k, sign, order, place = row
        level = self.limits.level[order, self.joint[j], (sign + 1) // 2]
        need(level < inf, f"a row poses a limit that joint {self.claim.joint_name(j)} does not have")
        return self.joint[j], k, order, sign, float(place), float(multiplier)

    def _discard(
        self, where: str, reference: Ends | None, rows: list[Any], k: int, lo: float, hi: float
    ) -> None:
        need(reference is not None, f"{where}: a discard before the first turn")
        need(rows, f"{where}: no rows")
        if not (self.sums and self.sums[-1][0] is reference and self.sums[-1][1] is rows):
            self.sums.append((reference, rows))  # type: ignore[arg-type]  # it is not None
        self.discards.append((where, len(self.sums) - 1, k, lo, hi))

    def _verify_cuts(self) -> None:
        """Verify what the turns leave."""
        cuts, self.cuts = self.cuts, []
        if not cuts:
            return
        lo, hi = (np.array([box[end] for _, box, _ in cuts]).T for end in range(2))
        nothing = ([inf] * (self.claim.n + 1), [-inf] * (self.claim.n + 1))
        claimed = [np.array([(left or nothing)[end] for _, _, left in cuts]).T for end in range(2)]
        open_ = np.arange(len(cuts))
        for _ in range(_ROUNDS):
            part = lo[:, open_], hi[:, open_]
            left = cut(self.travel, *part)
            lo[:, open_], hi[:, open_] = part
            inside = (part[0] >= claimed[0][:, open_]) & (part[1] <= claimed[1][:, open_])
            open_ = open_[left & ~inside.all(axis=0)]
            if not len(open_):
                return
        raise Refused(f"{cuts[open_[0]][0]}: travel leaves more of the box than is stated")

    def _verify_discards(self) -> int:
        """Verify that sums of limits are positive on slabs; returns the number of discards."""
        sums, discards, self.sums, self.discards = self.sums, self.discards, [], []
        if not discards:
            return 0
        lo, hi = (np.array([box[end] for box, _ in sums]).T for end in range(2))
        flat = [(i, *row) for i, (_, rows) in enumerate(sums) for row in rows]
        total, joint, span, order, sign, place, multiplier = zip(*flat, strict=True)
        rows = SumRows(
            np.array(total), np.array(joint), np.array(span), np.array(order), np.array(sign),
            np.array(place), np.array(multiplier),
        )  # fmt: skip
        where, which, k, first, last = zip(*discards, strict=True)
        models = sums_of(self.forms, self.limits, lo, hi, rows)
        least = least_of(self.forms.of, models, *map(np.array, (which, k, first, last)))
        for i in np.flatnonzero(~(least > 0.0))[:1]:
            raise Refused(f"{where[i]}: the {'slab' if k[i] else 'box'} is not discarded")
        return len(discards)


def _with(box: Ends, k: int, lo: float, hi: float) -> Ends:
    """The same box with other ends of one variable."""
    ends = [*box[0]], [*box[1]]
    ends[0][k], ends[1][k] = lo, hi
    return ends


def _above(x: Any) -> float:
    """A float that is not below a number; inf for no number."""
    if x is None:
        return inf
    y = float(x.upper())
    return y if R(y) >= x.upper() else nextafter(y, inf)


def _below(x: Any) -> float:
    """A float that is not above a number."""
    y = float(x.lower())
    return y if R(y) <= x.lower() else nextafter(y, -inf)
