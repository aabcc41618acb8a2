"""Joint angles against Cartesian points, by forward kinematics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from compare.audit.findings import Finding
from compare.audit.paper import Paper, Point
from compare.audit.paper.digits import halves, values
from formulations.arms import Arm, distance_to, pose_of
from formulations.arms.kinematics import Chain, error_of
from formulations.problem.arrays import Array

AXES = "xyz"


def points_of(paper: Paper) -> list[Finding]:
    """Check every printed point against its joint angles, and the printed arm against all points.

    Parameters
    ----------
    paper : Paper
        What the paper prints.

    Returns
    -------
    list of Finding
    """
    if paper.arm is None or paper.waypoints is None or not paper.points:
        return []
    arm = paper.arm
    found = [finding for point in paper.points for finding in _judged(paper, arm, point)]
    return found + _table(paper, arm)


def misses(paper: Paper, chain: Chain) -> list[float]:
    """Distance between the tool and each printed point.

    Parameters
    ----------
    paper : Paper
        What the paper prints.
    chain : Chain
        The arm.

    Returns
    -------
    list of float [m]
        One per waypoint; the smaller one where a waypoint has two printed points.
    """
    assert paper.waypoints is not None
    best: dict[int, float] = {}
    for p in paper.points:
        tool = chain.forward(paper.waypoints[p.waypoint])[:3, 3]
        miss = float(np.linalg.norm(tool - position_of(p)))
        best[p.waypoint] = min(miss, best.get(p.waypoint, miss))
    return list(best.values())


@dataclass(frozen=True)
class Residual:
    """How far joint angles and a printed point disagree, and what rounding allows.

    Attributes
    ----------
    tool : Array, shape (3,) [m]
        By forward kinematics of the printed joint angles.
    wanted : Array, shape (3,) [m]
        As printed.
    allowed : Array, shape (3,) [m]
        What rounding allows per coordinate.
    turn, turn_allowed : float [rad]
        Angle between the orientations, 0 where none is printed, and what rounding allows.
    """

    tool: Array
    wanted: Array
    allowed: Array
    turn: float
    turn_allowed: float

    @property
    def apart(self) -> Array:
        """Distance per coordinate, (3,) [m]."""
        return np.asarray(np.abs(self.tool - self.wanted))

    @property
    def moved(self) -> bool:
        """Whether the positions disagree for every reading of the digits."""
        return bool((self.apart > self.allowed + 1e-12).any())

    @property
    def turned(self) -> bool:
        """Whether the orientations disagree for every reading of the digits."""
        return self.turn > self.turn_allowed + 1e-12


def residual(paper: Paper, point: Point) -> Residual:
    """Hold a printed point against its joint angles.

    Parameters
    ----------
    paper : Paper
        It has an arm and waypoints.
    point : Point
        The point.

    Returns
    -------
    Residual
    """
    assert paper.arm is not None
    assert paper.waypoints is not None
    assert paper.halves is not None
    chain = paper.arm.chain
    q, h = paper.waypoints[point.waypoint], paper.halves[point.waypoint]
    pose, wanted = chain.forward(q), position_of(point)
    # first order in the half units, plus a bound of the second order: an arc of the whole arm's length
    jacobian = np.abs(chain.jacobian(q)[:3])
    length = np.abs(chain.d).sum() + np.abs(chain.a).sum()
    moved, turned = (0.0, 0.0) if paper.dh is None else paper.dh.blur
    allowed = jacobian @ h + 0.5 * h.sum() ** 2 * length + halves(point.position) * point.metre + moved
    turn = most = 0.0
    if point.rpy is not None:
        # each rounded angle turns the tool by at most its half unit
        turn = float(
            np.linalg.norm(error_of(pose_of(wanted, values(point.rpy) * point.radian), pose)[3:])
        )
        most = float(h.sum() + halves(point.rpy).sum() * point.radian) + turned
    return Residual(pose[:3, 3], wanted, allowed, turn, most)


def _judged(paper: Paper, arm: Arm, point: Point) -> list[Finding]:
    found, off = [], residual(paper, point)
    if off.moved:
        axis = int((off.apart - off.allowed).argmax())
        distance, _ = distance_to(arm, off.wanted)
        rounding = float(np.linalg.norm(halves(point.position))) * point.metre
        rounding += 0.0 if paper.dh is None else paper.dh.blur[0]
        numbers = {"apart": float(np.linalg.norm(off.apart)), "distance": distance}
        if distance > rounding + 1e-6:
            text = (
                f"the point is {1e3 * distance:.1f} mm out of reach of the arm, in any orientation; "
                f"the printed joint angles put the tool {1e3 * numbers['apart']:.1f} mm away from it"
            )
            return [Finding(paper.name, "reach", point.where, text, numbers=numbers)]
        text = (
            f"{AXES[axis]} is {1e3 * off.tool[axis]:.3f} mm by forward kinematics of joint angles "
            f"{point.waypoint + 1}, {1e3 * off.wanted[axis]:.3f} mm in print: "
            f"{1e3 * off.apart[axis]:.3g} mm apart where rounding allows {1e3 * off.allowed[axis]:.2g} mm"
        )
        found.append(Finding(paper.name, "point", point.where, text, numbers=numbers))
    if off.turned:
        text = (
            f"the tool is turned by {np.rad2deg(off.turn):.3g} deg against the printed angles, where "
            f"rounding allows {np.rad2deg(off.turn_allowed):.2g} deg"
        )
        found.append(Finding(paper.name, "point", point.where, text, numbers={"turn": off.turn}))
    return found


def _table(paper: Paper, arm: Arm) -> list[Finding]:
    """Whether the printed DH table leads to the printed points, and otherwise what does."""
    same = all(
        np.array_equal(getattr(arm.printed, part), getattr(arm.chain, part))
        for part in ("d", "a", "alpha", "offset", "sign")
    )
    if same:
        return []
    before, after = max(misses(paper, arm.printed)), max(misses(paper, arm.chain))
    numbers = {"printed": before, "resolved": after}
    lengths = all(
        np.array_equal(getattr(arm.printed, part), getattr(arm.chain, part))
        for part in ("d", "a", "alpha")
    )
    what = "with joint offsets, which are not printed," if lengths else "with the chain fitted to them"
    text = (
        f"the table as printed misses the printed points by up to {1e3 * before:.0f} mm; {what} "
        f"the misses are at most {1e3 * after:.3g} mm"
    )
    kind = "offsets" if lengths else "table"
    return [Finding(paper.name, kind, "DH table", text, numbers=numbers)]


def position_of(point: Point) -> Array:
    """Compute the position of a printed point.

    Parameters
    ----------
    point : Point
        The point.

    Returns
    -------
    Array, shape (3,) [m]
    """
    return values(point.position) * point.metre
