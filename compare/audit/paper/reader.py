"""A paper's TOML file -> ``Paper``. Every error is one line that names the key."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from compare.audit.paper.dh import read_dh
from compare.audit.paper.digits import halves, printed, reach, row, values
from compare.audit.paper.format import FORMAT
from compare.audit.paper.keys import check_keys
from compare.audit.paper.limits import StatedLimits
from compare.audit.paper.records import (
    RULES,
    ArithmeticClaim,
    LeftOut,
    Paper,
    Point,
    PrintedTimes,
    Total,
)
from formulations import FAMILIES, InputError
from formulations.arms import ARMS, Arm, load_arm
from formulations.motion.verdict import QUANTITIES
from formulations.problem.arrays import Array
from formulations.problem.joint_words import METRES, UNITS
from formulations.problem.toml_file.toml_text import parse_toml
from formulations.robot.text.files import known_names, nearest_of

_MOST_JOINTS = 100  # of an arm whose waypoints are not printed


def parse_papers(text: str, name: str) -> list[Paper]:
    """Read a paper and its variants from a TOML text.

    Parameters
    ----------
    text : str
        The TOML text.
    name : str
        Of the paper.

    Returns
    -------
    list of Paper

    Raises
    ------
    InputError
        One line that names the key.
    """
    data = parse_toml(text, name)
    try:
        check_keys(data, FORMAT)
        paper = _paper(data, name)
        variants = [_variant(paper, table) for table in data.get("variant", [])]
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    except KeyError as error:
        raise InputError(f"{name}: {error.args[0]}: missing") from None
    return [paper, *variants]


def _paper(data: dict[str, Any], name: str) -> Paper:
    family = _one_of("family", data["family"], FAMILIES)
    limited = tuple(data.get("limited", ["velocity"]))
    for quantity in limited:
        _one_of("limited", quantity, QUANTITIES[1:])
    table = data["waypoints"]
    unit = _one_of("waypoints: unit", table["unit"], UNITS)
    waypoints = half = None
    count = table.get("count", 0)
    if "rows" in table:
        grid = [row(f"waypoints: rows: row {i + 1}", r) for i, r in enumerate(table["rows"])]
        if not grid or len({len(r) for r in grid}) > 1:
            raise InputError("waypoints: rows: expected rows of equal length")
        waypoints = np.array([values(r) for r in grid]) * UNITS[unit]
        half = np.array([halves(r) for r in grid]) * UNITS[unit]
        count = len(grid)
    elif count < 2:
        raise InputError(f"waypoints: rows: missing (or count of two or more, got {count!r:.50})")
    dof = None if waypoints is None else waypoints.shape[1]
    dh = read_dh(data["dh"], dof) if "dh" in data else None
    arm = _arm(data, dof) if dh is None else dh.arm(name)
    if dh is not None and "arm" in data:
        raise InputError("arm: given beside [dh]; keep one of them")
    stated = {s.name: s for s in (_stated(t, dof) for t in data.get("limits", []))}
    shown = next((t["unit"] for t in data.get("limits", [])), unit)
    paper = Paper(
        name=name,
        title=data.get("title", name),
        source=" ".join(data.get("source", "").split()),
        notes=" ".join(data.get("notes", "").split()),
        family=family,
        arm=arm,
        dh=dh,
        limited=limited,
        unit=shown,
        waypoint_unit=unit,
        n_waypoints=count,
        waypoints=waypoints,
        halves=half,
        stated=stated,
        rows=(),
        totals=(),
        claims=tuple(_claim(t) for t in data.get("claim", [])),
        points=tuple(_point(t, count) for t in data.get("point", [])),
        settings=data.get("settings", {}),
        left_out=tuple(_left_out(t) for t in data.get("left_out", [])),
    )
    rows: list[PrintedTimes] = []
    totals: list[Total] = []
    for entry in data.get("table", []):
        rows += _rows(paper, entry)
    for entry in data.get("totals", []):
        place = f"totals: {entry['where']}"
        limits = _limits(place, paper, entry)
        joint = _joint(f"{place}: joint", paper, entry.get("joint"))
        numbers = row(f"{place}: values", entry["values"])
        totals += [Total(entry["where"], entry.get("by", ""), joint, v, limits) for v in numbers]
    means = tuple(
        ArithmeticClaim(
            where=f"{t['where']}, {t.get('by', '')}".rstrip(", "),
            says=f"mean of {len(t['values'])} runs",
            rule="mean",
            of=row("totals", t["values"]),
            equals=printed("totals: mean", t["mean"]),
        )
        for t in data.get("totals", [])
        if "mean" in t
    )
    return replace(paper, rows=tuple(rows), totals=tuple(totals), claims=means + paper.claims)


def _arm(data: dict[str, Any], dof: int | None) -> Arm | None:
    """The shipped arm that the file names."""
    if "arm" not in data:
        return None
    arm = load_arm(_one_of("arm", data["arm"], ARMS))
    if dof is not None and dof != arm.dof:
        raise InputError(f"arm: {arm.name} has {arm.dof} joints, the waypoints have {dof}")
    return arm


def _variant(paper: Paper, table: dict[str, Any]) -> Paper:
    if paper.waypoints is None or paper.halves is None:
        raise InputError("variant: there are no waypoints to vary")
    number = printed("variant: value", table["value"])
    waypoints, half = paper.waypoints.copy(), paper.halves.copy()
    for key, most in zip(("waypoint", "joint"), waypoints.shape, strict=True):
        if not 1 <= table[key] <= most:
            raise InputError(f"variant: {key}: {table[key]!r:.50} is not one of 1 to {most}")
    at = (table["waypoint"] - 1, table["joint"] - 1)
    # in the unit of the waypoints: the printed one tells it
    printed_in = [u for u in UNITS.values() if np.isclose(abs(waypoints[at]), abs(number.value) * u)]
    if not printed_in:
        raise InputError(f"variant: value: {number} and the printed value differ in more than the sign")
    unit = printed_in[0]
    waypoints[at], half[at] = number.value * unit, number.half * unit
    return replace(paper, name=table["name"], waypoints=waypoints, halves=half, claims=(), points=())


def _rows(paper: Paper, table: dict[str, Any]) -> list[PrintedTimes]:
    """Rows of a table of joints, and the rule's vector made of them, if the paper goes on to that."""
    where, by = table["where"], table.get("by", "")
    limits = _limits(f"table: {where}", paper, table)
    joints, times = table["joints"], table["times"]
    totals = table.get("totals", [None] * len(joints))
    if not joints:
        raise InputError(f"table: {where}: joints is empty")
    if not len(joints) == len(times) == len(totals):
        raise InputError(f"table: {where}: joints, times and totals differ in length")
    rows = []
    for joint, vector, total in zip(joints, times, totals, strict=True):
        joint = None if joint == "all" else joint
        at = where if joint is None else f"{where}, joint {joint!s:.50}"
        numbers = row(f"table: {at}: times", vector, paper.n_waypoints - 1, _segments(paper))
        sums = None if total is None else printed(f"table: {at}: totals", total)
        number = _joint(f"table: {where}: joints", paper, joint)
        rows.append(PrintedTimes(at, by, number, numbers, sums, limits))
    if "longest" in table or "longest_where" in table:
        at = table.get("longest_where", f"{where}, longest")
        columns = zip(*(r.times for r in rows), strict=True)
        longest = tuple(max(column, key=lambda number: number.value) for column in columns)
        if "longest" in table:
            longest = row(
                f"table: {where}: longest", table["longest"], paper.n_waypoints - 1, _segments(paper)
            )
        total = printed(f"table: {where}: total", table["total"]) if "total" in table else None
        rows.append(PrintedTimes(at, by, None, longest, total, limits, tuple(rows)))
    return rows


def _stated(table: dict[str, Any], dof: int | None) -> StatedLimits:
    name = table["name"]
    unit = UNITS[_one_of(f"limits: {name}: unit", table["unit"], UNITS)]
    width = 1 if "joint" in table else dof
    rows: list[Array] = []
    blur: list[Array] = []
    for quantity in QUANTITIES[1:]:
        raw = table.get(quantity)
        if raw is None:
            if not rows and width is None:
                raise InputError(f"limits: {name}: velocity: missing")
            rows.append(np.full(width or len(rows[0]), np.inf))
            blur.append(np.zeros(len(rows[-1])))
            continue
        key = f"limits: {name}: {quantity}"
        digits = row(key, raw if isinstance(raw, list) else [raw], width)
        numbers = values(digits)
        if not (numbers * unit > 0.0).all():
            raise InputError(f"{key}: {numbers.min():g} is not positive")
        rows.append(numbers * unit)
        blur.append(reach(digits) * unit)
        width = len(numbers)
    position = np.tile([-np.inf, np.inf], (len(rows[0]), 1))
    around = np.zeros_like(position)
    if "position" in table:
        key = f"limits: {name}: position"
        if len(table["position"]) != width:
            raise InputError(f"{key}: {len(table['position'])} ranges where {width} are expected")
        ranges = [row(f"{key}: row {i + 1}", r, 2) for i, r in enumerate(table["position"])]
        position = np.array([values(r) for r in ranges]) * unit
        around = np.array([reach(r) for r in ranges]) * unit
    joint = table["joint"] - 1 if "joint" in table else None
    most = _MOST_JOINTS if dof is None else dof
    if joint is not None and not 0 <= joint < most:
        raise InputError(f"limits: {name}: joint: {table['joint']!r:.50} is not one of 1 to {most}")
    return StatedLimits(name, joint, np.stack(rows), position, np.stack(blur), around, table["unit"])


def _claim(table: dict[str, Any]) -> ArithmeticClaim:
    where = table["where"]
    rule = _one_of(f"claim: {where}: rule", table["rule"], RULES)
    of = row(f"claim: {where}: of", table["of"], 2 if rule in ("difference", "reduction") else None)
    return ArithmeticClaim(
        where, table["says"], rule, of, printed(f"claim: {where}: equals", table["equals"])
    )


def _point(table: dict[str, Any], count: int) -> Point:
    where = table["where"]
    if not 1 <= table["waypoint"] <= count:
        raise InputError(f"point: {where}: waypoint {table['waypoint']} is not one of 1 to {count}")
    metre = METRES[_one_of(f"point: {where}: length", table["length"], METRES)]
    rpy = row(f"point: {where}: rpy", table["rpy"], 3) if "rpy" in table else None
    position = row(f"point: {where}: position", table["position"], 3)
    radian = UNITS[_one_of(f"point: {where}: angle", table.get("angle", "rad"), UNITS)]
    return Point(where, table["waypoint"] - 1, position, rpy, metre, radian)


def _left_out(table: dict[str, Any]) -> LeftOut:
    where, what, why = (" ".join(table[key].split()) for key in ("where", "what", "why"))
    return LeftOut(where, what, why)


def _limits(place: str, paper: Paper, table: dict[str, Any]) -> str | None:
    """Find the table of limits that a time vector or a total refers to."""
    name = table.get("limits")
    if name is not None and name not in paper.stated:
        raise InputError(
            f"{place}: limits: no [[limits]] has the name {name!r:.50}; {known_names(name, paper.stated)}"
        )
    return name


def _segments(paper: Paper) -> str:
    """Say where the number of segments comes from."""
    return f"waypoints: {'count' if paper.waypoints is None else 'rows'}: {paper.n_waypoints}"


def _joint(key: str, paper: Paper, joint: Any) -> int | None:
    if joint is None:
        return None
    dof = 0 if paper.waypoints is None else paper.waypoints.shape[1]
    if isinstance(joint, bool) or not isinstance(joint, int) or not 1 <= joint <= dof:
        raise InputError(f"{key}: {joint!r:.50} is not one of 1 to {dof}")
    return joint - 1


def _one_of(key: str, value: Any, known: Any) -> str:
    if value not in known:
        near = nearest_of(str(value), known)
        meant = f"; did you mean {near!r}?" if near else ""
        names = ", ".join(f"{name:.50}" for name in known)
        raise InputError(f"{key}: {value!r:.50} is not one of {names}{meant}")
    return str(value)
