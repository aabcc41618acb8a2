"""The limits on the tool that a claim states, for people: which speed, which balls, and which chain."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from compare.check_certificate.balls import R
from compare.check_certificate.tool.least_times import ClaimedTool, tool_ways
from compare.check_certificate.tool.link import Link, Pose

if TYPE_CHECKING:
    from compare.check_certificate.demands import ClaimedDemands


def tool_in_words(tool: ClaimedTool | None) -> list[str]:
    """Say what the tool has to keep, and on which chain.

    Parameters
    ----------
    tool : ClaimedTool or None
        Of the claim.

    Returns
    -------
    list of str
        Empty without limits on the tool.
    """
    if tool is None:
        return []
    speeds = [x for x in tool.speed if x is not None]
    balls = sum(x is not None for x in tool.radius)
    found = []
    if speeds:
        low, high = (f"{float(pick(speeds)):.6g}" for pick in (min, max))
        several = f"{low} to {high}" if low != high else high
        everywhere = "" if len(speeds) == len(tool.speed) else f" on {_counted(len(speeds), 'segment')}"
        found.append(f"a tool speed of at most {several} m/s{everywhere}")
    if balls:
        found.append(f"balls of the tool at {_counted(balls, 'waypoint')}")
    home = tool.chain.point_and_slopes([R(0)] * tool.chain.dof).entries()[:: 1 + tool.chain.dof]
    joints = " and ".join(
        _counted(number, f"{what} joint")
        for what, number in (("turning", tool.chain.turning), ("sliding", tool.chain.sliding))
        if number
    )
    return [*found, f"the tool on {joints} and at ({_numbers(home)}) m when they are at 0"]


def chain_in_words(demands: ClaimedDemands) -> list[str]:
    """Write the chain to the tool, and the least time of each segment that it implies, in SI units.

    Parameters
    ----------
    demands : ClaimedDemands
        Of the claim.

    Returns
    -------
    list of str
        A line per joint and per limited segment; empty without limits on the tool.
    """
    tool = demands.tool
    if tool is None:
        return []
    lines = [f"  {_link(place, link)}" for place, link in enumerate(tool.chain.links, 1)]
    lines.append(f"  tool: {_pose(tool.chain.end)}")
    ways = tool_ways(demands, tool)
    for k, (way, speed) in enumerate(zip(ways, tool.speed, strict=True), 1):
        if speed is not None:
            lines.append(
                f"  T{k} >= {float(way / speed):.9g}  [the tool's way of {float(way):.9g} m or more, "
                f"at {float(speed):.6g} m/s]"
            )
    return lines


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'s' if number > 1 else ''}"


def _numbers(values: list[Any]) -> str:
    return ", ".join(f"{round(float(x), 9) + 0.0:.9g}" for x in values)


def _pose(pose: Pose) -> str:
    """A fixed pose: its shift, and its matrix row by row where it turns."""
    rows = pose.linear.tolist()
    turns = any(bool(x != (i == j)) for i, row in enumerate(rows) for j, x in enumerate(row))
    turned = f", turned by [{'; '.join(_numbers(row) for row in rows)}]" if turns else ""
    return f"shifted by ({_numbers(pose.shift.entries())}){turned}"


def _link(place: int, link: Link) -> str:
    """One joint between its poses."""
    factor, offset = float(link.factor), float(link.offset)
    way = f"{'' if factor == 1.0 else f'{factor:.9g} '}q{link.joint + 1}"
    way += f" {'-' if offset < 0.0 else '+'} {abs(offset):.9g}" if offset else ""
    does = "slides along" if link.prismatic else "turns about"
    return (
        f"link {place}: {_pose(link.before)}; {does} ({_numbers(link.axis.entries())}) by {way}; "
        f"then {_pose(link.after)}"
    )
