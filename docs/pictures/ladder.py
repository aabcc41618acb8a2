"""The picture of the README: ``python docs/pictures/ladder.py`` computes it and writes ``ladder.svg``."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

import formulations as f
from compare.audit import load_papers

CASE, FILE = "sr4c", Path(__file__).parents[1] / "static" / "ladder.svg"
GREEN, BLUE, GREY, RED, INK = "#00734f", "#0067a3", "#6b6b6b", "#b34700", "#1a1a1a"


def numbers() -> dict[str, float]:
    """Compute what the picture shows; every motion is judged by the check.

    Returns
    -------
    dict
        Times in s, and by which factor the claim of the papers' rule breaks its worst limit.
    """
    problem = f.load(CASE)
    family = f.FAMILIES[problem.family]
    best, proved = f.proved_optimum(problem)
    motion = f.free_form(problem)
    alone = [optimum.durations for optimum in f.each_joint_alone(problem)]
    rule = f.longest_segment(problem, alone)
    (paper,) = load_papers(CASE)
    (printed,) = [[float(t.text) for t in row.times] for row in paper.rows if row.of]
    claim, slowed, published = (
        f.check(problem, family.trajectory(problem, np.array(durations)))
        for durations in (rule.claimed, rule.durations, printed)
    )
    assert slowed.feasible
    assert not claim.feasible
    assert published.stretch < 1.0001  # within the rounding of its digits
    return {
        "no motion is faster": f.free_form_bound(problem).seconds,
        "fastest motion": motion.seconds,
        "no 3-5-3 spline is faster": proved.seconds,
        "fastest 3-5-3 spline": best.seconds,
        "published": published.seconds,
        "stop at each waypoint": f.REFERENCES["ruckig_stop_and_go"](problem).seconds,
        "rule": claim.seconds,
        "rule breaks a limit by": claim.worst.factor,
        "rule, slowed down": slowed.seconds,
    }


def draw(found: dict[str, float], path: Path) -> None:
    """Draw the ladder on a white card, which is readable on a dark page too.

    Parameters
    ----------
    found : dict
        As ``numbers`` returns it; it is written into the file as its description.
    path : Path
    """
    mpl.use("Agg")
    mpl.rcParams.update({"svg.hashsalt": "timebound", "font.size": 11, "text.color": INK})
    from matplotlib.figure import Figure
    from matplotlib.patches import FancyBboxPatch

    figure = Figure(figsize=(7.7, 4.5), facecolor="none")
    figure.add_artist(
        FancyBboxPatch(
            (0.01, 0.015), 0.98, 0.97, boxstyle="round,pad=0,rounding_size=0.02", fc="white", ec="#bbbbbb",
            transform=figure.transFigure, zorder=-1, mutation_aspect=7.7 / 4.5,
        )
    )  # fmt: skip
    axes = figure.add_axes((0.325, 0.14, 0.655, 0.63), facecolor="none")
    least, spline = found["no motion is faster"], found["no 3-5-3 spline is faster"]
    above = {key: f"{found[key] / spline - 1:+.1%}" for key in ("published", "stop at each waypoint")}
    shown = [
        ("fastest motion of all", "fastest motion", GREEN, ""),
        ("fastest 3-5-3 spline", "fastest 3-5-3 spline", GREEN, ""),
        ("published by the paper", "published", BLUE, above["published"]),
        ("full stop at each waypoint", "stop at each waypoint", GREY, above["stop at each waypoint"]),
    ]
    for row, (label, key, colour, more) in enumerate(shown):
        axes.barh(row, found[key], height=0.56, color=colour)
        axes.text(0.08, row, f"{found[key]:.3f} s", color="white", va="center", weight="bold")
        axes.text(found[key] + 0.06, row, more, va="center", color=colour)
        axes.text(-0.1, row, label, ha="right", va="center")
    last, claim = len(shown), found["rule"]
    axes.barh(last, claim, height=0.56, fc="#fbe9df", ec=RED, hatch="///", lw=1.2)
    words = f"claims {claim:.3f} s, breaks a limit × {found['rule breaks a limit by']:.2f}"
    card = {"fc": "white", "ec": "none", "pad": 2.0}
    axes.text(0.08, last, words, va="center", color=RED, weight="bold", bbox=card)
    axes.plot(2 * [found["rule, slowed down"]], [last - 0.28, last + 0.28], color=RED, lw=2.5)
    axes.text(
        found["rule, slowed down"] + 0.06, last, f"{found['rule, slowed down']:.3f} s\nif kept",
        va="center", color=RED,
    )  # fmt: skip
    axes.text(-0.1, last, "each joint alone, then\nlongest time per segment", ha="right", va="center")
    for place, text in ((least, "no motion\nis faster"), (spline, "no 3-5-3 spline\nis faster")):
        axes.axvline(place, color=INK, lw=1.2, ls=(0, (4, 2)))
        axes.text(place, -0.52, f"{text}: proved", ha="center", va="bottom", fontsize=10)
    axes.set(xlim=(0, 6.2), ylim=(last + 0.5, -0.45), yticks=[])
    axes.set_xlabel("time through the four waypoints [s]")
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    figure.text(0.03, 0.92, "Six joints, four waypoints: the arm of Wang 2025 (sr4c)", weight="bold")
    metadata = {"Date": None, "Title": "The ladder of sr4c", "Description": json.dumps(found)}
    figure.savefig(path, metadata=metadata)
    path.write_text(
        "\n".join(line.rstrip() for line in path.read_text("utf-8").splitlines()) + "\n", "utf-8"
    )


if __name__ == "__main__":
    draw(numbers(), Path(sys.argv[1]) if len(sys.argv) > 1 else FILE)
