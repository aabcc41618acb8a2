"""Lu 2024, Fig. 4: the model of the arm."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from compare.papers.item import Item, Shown
from compare.report.motion_picture import VIEWS, skeleton
from compare.report.style import BLACK, GREY, SKY, VERMILION, styled
from formulations import load
from formulations.arms import load_arm, workspace

_CLOUD = 2500  # points that are drawn


def make_arm(full: bool) -> dict[str, Any]:
    """Compute the arm at its first waypoint and its Monte Carlo workspace."""
    arm, problem = load_arm("z1"), load("z1")
    count = 200_000 if full else 20_000
    cloud = workspace(arm, count)
    tool = arm.chain.forward(problem.waypoints)[:, :3, 3]
    middle = np.array([0.0, 0.0, arm.chain.d[0]])
    return {
        "bones": skeleton(arm, problem.waypoints[0]).tolist(),
        "tool": tool.tolist(),
        "cloud": np.round(cloud[:: count // _CLOUD], 4).tolist(),
        "count": count,
        "low": cloud.min(axis=0).tolist(),
        "high": cloud.max(axis=0).tolist(),
        "reach": float(np.linalg.norm(cloud - middle, axis=1).max()),
        "most": float(np.abs(arm.chain.a).sum() + arm.chain.d[-1]),
        "d1": [float(arm.printed.d[0]), float(arm.chain.d[0])],
    }


@styled
def arm_figure(data: dict[str, Any]) -> Figure:
    """Draw two views of the arm in its workspace."""
    figure, panels = plt.subplots(1, 2, figsize=(10.0, 5.0))
    parts = (np.array(data[name]) for name in ("cloud", "bones", "tool"))
    cloud, bones, tool = parts
    for axes, view in zip(panels, VIEWS, strict=True):
        for points, style, label in (
            (cloud, {"marker": ".", "ms": 1.5, "ls": "", "color": SKY, "alpha": 0.5}, "workspace"),
            (bones, {"marker": "o", "ms": 3, "lw": 3.0, "color": BLACK}, "arm at waypoint 1"),
            (tool, {"marker": "X", "ms": 7, "ls": "", "color": VERMILION}, "made waypoints"),
        ):
            x, y = view(points).T
            axes.plot(x, -y, label=label, **style)
        for index, (x, y) in enumerate(view(tool)):
            axes.annotate(str(index + 1), (x, -y), (5, 5), textcoords="offset points", color=VERMILION)
        axes.axhline(0.0, color=GREY, lw=0.5)
        axes.set_aspect("equal")
        axes.set_title(view.name, loc="left", fontsize=9)
        axes.set_xlabel("to the right [m]")
    panels[0].set_ylabel("up [m]")
    handles, labels = panels[0].get_legend_handles_labels()
    handles[0] = Line2D(
        [], [], color=SKY, marker=".", ms=8, ls=""
    )  # one point alone is too small to see
    figure.legend(handles, labels, loc="outside upper left", ncols=3, fontsize=8, frameon=False)
    return figure


def show_arm(data: dict[str, Any]) -> Shown:
    """Show the picture; the paper prints no pose to compare with."""
    printed, resolved = (1e3 * d for d in data["d1"])
    ranges = ", ".join(
        f"{axis} {low:.2f} to {high:.2f} m"
        for axis, low, high in zip("xyz", data["low"], data["high"], strict=True)
    )
    return Shown(
        [arm_figure(data)],
        [
            f"Monte Carlo workspace of {data['count']} points: {ranges}. Its farthest point is "
            f"{data['reach']:.3f} m from the shoulder; the links end to end are {data['most']:.3f} m long. The "
            "paper prints no such numbers and no pose.",
            f"The other reading, d1 = {printed:.1f} mm as printed, lifts everything by "
            f"{printed - resolved:.1f} mm. It changes no joint angle and no time.",
        ],
        (),
    )


FIGURE_4 = Item(
    "Fig 4",
    "model of the arm",
    make_arm,
    show_arm,
    "Table 1 with d1 = 103.5 mm instead of the printed 130.5: the digits are probably swapped, by the arm's "
    "public description. The joint limits, which the workspace needs and the paper does not print, are from "
    "there, too.",
)
