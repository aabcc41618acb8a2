"""The course of a motion: the waypoints that a proof keeps, and the limits between them.

A proof may leave out inner waypoints, which allows more motions. What lies between two waypoints that are
kept is a leg, with the number of the waypoint where it starts. The loosest limits of its segments hold on
all of it, and waits inside it are a part of its time. Where the zones of two waypoints meet, a motion may be
at both at one time: the leg between them may take no time.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from compare.check_certificate.balls import Interval, R, least, most
from compare.check_certificate.demands import ClaimedDemands


@dataclass
class Leg:
    """Limits between two waypoints that are kept; None stands for no limit.

    start, end: the waypoints. velocity, acceleration: (down, up) per joint, moduli in both directions.
    jerk: per joint. position: intervals per joint. times: least and greatest duration [s].
    """

    start: int
    end: int
    velocity: list[Interval]
    acceleration: list[Interval]
    jerk: list[Any]
    position: list[Interval]
    times: Interval


def course(demands: ClaimedDemands, without: frozenset[int]) -> list[Leg]:
    """Find the legs of every motion that keeps some demands.

    Parameters
    ----------
    demands : ClaimedDemands
        Waypoints, limits and times.
    without : frozenset of int
        Inner waypoints that are left out.

    Returns
    -------
    list of Leg
        In order.
    """
    everywhere = range(len(demands.durations) + 1)
    kept = _of_points(demands) if demands.plain else [i for i in everywhere if i not in without]
    return [leg_between(demands, start, end) for start, end in pairwise(kept)]


def _of_points(demands: ClaimedDemands) -> list[int]:
    """Waypoints of a plain problem that differ from the next one, and where the motion ends."""
    points = [[lo for lo, _ in row] for row in demands.waypoints]
    moving = [
        k
        for k, pair in enumerate(pairwise(points))
        if not all(a == b for a, b in zip(*pair, strict=True))
    ]
    return [*moving, moving[-1] + 1]


def leg_between(demands: ClaimedDemands, start: int, end: int) -> Leg:
    """Take the loosest limits of the segments from one waypoint to another.

    Parameters
    ----------
    demands : ClaimedDemands
        Limits and times.
    start, end : int
        The waypoints.

    Returns
    -------
    Leg
        Waits at waypoints between them are a part of its time.
    """
    part = slice(start, end)
    between = demands.waits[start + 1 : end]
    shortest = sum((lo for lo, _ in demands.durations[part]), sum(between, R(0)))
    tops = [hi for _, hi in demands.durations[part]]
    no_most = any(hi is None for hi in tops) or any(wait > 0 for wait in between)
    rows = [demands.velocity, demands.acceleration, demands.position]
    velocity, acceleration, position = (
        [loosest(x) for x in zip(*row[part], strict=True)] for row in rows
    )
    return Leg(
        start,
        end,
        [moduli(x) for x in velocity],
        [moduli(x) for x in acceleration],
        [most_of(x) for x in zip(*demands.jerk[part], strict=True)],
        position,
        (shortest, None if no_most else sum(tops, R(0))),
    )


def loosest(intervals: Any) -> Interval:
    """Find the interval that holds several.

    Parameters
    ----------
    intervals : iterable of Interval
        None stands for no limit.

    Returns
    -------
    Interval
        None where one has no limit.
    """
    lows, highs = zip(*intervals, strict=True)
    low = most_of([None if x is None else -x for x in lows])
    return None if low is None else -low, most_of(highs)


def moduli(interval: Interval) -> Interval:
    """Turn an interval about 0 into how far it reaches down and up.

    Parameters
    ----------
    interval : Interval
        None stands for no limit.

    Returns
    -------
    Interval
        (down, up), both positive.
    """
    low, high = interval
    return None if low is None else -low, high


def most_of(limits: Any) -> Any:
    """Find the largest of several limits.

    Parameters
    ----------
    limits : iterable of arb or None
        None stands for no limit.

    Returns
    -------
    arb or None
        None where one is missing.
    """
    values = list(limits)
    return None if any(x is None for x in values) else most(*values)


def tighter(one: Any, other: Any) -> Any:
    """Take the smaller of two limits.

    Parameters
    ----------
    one, other : arb or None
        None stands for no limit.

    Returns
    -------
    arb or None
        None without both.
    """
    if one is None or other is None:
        return other if one is None else one
    return least(one, other)
