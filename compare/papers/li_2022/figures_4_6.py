"""Li 2022, Fig. 4 (points and path of the tool) and Fig. 6 (curves of the joints)."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.audit.paper import settings
from compare.audit.paper.digits import values
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.li_2022.paper import paper, rows, whole_optimum
from compare.papers.measure import judged, peaks, spline
from compare.papers.pictures.panels import Curve, panels
from compare.papers.pictures.paths import length, path_views, tool_path
from compare.papers.verdicts import agrees, held, smooth, yes_no
from compare.report.style import BLUE, ORANGE, VERMILION
from formulations import load
from formulations.arms import load_arm

PLAN, RULE, BEST = "printed plan, 2 s a segment", "printed result, Table 3 starred", "certified optimum"
STYLES = {PLAN: (ORANGE, "-"), RULE: (VERMILION, "-"), BEST: (BLUE, "--")}
POINTS = "ABCDEFG"
_DIGIT = 1.0  # mm: the points are printed to it


def _motions() -> dict[str, dict[str, Any]]:
    """Judge the plan, the printed result and the optimum; find their peaks."""
    problem = load("bagging")
    durations = {
        PLAN: settings("bagging")["first_plan"]["times"],
        RULE: values(rows()[1].times).tolist(),
        BEST: whole_optimum()["durations"],
    }
    found = {}
    for name, times in durations.items():
        motion = spline(problem, times)
        found[name] = {
            **judged(problem, times),
            "peaks": peaks(motion).tolist(),
            "jumps": motion.jumps.max(axis=1).tolist(),
            "ends": [float(np.abs(motion.at([0.0, motion.seconds], k)).max()) for k in (1, 2)],
            "length": length(tool_path(load_arm("bagging"), motion, 4000)),
        }
    return found


def _label(name: str, motion: dict[str, Any]) -> str:
    return f"{name}, {motion['seconds']:.4f} s"


# --- Fig. 4 ---------------------------------------------------------------------------------------


def make_fig_4(full: bool) -> dict[str, Any]:
    """Judge the motions, and measure how far the tool passes from the printed points."""
    arm, problem = load_arm("bagging"), load("bagging")
    points = np.array([values(p.position) * p.metre for p in paper().points])
    tool = arm.chain.forward(problem.waypoints)[:, :3, 3]
    return {"motions": _motions(), "points": points.tolist(), "apart": (tool - points).tolist()}


def show_fig_4(data: dict[str, Any]) -> Shown:
    """Show three views, and the points one by one."""
    problem, arm, motions = load("bagging"), load_arm("bagging"), data["motions"]
    drawn = [
        (_label(name, m), STYLES[name], spline(problem, m["durations"])) for name, m in motions.items()
    ]
    points, apart = np.array(data["points"]), 1e3 * np.array(data["apart"])
    lines = [
        [
            name,
            *(f"{1e3 * x:g}" for x in point),
            *(f"{x:+.2f}" for x in miss),
            f"{np.linalg.norm(miss):.2f}",
        ]
        for name, point, miss in zip(POINTS, points, apart, strict=True)
    ]
    header = [
        "point",
        "x",
        "y",
        "z, printed [mm]",
        "x",
        "y",
        "z, by FK less printed [mm]",
        "apart [mm]",
    ]
    worst = int(np.linalg.norm(apart, axis=1).argmax())
    others = np.delete(np.linalg.norm(apart, axis=1), worst)
    reached = held(bool(np.linalg.norm(apart, axis=1).max() <= _DIGIT))
    remarks = [
        f"That the printed joint angles lead to the printed points is {reached.inside}: they do within "
        f"{others.max():.2f} mm, except for {POINTS[worst]}, which they miss by "
        f"{np.linalg.norm(apart[worst]):.2f} mm. The points are printed to {_DIGIT:g} mm.",
        "Straight lines from point to point are "
        f"{length(points):.3f} m long; the path of the tool is "
        + ", ".join(f"{m['length']:.3f} m long ({name})" for name, m in motions.items())
        + ".",
    ]
    table = Table(header, lines, "", range(1, 8))
    verdict = ItemVerdict("that the angles of Table 2 lead to the points", reached)
    return Shown([path_views(arm, drawn, points, list(POINTS)), table], remarks, [verdict])


# --- Fig. 6 ---------------------------------------------------------------------------------------


def make_fig_6(full: bool) -> dict[str, Any]:
    """Judge the motions and find their peaks."""
    return {"motions": _motions()}


def show_fig_6(data: dict[str, Any]) -> Shown:
    """Show plan and result together, and the optimum, whose accelerations are far larger, by itself."""
    problem, motions = load("bagging"), data["motions"]

    def drawn(*names: str) -> Any:
        return panels([
            (f"joint {j + 1}", [Curve(_label(n, motions[n]), STYLES[n], problem,
                                      spline(problem, motions[n]["durations"]), j) for n in names])
            for j in problem.moving_joints
        ])  # fmt: skip

    header = ["joint", *(f"speed [rad/s], {_short(n)}" for n in motions),
              *(f"acceleration [rad/s²], {_short(n)}" for n in motions)]  # fmt: skip
    lines = [
        [str(j + 1), *(f"{m['peaks'][order][j]:.3f}" for order in range(2) for m in motions.values())]
        for j in problem.moving_joints
    ]
    rule, best, plan = motions[RULE], motions[BEST], motions[PLAN]
    limit = float(problem.limits.velocity[0])
    continuous = smooth(*rule["jumps"], *rule["ends"])
    grown = max(rule["peaks"][1]) / max(plan["peaks"][1])
    remarks = [
        f"The printed motion takes {rule['seconds']:.4f} s. It is continuous in angle, speed and acceleration "
        f"and starts and ends at rest: {yes_no(continuous)}, {agrees(continuous)} (largest jump "
        f"{max(rule['jumps']):.1g}, largest value at the ends {max(rule['ends']):.1g}).",
        f"It keeps the assumed {limit:.4f} rad/s: {yes_no(rule['keeps'])}, and uses "
        f"{100 * max(rule['peaks'][0]) / limit:.1f} % of it. The text calls its accelerations small; they "
        "reach "
        f"{max(rule['peaks'][1]):.2f} rad/s², {grown:.1f} times those of the plan.",
        f"Without a limit on acceleration the optimum takes {best['seconds']:.4f} s and reaches "
        f"{max(best['peaks'][1]):.0f} rad/s², {max(best['peaks'][1]) / max(rule['peaks'][1]):.0f} times the "
        "acceleration of the printed motion: the task has to state an acceleration limit, too.",
    ]
    table = Table(header, lines, "Peaks.", range(1, 7))
    verdict = ItemVerdict("that the motion is continuous, and at rest at its ends", held(continuous))
    return Shown([drawn(PLAN, RULE), drawn(BEST), table], remarks, [verdict])


def _short(name: str) -> str:
    return {PLAN: "plan", RULE: "printed result", BEST: "optimum"}[name]


FIGURE_4 = Item(
    "Fig 4",
    "the points and the path of the tool",
    make_fig_4,
    show_fig_4,
    "The printed picture has the points alone. The path of each motion, by forward kinematics, is added.",
    cost=8.0,
)
FIGURE_6 = Item(
    "Fig 6",
    "angle, speed and acceleration of every joint",
    make_fig_6,
    show_fig_6,
    "The starred times of Table 3 for all joints; joint 4 does not move. The velocity limit is not printed, "
    "pi rad/s is assumed.",
    cost=8.0,
)
