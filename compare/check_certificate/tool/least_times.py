"""The least time of each segment that follows from limits on the tool.

The tool's path from one waypoint to the next is at least as long as the straight line between its ends,
and no part of it is passed faster than the speed s allowed there. So a segment takes the distance over s.
Where the waypoints are zones, w and w' points in them, and u the unit vector along p(w') - p(w), the
distance is at least u (p(w') - p(w)) less what each zone allows along u. A box |q - w| <= D allows

    sum_j |u J_j(w)| D_j + 1/2 sum_jk C_jk D_j D_k

by Taylor's formula, where C bounds the second derivatives of p between w and q. A ball of the tool allows
its radius.

The claim may name places that the tool cannot avoid on a segment: a joint that goes from below to above the
values c_1 < c_2 < ... (or from above to below) is at each of them in this order. Let x_i be the tool points
there. With vectors a_0, a_1, ..., none longer than 1, the tool's way is at least

    a_0 (x_1 - p(w)) + a_1 (x_2 - x_1) + ... = sum_i (a_{i-1} - a_i) x_i - a_0 p(w) + a_m p(w'),

and each (a_{i-1} - a_i) x_i is bounded over all points that the chain reaches with this joint at c_i.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from flint import arb_mat

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import R, least, most
from compare.check_certificate.reading import index, items, number
from compare.check_certificate.tool.chain import ClaimedChain
from compare.check_certificate.tool.link import length

if TYPE_CHECKING:
    from compare.check_certificate.demands import ClaimedDemands

TOOL_KEYS = ("chain", "end", "speed", "radius", "passes")
MOST_PLACES = 100  # on one segment


@dataclass
class ClaimedPlaces:
    """The places that the tool has to pass on a segment.

    joint: that passes the values. vectors: one more than values, arb_mat (1, 3).
    """

    joint: int
    values: list[Any]
    vectors: list[Any]


@dataclass
class ClaimedTool:
    """Limits on the tool, as exact numbers; None stands for no limit.

    chain: from base to tool. points: the waypoints that the balls are about [rad or m]. speed: [n], of the
    tool on each segment [m/s]. radius: [n + 1], how far the tool may pass that of each waypoint [m].
    places: by segment. slack: how far positions may leave their limits.
    """

    chain: ClaimedChain
    points: list[list[Any]]
    speed: list[Any]
    radius: list[Any]
    places: dict[int, ClaimedPlaces]
    slack: Any


def read_tool(raw: Any, points: list[list[Any]], slack: Any) -> ClaimedTool:
    """Read the limits on the tool.

    Parameters
    ----------
    raw : object
        From the file.
    points : list of list of arb, [n + 1][dof]
        The waypoints of the claim.
    slack : arb
        By how much positions may leave their limits [rad or m].

    Returns
    -------
    ClaimedTool
        Checked.
    """
    if not isinstance(raw, dict) or set(raw) != set(TOOL_KEYS):
        raise BadInput(f"demands.tool: it has the keys {', '.join(TOOL_KEYS)}")
    n = len(points) - 1
    speed, radius = (
        [None if x is None else number(x) for x in items(raw[key], size, size)]
        for key, size in (("speed", n), ("radius", n + 1))
    )
    given = [x for x in (*speed, *radius) if x is not None]
    need(given and all(x > 0 for x in given), "a limit on the tool is not positive, or none is given")
    chain = ClaimedChain.read(raw["chain"], raw["end"], len(points[0]))
    places = {
        index(k, n): _places(index(j, chain.dof), values, vectors)
        for k, j, values, vectors in (items(row, 4, 4) for row in items(raw["passes"], 0, n))
    }
    return ClaimedTool(chain, points, speed, radius, places, slack)


def _places(joint: int, values: Any, vectors: Any) -> ClaimedPlaces:
    """Read places; vectors that are longer than 1 are refused."""
    numbers = [number(x) for x in items(values, 1, MOST_PLACES)]
    steps = items(vectors, len(numbers) + 1, len(numbers) + 1)
    found = [arb_mat([[number(x) for x in items(row, 3, 3)]]) for row in steps]
    need(all(length(x.transpose()) <= 1 for x in found), "a vector of the tool's places is too long")
    return ClaimedPlaces(joint, numbers, found)


def with_tool_times(demands: ClaimedDemands) -> ClaimedDemands:
    """Raise the least times of the segments to those that the tool needs.

    Parameters
    ----------
    demands : ClaimedDemands
        Of a claim.

    Returns
    -------
    ClaimedDemands
        The same where the tool is not limited. Every motion that keeps the demands given keeps these.
    """
    if demands.tool is None:
        return demands
    pairs = zip(demands.durations, tool_times(demands, demands.tool), strict=True)
    return replace(demands, durations=[(most(lo, time), hi) for (lo, hi), time in pairs])


def tool_times(demands: ClaimedDemands, tool: ClaimedTool) -> list[Any]:
    """Bound the time of each segment from below by the tool's way at its greatest speed.

    Parameters
    ----------
    demands : ClaimedDemands
        The zones.
    tool : ClaimedTool
        Its limits.

    Returns
    -------
    list of arb, [n]
        Exact numbers [s], 0 where the speed is not limited.
    """
    ways = tool_ways(demands, tool)
    times = [R(0) if s is None else way / s for way, s in zip(ways, tool.speed, strict=True)]
    return [x.lower() for x in times]


def tool_ways(demands: ClaimedDemands, tool: ClaimedTool) -> list[Any]:
    """Bound the tool's way on each segment from below, by the straight line and by the places it passes.

    Parameters
    ----------
    demands : ClaimedDemands
        The zones.
    tool : ClaimedTool
        Its limits.

    Returns
    -------
    list of arb, [n]
        Exact numbers [m], 0 where the speed is not limited.
    """
    n, dof = len(tool.speed), range(tool.chain.dof)
    beside = {i for k in range(n) if tool.speed[k] is not None for i in (k, k + 1)}
    moved = {i: tool.chain.point_and_slopes(tool.points[i]) for i in beside}
    off = {
        i: [
            most(w - lo, hi - w, R(0))
            for w, (lo, hi) in zip(tool.points[i], demands.waypoints[i], strict=True)
        ]
        for i in beside
    }
    bends = tool.chain.bends(_reach(demands, tool))

    def allowed(i: int, u: Any) -> Any:
        """How far the tool may be nearer to the other end than that of the waypoint."""
        along = (u * moved[i]).entries()[1:]
        first = sum((abs(x) * d for x, d in zip(along, off[i], strict=True)), R(0))
        second = sum((bends[j][k] * off[i][j] * off[i][k] for j in dof for k in dof), R(0)) / 2
        by_box, radius = first + second, tool.radius[i]
        return by_box if radius is None else least(by_box, radius)

    def point(i: int) -> Any:
        return arb_mat([[moved[i][row, 0]] for row in range(3)])

    def by_places(k: int, places: ClaimedPlaces) -> Any:
        """The way by the places of a segment."""
        _require_passed(demands, k, places)
        first, last = places.vectors[0], places.vectors[-1]
        total = (last * point(k + 1))[0, 0] - (first * point(k))[0, 0]
        for value, a, b in zip(places.values, places.vectors, places.vectors[1:], strict=False):
            limits = demands.position[k]
            total += tool.chain.least_along(a - b, places.joint, value, limits, tool.slack)
        return total - allowed(k, first) - allowed(k + 1, last)

    def way(k: int) -> Any:
        step = point(k + 1) - point(k)
        middle = arb_mat([[x.mid()] for x in step.entries()])
        size, ways = length(middle), [R(0)]
        if size > 0:
            u = middle.transpose() / size
            ways.append((u * step)[0, 0] - allowed(k, u) - allowed(k + 1, u))
        if k in tool.places:
            ways.append(by_places(k, tool.places[k]))
        return most(*ways).lower()

    return [R(0) if tool.speed[k] is None else way(k) for k in range(n)]


def _reach(demands: ClaimedDemands, tool: ClaimedTool) -> list[Any]:
    """How far from 0 each joint can be at or between a waypoint and a point of its zone."""
    columns = zip(zip(*tool.points, strict=True), zip(*demands.waypoints, strict=True), strict=True)
    return [
        most(*map(abs, points), *(abs(x) for box in boxes for x in box)) for points, boxes in columns
    ]


def _require_passed(demands: ClaimedDemands, k: int, places: ClaimedPlaces) -> None:
    """Refuse places that the joint need not pass on a segment, in this order."""
    (a, b), (c, d) = (demands.waypoints[i][places.joint] for i in (k, k + 1))
    need(
        all(bool(x <= y) for x, y in pairwise([b, *places.values, c]))
        or all(bool(x >= y) for x, y in pairwise([a, *places.values, d])),
        "a joint need not pass the values of the tool's places",
    )
