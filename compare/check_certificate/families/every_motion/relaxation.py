"""Every motion that keeps the demands of a claim: a linear relaxation, and sums of its inequalities.

The claim: no motion of at most H seconds takes L or less. ``inequalities`` states what every motion obeys.
For multipliers >= 0, the cost plus the weighted sum of the rows is linear in bounded variables: its least
value is a lower bound of the cost. An event narrows one variable so, ends the proof, or splits the box of a
duration: then both parts have events of their own, and each has to end. The module ``accelerations`` narrows
accelerations without a sum.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from compare.check_certificate.answers import BadInput, Refused, need
from compare.check_certificate.balls import R, least, most
from compare.check_certificate.claim import MOST_EVENTS, Claim
from compare.check_certificate.families.every_motion.accelerations import greatest, weights
from compare.check_certificate.families.every_motion.inequalities import SUMS, Inequalities, require_row
from compare.check_certificate.families.every_motion.setting import Variable
from compare.check_certificate.reading import index, items, number

MOST_ROWS = 1_000_000
MOST_SPLITS = 100  # one inside the other


@dataclass
class Tally:
    """What a proof consists of: numbers of events and rows, and the ends of its parts, each with its sum."""

    events: int = 0
    rows: int = 0
    ends: list[Relaxation] = field(default_factory=list)


class Relaxation(Inequalities):
    """Boxes that the events narrow; sum: the rows of the last sum; splits: of which part this is."""

    def __init__(self, claim: Claim) -> None:
        H = number(claim.horizon)
        need(H >= claim.L, "the horizon is below the bound")
        super().__init__(claim, H)
        self.sum: list[Any] = []
        self.splits: list[tuple[Variable, int, Any]] = []  # a duration, below (0) or above (1), where
        self.tally = Tally()
        self._seen: dict[
            int, list[Any]
        ] = {}  # the intervals from which accelerations were narrowed last

    def replay(self) -> int:
        """Verify every event; returns the number of rows with multipliers."""
        self._replay(self.claim.events, dict(self.boxes), "event")
        return self.tally.rows

    def _replay(self, events: list[Any], pending: dict[Variable, tuple[Any, Any]], of: str) -> None:
        """Verify the events of one box; pending boxes come into force at the next "P" or "R"."""
        for place, raw in enumerate(events, 1):
            event, where = items(raw, 1, 6), f"{of} {place}"
            letter = str(event[0])
            self.tally.events += 1
            if letter == "S":
                return self._replay_parts(event, pending, where)
            if letter in ("R", "P"):
                empty = letter == "P" and self._propagate(pending)
                ended = self._renew(pending) or empty
            else:
                ended = self._add_up(event, letter, pending, where)
            if ended:
                self.tally.ends.append(self)
                return None
        raise Refused("the events end before the bound")

    def _add_up(
        self, event: list[Any], letter: str, pending: dict[Variable, tuple[Any, Any]], where: str
    ) -> bool:
        """Verify an event with a sum of rows; whether nothing is left, or all of it takes longer."""
        rows = items(event[-1], 0, MOST_ROWS)
        self.tally.rows += len(rows)
        self.sum = rows
        if letter == "F":
            total = self.least({}, rows, time=1)
            need(total + self.waits > self.claim.L, f"{where}: the sum is not above the bound")
            return True
        if letter == "E":
            need(self.least({}, rows) > 0, f"{where}: something is left")
            return True
        if letter != "N":
            raise BadInput(f"{where}: unknown event {letter!r:.20}")
        key, side = self._narrowed(event)
        bound = self.least({key: R(-1 if side else 1)}, rows)
        need(bound.is_finite(), f"{where}: the box is not narrowed")
        lo, hi = pending.get(key, self.boxes[key])
        pending[key] = (lo, least(hi, (-bound).upper())) if side else (most(lo, bound.lower()), hi)
        return bool(pending[key][0] > pending[key][1])

    def _replay_parts(
        self, event: list[Any], pending: dict[Variable, tuple[Any, Any]], where: str
    ) -> None:
        """Verify both parts of a box that is split at a duration: each has to end by itself."""
        _, segment, at, *parts = items(event, 5, 5)
        need(len(self.splits) < MOST_SPLITS, f"{where}: more than {MOST_SPLITS} splits in each other")
        key, value = ("T", self.leg(segment)), number(at)
        lo, hi = pending.get(key, self.boxes[key])
        for side, events in enumerate(parts):
            part = self._part(key, side, value)
            cut = (most(lo, value), hi) if side else (lo, least(hi, value))
            if not cut[0] > cut[1]:
                name = f"{where}, {'upper' if side else 'lower'} part, event"
                part._replay(items(events, 0, MOST_EVENTS), {**pending, key: cut}, name)

    def _part(self, key: Variable, side: int, value: Any) -> Relaxation:
        """Copy all that a part finds out: it is not true of the other part."""
        part = copy(self)
        part.boxes, part.legs = dict(self.boxes), dict(self.legs)
        part.V, part.A = dict(self.V), dict(self.A)
        part.spans, part._seen = list(self.spans), {}
        part.splits = [*self.splits, (key, side, value)]
        return part

    def _renew(self, boxes: dict[Variable, tuple[Any, Any]]) -> bool:
        """Put boxes in force, of legs over several others within the sums of these; whether one is empty."""
        spans = [("T", name) for name in self.spans]
        for key in spans:
            (lo, hi), (low, high) = boxes.get(key, self.boxes[key]), self.sums(boxes, key[1])
            boxes[key] = most(lo, low), least(hi, high)
        self.boxes = dict(boxes)
        return any(bool(boxes[key][0] > boxes[key][1]) for key in spans)

    def _propagate(self, boxes: dict[Variable, tuple[Any, Any]]) -> bool:
        """Narrow the accelerations from the durations; whether a box is then certainly empty."""
        limited = [j for j in self.joints if self.J[j] is not None]
        for before, after in pairwise(self.ks):
            if not (boxes["T", before][0] > 0 and boxes["T", after][0] > 0):
                continue
            places = [(before, 0), (before, 1), (after, 1)]
            used: list[Any] = [boxes["T", before], boxes["T", after]]
            used += [boxes.get(self.at_end("e", k, j, end)) for k, end in places for j in limited]
            if all(x is y for x, y in zip(used, self._seen.get(after, [None]), strict=False)):
                continue  # nothing to narrow that was not narrowed
            self._seen[after] = used
            of_both = weights(boxes["T", before], boxes["T", after])
            for j in limited:
                d, e = self._way(boxes, before, j), self._way(boxes, after, j)
                J = self.legs[before].jerk[j], self.legs[after].jerk[j]
                a = self.at_end("a", after, j, 0)
                lo, hi = boxes[a]
                boxes[a] = (
                    most(lo, (-greatest(-d[1], -e[0], J, of_both)).lower()),
                    least(hi, greatest(d[0], e[1], J, of_both).upper()),
                )
        for j in limited:
            # over a leg it changes by at most J T
            for k, end in [*((k, 1) for k in self.ks), *((k, 0) for k in reversed(self.ks))]:
                change = self.legs[k].jerk[j] * boxes["T", k][1]
                there, here = (self.at_end("a", k, j, at) for at in (1 - end, end))
                (low, high), (lo, hi) = boxes[there], boxes[here]
                boxes[here] = most(lo, (low - change).lower()), least(hi, (high + change).upper())
        return any(bool(lo > hi) for lo, hi in boxes.values())

    def _way(self, boxes: dict[Variable, tuple[Any, Any]], k: int, j: int) -> tuple[Any, Any]:
        """Least and greatest displacement of a joint on a leg."""
        none = R(0), R(0)
        way = self.c[self.legs[k].end][j] - self.c[k][j]
        (a, b), (c, d) = (boxes.get(self.at_end("e", k, j, end), none) for end in (0, 1))
        return way + c - b, way + d - a

    def _narrowed(self, event: list[Any]) -> tuple[Variable, int]:
        """The variable that an event narrows, and from which side."""
        if event[1] == "T" and len(event) == 5:
            return ("T", self.leg(event[2])), index(event[3], 2)
        if event[1] in ("v", "a", "x") and len(event) == 6:
            i, j = index(event[2], self.claim.n + 1), index(event[3], self.claim.dof)
            key = self.at("e" if event[1] == "x" else event[1], i, j)
            need(key in self.boxes, "an event is about a waypoint or joint without a box")
            return key, index(event[4], 2)
        raise BadInput(f"unknown event {event!r:.60}")

    def least(self, cost: dict[Variable, Any], rows: list[Any], time: int = 0) -> Any:
        """Bound a linear cost from below over the boxes.

        Rows about sums of durations are added up per waypoint first, so that the work grows with the rows.

        Parameters
        ----------
        cost : dict
            Coefficients by variable.
        rows : list
            Rows with their multipliers, from the file.
        time : int
            Coefficient of the sum of all durations, beside the cost; 0 or 1.

        Returns
        -------
        arb
            The bound.
        """
        total, factors, last = R(0), dict(cost), self.ends[1]
        sums = {last: R(time)}  # coefficients of the sums of the durations before waypoints
        for raw in rows:
            raw = items(raw, 2, 11)
            require_row(raw)
            y = number(raw[-1])
            need(y >= 0, "a multiplier is negative")
            if raw[0] in SUMS:
                i, side, upper = self.arrival(raw)
                sums[i] = sums.get(i, R(0)) + side * y
            else:
                row, upper = self.row(raw)
                for key, x in row.items():
                    factors[key] = factors.get(key, R(0)) + y * x
            total -= y * upper
        if len(sums) == 1 and sums[last] >= 0:  # least where all durations are
            everywhere, rest = sums[last], self.least_times(last)[0]
        else:
            everywhere, rest = R(0), R(0)
            for k in reversed(self.ks):
                everywhere += sums.get(self.legs[k].end, R(0))
                factors["T", k] = factors.get(("T", k), R(0)) + everywhere
            everywhere = R(0)
        for key, x in factors.items():
            if key[0] == "T" and isinstance(key[1], int):
                x, rest = x + everywhere, rest - self.boxes[key][0]
            certainly_zero = x == 0  # a ball of 0 alone
            if not certainly_zero:
                lo, hi = self.box(key)
                total += least(x * lo, x * hi)
        return total + everywhere * rest
