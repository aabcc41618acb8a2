"""A sound paper of an arm of three joints as data, to plant faults in; each joint takes its own optimum."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np

from compare.audit import Audit, Paper, audit, parse_papers
from formulations import Limits, Problem, family_optimum

DEG = np.pi / 180.0
WAYPOINTS = np.array([[10.0, -20.0, 30.0], [40.0, 15.0, -25.0], [75.0, 50.0, 20.0], [95.0, 80.0, 55.0]])
LIMITS = {
    "Table 3": ([60.0, 80.0, 70.0], [90.0, 70.0, 110.0]),
    "Table 4": ([95.0, 99.0, 120.0], [150.0] * 3),
}
DH = {"d": [320.0, 0.0, 45.0], "a": [40.0, 300.0, 250.0], "alpha": [90.0, 0.0, -90.0]}


def turn(axis: int, angle: float) -> np.ndarray:
    pose, (i, j) = np.eye(4), [(1, 2), (2, 0), (0, 1)][axis]
    pose[i, i] = pose[j, j] = np.cos(angle)
    pose[j, i], pose[i, j] = np.sin(angle), -np.sin(angle)
    return pose


def shift(x: float, z: float) -> np.ndarray:
    pose = np.eye(4)
    pose[[0, 2], 3] = x, z
    return pose


def tool(table: dict[str, Any], degrees: np.ndarray) -> np.ndarray:
    """The tool by elementary motions, mm: an oracle for both forms."""
    pose = np.eye(4)
    for i, angle in enumerate(degrees):
        d, a, alpha = (table[key][i] for key in ("d", "a", "alpha"))
        offset = table.get("offset", [0.0] * len(degrees))[i]
        link, joint = (
            shift(a, 0.0) @ turn(0, alpha * DEG),
            turn(2, (angle + offset) * DEG) @ shift(0.0, d),
        )
        if table.get("form", "standard") == "modified":
            pose = pose @ turn(0, alpha * DEG) @ shift(a, 0.0) @ joint
        else:
            pose = pose @ joint @ link
    return pose


def rpy_of(pose: np.ndarray) -> np.ndarray:
    level = np.hypot(pose[0, 0], pose[1, 0])
    return np.array(
        [
            np.arctan2(pose[2, 1], pose[2, 2]),
            np.arctan2(-pose[2, 0], level),
            np.arctan2(pose[1, 0], pose[0, 0]),
        ]
    )


@cache
def _optima(table: str, waypoints: bytes) -> list[np.ndarray]:
    points = np.frombuffer(waypoints).reshape(4, 3) * DEG
    velocity, acceleration = (np.array(row) * DEG for row in LIMITS[table])
    problem = Problem.of(points, Limits.of(velocity, acceleration, dof=3))
    return [family_optimum(problem.joint(j), starts=2).durations for j in range(3)]


def optima(table: str, waypoints: np.ndarray = WAYPOINTS) -> list[np.ndarray]:
    """Each joint's own optimum under the limits of a table."""
    return [times.copy() for times in _optima(table, waypoints.tobytes())]


@dataclass
class Sheet:
    """What the paper prints; a test changes one thing and reads it back."""

    waypoints: np.ndarray
    times: list[np.ndarray]
    totals: list[float]
    points: list[np.ndarray]
    rpy: list[np.ndarray]  # deg
    limits: dict[str, list[np.ndarray]]
    dh: dict[str, Any]
    waypoint_unit: str = "deg"
    units: dict[str, str] = field(default_factory=lambda: {"Table 3": "deg", "Table 4": "deg"})
    under: str = "Table 3"
    length: str = "mm"
    angle: str = "deg"
    dh_units: tuple[str, str] = ("mm", "deg")
    position: dict[str, list[list[float]]] = field(default_factory=dict)  # limits of position
    claim: str = "50.0"

    def text(self) -> str:
        """As a paper file; every number that is not whole is rounded."""

        def row(numbers: Any, digits: int) -> str:
            return "[" + ", ".join(f'"{x:.{digits}f}"' for x in numbers) + "]"

        lines = [
            'family = "3-5-3"', 'limited = ["velocity", "acceleration"]', "[waypoints]",
            f'unit = "{self.waypoint_unit}"', f"rows = [{', '.join(row(w, 4) for w in self.waypoints)}]",
            "[dh]", 'where = "Table 2"', f'form = "{self.dh.get("form", "standard")}"',
            f'length = "{self.dh_units[0]}"', f'angle = "{self.dh_units[1]}"',
            *(f"{key} = {list(map(float, self.dh[key]))}" for key in self.dh if key != "form"),
        ]  # fmt: skip
        for name, rows in self.limits.items():
            lines += ["[[limits]]", f'name = "{name}"', f'unit = "{self.units[name]}"']
            for key, limits in zip(("velocity", "acceleration"), rows, strict=True):
                lines.append(f"{key} = {list(map(float, limits))}")
            if name in self.position:
                lines.append(f"position = {self.position[name]}")
        times = ", ".join(row(t, 4) for t in self.times)
        lines += ["[[table]]", 'where = "Table 5"', f'limits = "{self.under}"', "joints = [1, 2, 3]"]
        lines += [f"times = [{times}]", f"totals = {row(self.totals, 4)}"]
        for k, (point, rpy) in enumerate(zip(self.points, self.rpy, strict=True), start=1):
            lines += ["[[point]]", f'where = "P{k}"', f"waypoint = {k}", f'length = "{self.length}"']
            lines += [f"position = {row(point, 3)}", f"rpy = {row(rpy, 3)}", f'angle = "{self.angle}"']
        lines += [
            "[[claim]]",
            'where = "abstract"',
            'says = "half"',
            'rule = "reduction"',
            "of = [4, 2]",
        ]
        return "\n".join([*lines, f'equals = "{self.claim}"'])

    def paper(self) -> Paper:
        return parse_papers(self.text(), "sheet")[0]

    def audited(self) -> Audit:
        return audit(self.paper())


def sound(dh: dict[str, Any] | None = None, waypoints: np.ndarray = WAYPOINTS) -> Sheet:
    """The paper without a fault, with points of a DH table that it may print otherwise."""
    times = optima("Table 3", waypoints)
    tools = [tool(dh or DH, w) for w in waypoints]
    return Sheet(
        waypoints=waypoints.copy(),
        times=times,
        totals=[float(t.round(4).sum()) for t in times],
        points=[pose[:3, 3] for pose in tools],
        rpy=[rpy_of(pose) / DEG for pose in tools],
        limits={name: [np.array(row) for row in rows] for name, rows in LIMITS.items()},
        dh=deepcopy(DH),
    )
