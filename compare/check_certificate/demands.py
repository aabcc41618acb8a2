"""What the motions of a claim have to keep: zones, limits and times, read from a file that may be hostile."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from compare.check_certificate.answers import BadInput, need
from compare.check_certificate.balls import Interval, R, least, most
from compare.check_certificate.reading import items, number
from compare.check_certificate.tool.least_times import ClaimedTool, read_tool

if TYPE_CHECKING:
    from compare.check_certificate.claim import Claim

KEYS = (
    "waypoints", "velocity", "acceleration", "jerk", "position", "end_velocity", "end_acceleration",
    "stops", "waits", "durations", "passages", "cyclic",
)  # fmt: skip
TOOL = "tool"  # a key beside them, where the tool is limited


@dataclass
class ClaimedDemands:
    """All that a motion has to keep, as exact numbers; None stands for no limit.

    Waypoints and segments count from 0, n segments.

    waypoints: [n + 1][dof], intervals of the positions [rad]. velocity, acceleration, position: [n][dof],
    intervals per segment. jerk: [n][dof]. end_velocity, end_acceleration: [2][dof], intervals. stops:
    [n + 1], where the motion stands still. waits: [n + 1], for how long [s]. durations: [n], intervals of
    the time from leaving a waypoint to arriving at the next [s]. passages: [n + 1], of arrivals. cyclic:
    whether position, velocity and acceleration are the same at both ends. tool: limits on it, if there are any.
    plain: from rest to rest through points, nothing else.
    """

    waypoints: list[list[Interval]]
    velocity: list[list[Interval]]
    acceleration: list[list[Interval]]
    jerk: list[list[Any]]
    position: list[list[Interval]]
    end_velocity: list[list[Interval]]
    end_acceleration: list[list[Interval]]
    stops: list[bool]
    waits: list[Any]
    durations: list[Interval]
    passages: list[Interval]
    cyclic: bool
    tool: ClaimedTool | None = None
    plain: bool = False


def plain_demands(claim: Claim) -> ClaimedDemands:
    """Write a problem without conditions as demands.

    Parameters
    ----------
    claim : Claim
        Its waypoints and limits.

    Returns
    -------
    ClaimedDemands
        Position limits are widened to the waypoints.
    """
    n, zero, nothing = claim.n, (R(0), R(0)), (R(0), None)
    velocity, acceleration, jerk = claim.limits
    ways = list(zip(*claim.w, strict=True))
    position = [
        (None if lo is None else least(lo, *x), None if hi is None else most(hi, *x))
        for (lo, hi), x in zip(claim.position, ways, strict=True)
    ]
    rest = [[zero] * claim.dof] * 2
    return ClaimedDemands(
        waypoints=[[(x, x) for x in row] for row in claim.w],
        velocity=[[_both_ways(x) for x in velocity]] * n,
        acceleration=[[_both_ways(x) for x in acceleration]] * n,
        jerk=[jerk] * n,
        position=[position] * n,
        end_velocity=rest,
        end_acceleration=rest,
        stops=[True, *[False] * (n - 1), True],
        waits=[R(0)] * (n + 1),
        durations=[nothing] * n,
        passages=[zero, *[nothing] * n],
        cyclic=False,
        plain=True,
    )


def _both_ways(limit: Any) -> Interval:
    return (None, None) if limit is None else (-limit, limit)


def read_demands(raw: Any, claim: Claim) -> ClaimedDemands:
    """Read the demands of a claim.

    Parameters
    ----------
    raw : object
        From the file.
    claim : Claim
        Its waypoints, which must lie in their boxes.

    Returns
    -------
    ClaimedDemands
        Checked. The first and the last box of a cycle are their intersection.

    Raises
    ------
    BadInput
        A key is missing or unknown, or an array has another shape.
    Refused
        The demands contradict one another.
    """
    if not isinstance(raw, dict):
        raise BadInput(f"demands: {raw!r:.40} is no object")
    if set(raw) - {TOOL} != set(KEYS):
        odd = sorted(map(str, (set(raw) - {TOOL}) ^ set(KEYS)))
        raise BadInput(f"demands: missing or unknown: {', '.join(odd)[:60]}")
    n, dof = claim.n, claim.dof

    def table(key: str, rows: int) -> list[list[Interval]]:
        return [[_interval(x) for x in items(row, dof, dof)] for row in items(raw[key], rows, rows)]

    def column(key: str, rows: int) -> list[Interval]:
        return [_interval(x) for x in items(raw[key], rows, rows)]

    stops, cyclic = items(raw["stops"], n + 1, n + 1), raw["cyclic"]
    if not all(isinstance(x, bool) for x in [*stops, cyclic]):
        raise BadInput("demands: stops and cyclic are true or false")
    found = ClaimedDemands(
        waypoints=table("waypoints", n + 1),
        velocity=table("velocity", n),
        acceleration=table("acceleration", n),
        jerk=[
            [None if x is None else number(x) for x in items(row, dof, dof)]
            for row in items(raw["jerk"], n, n)
        ],
        position=table("position", n),
        end_velocity=table("end_velocity", 2),
        end_acceleration=table("end_acceleration", 2),
        stops=stops,
        waits=[number(x) for x in items(raw["waits"], n + 1, n + 1)],
        durations=column("durations", n),
        passages=column("passages", n + 1),
        cyclic=cyclic,
    )
    _require_sense(found, claim)
    if TOOL in raw:
        found.tool = read_tool(raw[TOOL], claim.w, claim.slack)
    found.stops = [stop or bool(wait > 0) for stop, wait in zip(stops, found.waits, strict=True)]
    if cyclic:  # one point, with one state
        first, last = found.waypoints[0], found.waypoints[n]
        both = [(most(a, c), least(b, d)) for (a, b), (c, d) in zip(first, last, strict=True)]
        need(all(lo <= hi for lo, hi in both), "a cycle does not end where it starts")
        found.waypoints[0] = found.waypoints[n] = both
        found.stops[0] = found.stops[n] = stops[0] or stops[n]
    return found


def _interval(raw: Any) -> Interval:
    lo, hi = (None if x is None else number(x) for x in items(raw, 2, 2))
    need(lo is None or hi is None or lo <= hi, "an interval of the demands is empty")
    return lo, hi


def _require_sense(found: ClaimedDemands, claim: Claim) -> None:
    """Refuse demands that no problem has."""
    for row, box in zip(claim.w, found.waypoints, strict=True):
        inside = all(
            lo is not None and hi is not None and lo <= x <= hi
            for x, (lo, hi) in zip(row, box, strict=True)
        )
        need(inside, "a waypoint lies outside its zone")
    for name, whole in (("velocity", found.velocity), ("acceleration", found.acceleration)):
        about_zero = all(
            (lo is None or lo < 0) and (hi is None or hi > 0) for row in whole for lo, hi in row
        )
        need(about_zero, f"limits of {name} without 0 inside")
    need(all(x is None or x > 0 for row in found.jerk for x in row), "a limit of jerk is not positive")
    for j in range(claim.dof):
        sides: tuple[list[Any], ...] = (
            [row[j] for row in found.jerk],
            *(
                [row[j][side] for row in whole]
                for whole in (found.velocity, found.acceleration)
                for side in (0, 1)
            ),
        )
        need(
            all(len({x is None for x in side}) == 1 for side in sides),
            f"joint {claim.joint_name(j)} has a limit on some segments only",
        )
    need(all(x >= 0 for x in found.waits), "a wait is negative")
    need(found.waits[0] == 0 and found.waits[-1] == 0, "a wait at an end")
    times = [*found.durations, *found.passages]
    need(all(lo is not None and lo >= 0 for lo, _ in times), "a time is negative")
