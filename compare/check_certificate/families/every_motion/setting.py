"""The variables of a bound of every motion, and the intervals that hold them before anything is proved.

Leg k takes T seconds, u = 1 / T, q = T^2. At a waypoint, v and a are velocity and acceleration, and the
position is c + e with c the middle of the zone. W = T a and p = e / T stand at both ends of a leg. The
last waypoint of a cycle is its first, so their variables are the same.
"""

from __future__ import annotations

from itertools import accumulate
from typing import Any

from compare.check_certificate.answers import need
from compare.check_certificate.balls import Interval, R, least, most, product
from compare.check_certificate.claim import Claim
from compare.check_certificate.families.every_motion.course import Leg, course, tighter
from compare.check_certificate.families.every_motion.implied import ImpliedLimits
from compare.check_certificate.tool.least_times import with_tool_times

Variable = tuple[Any, ...]


class Setting:
    """Legs, limits and boxes.

    legs: by the waypoint where each starts, ks; after: where it ends; before: the
    opposite. kept: the waypoints at their ends; ends:
    the first and the last of them. joints: those that rows may be about. c: middles of the zones. V, A: per
    leg and joint, (down, up), with the implied limits. top: the same of the whole motion. J: per joint, the
    largest; None without one. waited: before each waypoint, the time of standing still at those kept; waits:
    all of it. budget: what is left for the legs. boxes: intervals of T, v, a and e; a joint without a zone
    has no e. void: whether they leave no motion.
    """

    def __init__(self, claim: Claim, H: Any) -> None:
        self.claim, self.demands = claim, with_tool_times(claim.demands())
        demands, dof = self.demands, range(claim.dof)
        self.legs = course(demands, claim.without)
        self.ks = list(self.legs)
        self.after = {k: leg.end for k, leg in self.legs.items()}
        self.before = {end: k for k, end in self.after.items()}
        self.kept = [*self.ks, self.after[self.ks[-1]]]
        self.ends = (self.kept[0], self.kept[-1])
        sums = list(accumulate((demands.waits[i] for i in self.kept), initial=R(0)))
        self.waited, self.waits = dict(zip(self.kept, sums[:-1], strict=True)), sums[-1]
        self.budget = H - self.waits
        self.c = {i: [(lo + hi) / 2 for lo, hi in demands.waypoints[i]] for i in self.kept}
        stated = sum((self._shortest(leg, leg.velocity) for leg in self.legs.values()), R(0))
        implied = ImpliedLimits(demands, H, stated + self.waits)
        self.J, self.fades = implied.jerk, implied.fades
        limited = [j for j in dof if self.J[j] is not None or implied.limited[j]]
        self.joints = [j for j in limited if j in claim.moving] if demands.plain else limited
        for j in self.joints:
            known = implied.top[j] is not None and implied.steep[j] is not None
            need(known, f"joint {claim.joint_name(j)} lacks a limit of velocity or acceleration")
        self.V = {k: _both(leg.velocity, implied.top) for k, leg in self.legs.items()}
        self.A = {k: _both(leg.acceleration, implied.steep) for k, leg in self.legs.items()}
        self.top = _both(implied.largest, implied.top)
        self.boxes: dict[Variable, Interval] = {}
        self.void = self._place_durations()
        for place, i in enumerate(self.kept):
            beside = self.ks[max(place - 1, 0) : place + 1]
            self._place_states(i, [self.ks[0], self.ks[-1]] if self.turns(i) else beside)

    def turns(self, i: int) -> bool:
        """Tell whether a waypoint is where a cycle starts again.

        Parameters
        ----------
        i : int
            The waypoint.

        Returns
        -------
        bool
        """
        return self.demands.cyclic and i in self.ends

    def at(self, letter: str, i: int, j: int) -> Variable:
        """Name a variable at a waypoint.

        Parameters
        ----------
        letter : str
            v, a or e.
        i, j : int
            Waypoint and joint.

        Returns
        -------
        tuple
            The same one at both ends of a cycle.
        """
        return letter, self.ends[0] if self.turns(i) else i, j

    def _shortest(self, leg: Leg, V: list[Interval]) -> Any:
        """Lower bound of the duration of a leg: as demanded, and the gap between zones at top speed."""
        best = leg.times[0]
        zones = zip(self.demands.waypoints[leg.start], self.demands.waypoints[leg.end], strict=True)
        for j, ((a, b), (c, d)) in enumerate(zones):
            for gap, top in ((a - d, V[j][0]), (c - b, V[j][1])):
                if gap > 0:
                    name = self.claim.joint_name(j)
                    need(top is not None or V is leg.velocity, f"joint {name} has no limit")
                    best = best if top is None else most(best, gap / top)
        return best

    def _place_durations(self) -> bool:
        """Boxes of the durations; whether they leave no motion."""
        shortest = {k: self._shortest(leg, self.V[k]) for k, leg in self.legs.items()}
        need(all(t > 0 for t in shortest.values()), "nothing forces time on a leg")
        total = sum(shortest.values(), R(0))
        for k, t in shortest.items():
            longest = tighter(self.legs[k].times[1], self.budget - (total - t))
            self.boxes["T", k] = (t.lower(), longest.upper())
        return bool(total > self.budget) or any(bool(lo > hi) for lo, hi in self.boxes.values())

    def _place_states(self, i: int, beside: list[int]) -> None:
        """Boxes of the states at a waypoint, from the limits of the legs beside it."""
        demands = self.demands
        end = None if demands.cyclic or i not in self.ends else self.ends.index(i)
        still = demands.stops[i] or (demands.plain and end is not None)
        of = ("v", self.V, demands.end_velocity), ("a", self.A, demands.end_acceleration)
        for j in self.joints:
            lo, hi = demands.waypoints[i][j]
            if lo < hi:
                half = ((hi - lo) / 2).upper()
                self.boxes[self.at("e", i, j)] = (-half, half)
            for letter, limits, given in of:
                low, high = (least(*(limits[k][j][side] for k in beside)) for side in (0, 1))
                low, high = (-low).lower(), high.upper()
                if end is not None:
                    asked_low, asked_high = given[end][j]
                    low = low if asked_low is None else most(low, asked_low)
                    high = high if asked_high is None else least(high, asked_high)
                if still or (letter == "a" and self.J[j] is None):
                    low = high = R(0)
                need(low <= high, "no state is allowed at an end")
                self.boxes[self.at(letter, i, j)] = (low, high)

    def box(self, key: Variable) -> Interval:
        """Find the interval of a variable.

        Parameters
        ----------
        key : tuple
            The variable: its kind, then leg or waypoint, joint, end.

        Returns
        -------
        tuple of two arb
            Its ends.
        """
        kind, k = key[0], key[1]
        if kind in ("T", "a", "v", "e"):
            return self.boxes[key]
        lo, hi = self.boxes["T", k]
        if kind == "q":
            return lo * lo, hi * hi
        if kind == "u":
            return 1 / hi, 1 / lo
        j, i = key[2], self.after[k] if key[3] else k
        if kind == "p":
            return product((1 / hi, 1 / lo), self.boxes[self.at("e", i, j)])
        need(self.J[j] is not None, "a row needs an acceleration at a waypoint that may jump")
        return product((lo, hi), self.boxes[self.at("a", i, j)])


def _both(limits: list[Interval], implied: list[Any]) -> list[Interval]:
    """Limits of each joint in both directions, with what is implied."""
    return [(tighter(down, x), tighter(up, x)) for (down, up), x in zip(limits, implied, strict=True)]
