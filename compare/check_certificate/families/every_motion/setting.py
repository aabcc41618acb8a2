"""The variables of a bound of every motion, and the intervals that hold them before anything is proved.

Leg k takes T seconds, q = T^2 and r = T^3, and u = 1 / T where T is certainly positive. At a waypoint, v and
a are velocity and acceleration, and the position is c + e with c the middle of the zone. g = T v, W = T a,
X = T^2 a and p = u e stand at both ends of a leg. The last waypoint of a cycle is its first, so their
variables are the same. A leg over several others has a T of its own, and all that is made of it.
"""

from __future__ import annotations

from itertools import accumulate
from typing import Any

from compare.check_certificate.answers import need
from compare.check_certificate.balls import Interval, R, least, most, product
from compare.check_certificate.claim import Claim
from compare.check_certificate.families.every_motion.course import Leg, course, leg_between, tighter
from compare.check_certificate.families.every_motion.implied import ImpliedLimits
from compare.check_certificate.tool.least_times import with_tool_times

Variable = tuple[Any, ...]
LegName = (
    int | tuple[int, int]
)  # the waypoint where it starts; of a leg over several others, both its ends
STATES = "vae"
POWERS = {"q": 2, "r": 3}
PRODUCTS = {"g": ("T", "v"), "W": ("T", "a"), "X": ("q", "a"), "p": ("u", "e")}  # by a power of T


class Setting:
    """Legs, limits and boxes.

    legs: by name; ks: those between two neighbours; spans: of the others, those that the proof mentioned.
    before: the leg that ends at a waypoint. kept: the waypoints at ends of legs; ends: the first and the last.
    joints: those that have v, and a where jerk is limited. c: middles of the zones. implied: what follows.
    V, A: per leg and joint, (down, up), with the implied limits. top: the same of the whole motion. J: per
    joint, the largest; None without one. waited: before each waypoint, the time of standing still at those
    kept; waits: all of it. budget: what is left for the legs. boxes: intervals of T, v, a and e; a joint
    without a zone has no e. void: whether they leave no motion.
    """

    def __init__(self, claim: Claim, H: Any) -> None:
        self.claim, self.demands = claim, with_tool_times(claim.demands())
        demands, dof = self.demands, range(claim.dof)
        legs = course(demands, claim.without)
        self.ks = [leg.start for leg in legs]
        self.legs: dict[LegName, Leg] = {leg.start: leg for leg in legs}
        self.spans: list[tuple[int, int]] = []
        self.before = {self.legs[k].end: k for k in self.ks}
        self.kept = [*self.ks, self.legs[self.ks[-1]].end]
        self.ends = (self.kept[0], self.kept[-1])
        sums = list(accumulate((demands.waits[i] for i in self.kept), initial=R(0)))
        self.waited, self.waits = dict(zip(self.kept, sums[:-1], strict=True)), sums[-1]
        self.budget = H - self.waits
        self.c = {i: [(lo + hi) / 2 for lo, hi in demands.waypoints[i]] for i in self.kept}
        stated = sum((self._shortest(leg, leg.velocity) for leg in self.legs.values()), R(0))
        self.implied = implied = ImpliedLimits(demands, H, stated + self.waits)
        self.J, self.fades = implied.jerk, implied.fades
        # a joint with a limit of velocity alone may jump in velocity
        limited = [j for j in dof if self.J[j] is not None or implied.limited[j]]
        limited = [j for j in limited if implied.top[j] is not None and implied.steep[j] is not None]
        self.joints = [j for j in limited if j in claim.moving] if demands.plain else limited
        self.V: dict[LegName, list[Interval]] = {}
        self.A: dict[LegName, list[Interval]] = {}
        for k, leg in self.legs.items():
            self._limit(k, leg)
        self.top = _both(implied.largest, implied.top)
        self.boxes: dict[Variable, Interval] = {}
        self.void = self._place_durations()
        for place, i in enumerate(self.kept):
            beside = self.ks[max(place - 1, 0) : place + 1]
            self._place_states(i, [self.ks[0], self.ks[-1]] if self.turns(i) else beside)

    def _limit(self, k: LegName, leg: Leg) -> None:
        """Put a leg and its limits, with the implied ones, under its name."""
        self.legs[k] = leg
        self.V[k] = _both(leg.velocity, self.implied.top)
        self.A[k] = _both(leg.acceleration, self.implied.steep)

    def span(self, start: int, end: int) -> tuple[int, int]:
        """Find a leg over several others, which exists from when it is mentioned first.

        Parameters
        ----------
        start, end : int
            Waypoints that are kept, not neighbours.

        Returns
        -------
        tuple of int
            Its name. Refuses the certificate where the motion waits between them, on no leg's time.
        """
        name = start, end
        if name not in self.legs:
            between = [i for i in self.kept if start < i < end]
            need(
                start in self.waited and end in self.waited, "a leg ends at a waypoint that is left out"
            )
            need(between, "a leg over several others has none between its ends")
            waits = any(bool(self.demands.waits[i] > 0) for i in between)
            need(not waits, "a wait on a leg over several others")
            self.spans.append(name)
            self._limit(name, leg_between(self.demands, start, end))
            leg = self.legs[name]
            low, high = self.sums(self.boxes, name)
            self.boxes["T", name] = (
                most(low, self._shortest(leg, self.V[name]).lower()),
                high if leg.times[1] is None else least(high, leg.times[1].upper()),
            )
        return name

    def sums(self, boxes: dict[Variable, Interval], span: tuple[int, int]) -> Interval:
        """Bound the duration of a leg over several others by those of all others.

        Parameters
        ----------
        boxes : dict
            Of the durations.
        span : tuple of int
            The leg.

        Returns
        -------
        tuple of two arb [s]
        """
        inside = [boxes["T", k] for k in self.ks if span[0] <= k < span[1]]
        low, high = (sum(ends, R(0)) for ends in zip(*inside, strict=True))
        outside = sum((boxes["T", k][0] for k in self.ks), R(0)) - low
        return low.lower(), least(high, self.budget - outside).upper()

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
        """Lower bound of the duration of a leg: as demanded, and the gap between zones at top speed.

        It is 0 where nothing forces time.
        """
        best = leg.times[0]
        zones = zip(self.demands.waypoints[leg.start], self.demands.waypoints[leg.end], strict=True)
        for j, ((a, b), (c, d)) in enumerate(zones):
            for gap, top in ((a - d, V[j][0]), (c - b, V[j][1])):
                if gap > 0 and top is not None:
                    best = most(best, gap / top)
        return best

    def _place_durations(self) -> bool:
        """Boxes of the durations; whether they leave no motion."""
        shortest = {k: self._shortest(leg, self.V[k]) for k, leg in self.legs.items()}
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
        for j, (lo, hi) in enumerate(demands.waypoints[i]):
            if lo < hi:
                half = ((hi - lo) / 2).upper()
                self.boxes[self.at("e", i, j)] = (-half, half)
        for j in self.joints:
            for letter, limits, given in of if self.J[j] is not None else of[:1]:
                low, high = (least(*(limits[k][j][side] for k in beside)) for side in (0, 1))
                low, high = (-low).lower(), high.upper()
                if end is not None:
                    asked_low, asked_high = given[end][j]
                    low = low if asked_low is None else most(low, asked_low)
                    high = high if asked_high is None else least(high, asked_high)
                if still:
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
        kind, k = key[:2]
        if kind in STATES:
            need(key in self.boxes, f"a row needs {kind} of joint {key[2] + 1}, which has none there")
            return self.boxes[key]
        lo, hi = self.boxes["T", k]
        if kind == "T":
            return lo, hi
        if kind == "u":
            self.require_time(k)
            return 1 / hi, 1 / lo
        if kind in POWERS:
            return lo ** POWERS[kind], hi ** POWERS[kind]
        power, state = PRODUCTS[kind]
        return product(self.box((power, k)), self.box(self.at_end(state, *key[1:])))

    def at_end(self, letter: str, k: LegName, j: int, end: int) -> Variable:
        """Name a variable at an end of a leg.

        Parameters
        ----------
        letter : str
            v, a or e.
        k : int or tuple of int
            The leg.
        j : int
            The joint.
        end : int
            0 where it starts, 1 where it ends.

        Returns
        -------
        tuple
        """
        return self.at(letter, self.waypoint(k, end), j)

    def waypoint(self, k: LegName, end: int) -> int:
        """Find a waypoint at an end of a leg.

        Parameters
        ----------
        k : int or tuple of int
            The leg.
        end : int
            0 where it starts, 1 where it ends.

        Returns
        -------
        int
        """
        leg = self.legs[k]
        return leg.end if end else leg.start

    def require_time(self, k: LegName) -> None:
        """Refuse to divide by a duration that may be 0.

        Parameters
        ----------
        k : int or tuple of int
            The leg.
        """
        start, positive = self.legs[k].start + 1, self.boxes["T", k][0] > 0
        need(positive, f"a row divides by a duration from waypoint {start} on, which may be 0")


def _both(limits: list[Interval], implied: list[Any]) -> list[Interval]:
    """Limits of each joint in both directions, with what is implied."""
    return [(tighter(down, x), tighter(up, x)) for (down, up), x in zip(limits, implied, strict=True)]
