"""The pictures of the report, drawn from the store alone. Okabe-Ito colours, units on every axis."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from compare.benchmark.grade import Trace, durations_of
from compare.benchmark.statistics import best_claim, best_row, bound_of, convergence
from compare.benchmark.store import Store, key_of
from compare.commands import shared as commands
from compare.report.motion_picture import fastest_spline
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, STYLE, VERMILION, styled
from compare.studies.time_split import split, split_figure
from formulations import FAMILIES, Problem, Trajectory, check
from formulations.problem.arrays import Array
from metaheuristics import ALGORITHMS, GROUPS

CODING_STYLE: dict[Any, Any] = {
    "published": (VERMILION, "s"),
    "shared": (SKY, "o"),
    "stretched": (BLUE, "D"),
}
SWARM_STYLE = [  # within one group of swarms
    (BLUE, "-"), (VERMILION, "-"), (GREEN, "-"), (BLACK, "-"), (ORANGE, "-"),
    (PURPLE, "-"), (SKY, "-"), (BLUE, "--"), (VERMILION, "--"), (BLACK, "--"),
]  # fmt: skip
KIND_STYLE: dict[Any, Any] = {"lower": (BLUE, ">"), "upper": (GREEN, "o"), "reference": (PURPLE, "D")}
SMALLEST = 1e-12  # gaps below are drawn here: rounding

RUNG_NAMES = {
    "displacement": "displacement bound",
    "ruckig_end_to_end": "Ruckig, end to end",
    "free_form_lower": "best bound on any motion",
    "free_form": "fastest motion known",
    "ruckig_stop_and_go": "Ruckig, stop and go",
    "family_lower": "certified bound of the family",
    "family": "optimum of the family",
    "family_longest_segment": "each joint alone, longest time per segment, stretched",
    "toppra_family_path": "TOPP-RA, path of the optimum (no jerk limit)",
    "toppra_cubic": "TOPP-RA, clamped cubic (no jerk limit)",
    "copp_family_path": "COPP, path of the optimum",
}


def draw_case(folder: str, case: str, problem: Problem) -> list[str]:
    """Draw every figure of one case into ``folder``/figures as SVG and PNG, the arm as SVG; their names."""
    store = Store(Path(folder))
    rows = [row for row in store.rows() if row["case"] == case]
    ladder = store.ladders()[case]
    draw: dict[str, Callable[[], Figure]] = {
        "ladder": lambda: ladder_figure(problem, ladder, rows),
        "gaps": lambda: gap_figure(problem, rows),
        "convergence": lambda: convergence_figure(problem, ladder, rows, store.traces()),
        "motion": lambda: motion_figure(problem, ladder, rows),
        "split": lambda: where_the_time_goes(problem, ladder, rows),
    }
    mpl.use("Agg")  # a worker has no screen
    target = Path(folder) / "figures"
    target.mkdir(exist_ok=True)
    names = []
    for name, make in draw.items():
        figure = make()
        with mpl.rc_context(STYLE):
            figure.draw_without_rendering()
            figure.set_layout_engine("none")  # laid out once for both files
            figure.savefig(target / f"{case}-{name}.svg", metadata={"Date": None})
            figure.savefig(target / f"{case}-{name}.png")
        plt.close(figure)
        names.append(f"{case}-{name}")
    durations = ladder["durations"].get("family")
    arm = None if durations is None else fastest_spline(case, problem, np.array(durations))
    if arm is not None:
        commands.write_text(target / f"{case}-arm.svg", arm)
        names.append(f"{case}-arm")
    else:  # that of an earlier run is not this one's
        (target / f"{case}-arm.svg").unlink(missing_ok=True)
    return names


def where_the_time_goes(problem: Problem, ladder: dict[str, Any], rows: list[dict[str, Any]]) -> Figure:
    """The median motion of one swarm in each coding, from the certified bound up."""
    swarm = rows[0]["swarm"] if all(row["swarm"] != "pso" for row in rows) else "pso"
    splits = {}
    for coding in CODING_STYLE:
        mine = [r["seconds"] for r in rows if r["swarm"] == swarm and r["coding"] == coding]
        verified = sorted(seconds for seconds in mine if seconds is not None)
        if verified and ladder["ladder"]["free_form"]["seconds"]:
            median = verified[(len(verified) - 1) // 2]
            splits[coding] = split(problem, ladder["ladder"], median, coding)
    return split_figure(f"{problem.name}: where the time of {swarm} goes (median seed)", splits)


@styled
def ladder_figure(problem: Problem, ladder: dict[str, Any], rows: list[dict[str, Any]]) -> Figure:
    """Every bound and the best swarm results on one time axis."""
    entries = [
        (RUNG_NAMES[key], rung["seconds"], *KIND_STYLE[rung["kind"]])
        for key, rung in ladder["ladder"].items()
        if rung["seconds"] is not None and key not in ("free_form_lower", "family_lower")
    ]
    claim = best_claim(rows)
    if claim is not None:
        name = f"best claim in the papers' coding ({claim['swarm']})"
        if claim["keeps_limits"]:
            entries.append((name, claim["claimed"], ORANGE, "o"))
        else:
            entries.append((f"{name}: BREAKS LIMITS", claim["claimed"], VERMILION, "X"))
            name = f"that claim, slowed by {claim['stretch']:.4f} until it keeps them"
            entries.append((name, claim["seconds"], ORANGE, "o"))
    stretched = best_row(rows, coding="stretched")
    if stretched is not None:
        entries.append(
            (
                f"best swarm, stretched coding ({stretched['swarm']})",
                stretched["seconds"],
                ORANGE,
                "o",
            )
        )
    entries.sort(key=lambda entry: entry[1])
    optimum, proof = bound_of(ladder)
    figure, axes = plt.subplots(figsize=(9.0, 0.8 + 0.3 * len(entries)))
    barrier = ladder["ladder"]["free_form_lower"]["seconds"] or 0.0
    axes.axvspan(0.0, barrier, color=BLUE, alpha=0.10, lw=0)
    axes.text(barrier / 2, -0.75, "no motion can be here", ha="center", color=BLUE, fontsize=8)
    if optimum is not None:
        axes.axvline(optimum, color=GREEN, lw=0.8, ls="--")
        words = "nothing in the family" if proof == "certified" else "best known of the family"
        axes.text(optimum, -0.75, f"{words} ", ha="right", color=GREEN, fontsize=8)
    for y, (name, seconds, colour, marker) in enumerate(entries):
        axes.plot([0.0, seconds], [y, y], color=colour, lw=1.0, alpha=0.35)
        axes.plot(seconds, y, marker, color=colour, ms=7)
        relative = ""
        if optimum and name != RUNG_NAMES["family"]:
            gap = seconds / optimum - 1.0
            relative = "  (the optimum)" if abs(gap) < 5e-7 else f"  ({gap:+.2%})"
        axes.text(seconds, y, f"   {seconds:.4f} s{relative}", va="center", fontsize=8)
    axes.set_yticks(range(len(entries)), [entry[0] for entry in entries])
    axes.set_ylim(len(entries) - 0.4, -1.1)
    axes.set_xlim(0.0, max(entry[1] for entry in entries) * 1.28)
    axes.set_xlabel("total time [s]; in brackets: against the optimum of the family")
    axes.set_title(f"{problem.name}: {problem.title}, family {problem.family}", loc="left")
    return figure


@styled
def gap_figure(problem: Problem, rows: list[dict[str, Any]]) -> Figure:
    """Gap of every seed of every swarm in every coding; hollow: the claimed motion breaks limits."""
    swarms = list(dict.fromkeys(row["swarm"] for row in rows))
    codings = list(dict.fromkeys(row["coding"] for row in rows))
    figure, axes = plt.subplots(figsize=(9.0, 1.2 + 0.34 * len(swarms)))
    for row_index, swarm in enumerate(swarms):
        if row_index % 2:
            axes.axhspan(row_index - 0.5, row_index + 0.5, color="#000000", alpha=0.035, lw=0)
        for lane, coding in enumerate(codings):
            colour, marker = CODING_STYLE[coding]
            y = row_index + (lane - (len(codings) - 1) / 2) * 0.25
            group = [r for r in rows if r["swarm"] == swarm and r["coding"] == coding]
            gaps = [r["gap"] for r in group if r["gap"] is not None]
            for kept, face in ((True, colour), (False, "white")):
                marks = [r for r in group if r["gap"] is not None and r["keeps_limits"] == kept]
                x = [max(r["gap"], SMALLEST) for r in marks]
                axes.plot(x, [y] * len(x), marker, ls="", ms=4, mec=colour, mfc=face,
                          alpha=0.75, mew=0.9)  # fmt: skip
            if gaps:
                axes.plot(max(float(np.median(gaps)), SMALLEST), y, "|", color=BLACK, ms=9, mew=1.6)
            if len(gaps) < len(group):
                text = f"{len(group) - len(gaps)} of {len(group)} without a feasible motion"
                axes.text(0.995, y, text, color=colour, fontsize=7, va="center", ha="right",
                          transform=axes.get_yaxis_transform())  # fmt: skip
    for coding in codings:
        colour, marker = CODING_STYLE[coding]
        axes.plot([], [], marker, color=colour, ls="", label=coding)
    axes.plot([], [], "o", mec=GREY, mfc="white", ls="", label="as claimed breaks limits")
    axes.plot([], [], "|", color=BLACK, ls="", ms=9, mew=1.6, label="median")
    axes.set_xscale("log")
    axes.set_xlim(SMALLEST * 0.5, max([10.0, *[(r["gap"] or 0.0) * 2 for r in rows]]))
    axes.set_ylim(len(swarms) - 0.5, -0.5)
    axes.set_yticks(range(len(swarms)), swarms)
    ticks = [1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1.0]
    axes.set_xticks(ticks, ["rounding", *(f"{100 * t:.4g} %" for t in ticks[1:])])
    axes.set_xlabel("gap of the verified motion to the family's optimum [%], every seed a mark")
    axes.set_title(f"{problem.name}: how far each swarm is from the best in its family", loc="left")
    axes.legend(
        ncols=5,
        fontsize=7.5,
        loc="upper center",
        bbox_to_anchor=(0.5, -0.5 / (1.0 + 0.34 * len(swarms))),
        frameon=False,
    )
    return figure


@styled
def convergence_figure(
    problem: Problem,
    ladder: dict[str, Any],
    rows: list[dict[str, Any]],
    traces: dict[tuple[Any, ...], list[Trace]],
) -> Figure:
    """Median gap of each swarm against evaluations: a row per group of swarms, a column per coding."""
    swarms = list(dict.fromkeys(row["swarm"] for row in rows))
    codings = list(dict.fromkeys(row["coding"] for row in rows))
    groups: dict[str, list[str]] = {}
    for swarm in swarms:
        group = ALGORITHMS[swarm].group if swarm in ALGORITHMS else "rivals"
        groups.setdefault(group, []).append(swarm)
    optima = {-1: ladder["ladder"]["family"]["seconds"]}
    optima |= {j: s for j, s in enumerate(ladder["alone"]) if s is not None}
    figure, grid = plt.subplots(
        len(groups), len(codings), figsize=(10.5, 0.9 + 2.1 * len(groups)),
        sharex="col", sharey=True, squeeze=False, layout="none",
    )  # fmt: skip
    curves = {}
    for coding in codings:
        for swarm in swarms:
            mine = [r for r in rows if r["swarm"] == swarm and r["coding"] == coding]
            found = [traces[key_of(r)] for r in mine if key_of(r) in traces]
            if found and optima[-1] is not None:
                curves[coding, swarm] = convergence(found, optima, mine[0]["budget"])
    for panels, (group, members) in zip(grid, groups.items(), strict=True):
        for axes, coding in zip(panels, codings, strict=True):
            others = []
            for (where, swarm), (at, quartiles) in curves.items():
                if where != coding:
                    continue
                if swarm in members:
                    style = SWARM_STYLE[members.index(swarm) % len(SWARM_STYLE)]
                    _converging(axes, at, quartiles, style, swarm)
                else:
                    shown = np.isfinite(quartiles[1])
                    others.append(np.column_stack([at, np.maximum(quartiles[1], SMALLEST)])[shown])
            axes.add_collection(LineCollection(others, colors=GREY, lw=0.5, alpha=0.35))
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.minorticks_off()  # as many as all the rest of the picture
            axes.grid(alpha=0.25, lw=0.5)
        panels[0].set_ylabel(f"{GROUPS[group]}\ngap of the best so far [1]", fontsize=8)
        handles, labels = panels[-1].get_legend_handles_labels()
        panels[-1].legend(handles, labels, loc="center left", bbox_to_anchor=(1.0, 0.5),
                          frameon=False, fontsize=7.5)  # fmt: skip
    for column, coding in enumerate(codings):
        grid[0][column].set_title(coding, loc="left")
        per = " of each joint" if coding == "published" else ""
        grid[-1][column].set_xlabel(f"evaluations{per}")
    high = figure.get_figheight()  # room for words; a computed layout of so many panels takes seconds
    figure.subplots_adjust(left=0.085, right=0.84, bottom=0.5 / high, top=1 - 0.55 / high,
                           wspace=0.06, hspace=0.08)  # fmt: skip
    figure.suptitle(
        f"{problem.name}: median over seeds, band: quartiles; grey: all other swarms. published: mean"
        " over the joints, each against its own optimum",
        fontsize=9,
    )
    return figure


def _converging(axes: Axes, grid: Array, quartiles: Array, style: tuple[str, str], label: str) -> None:
    """One swarm's median and its band."""
    low, middle, high = quartiles
    colour, line = style
    shown = np.isfinite(middle)
    axes.plot(grid[shown], np.maximum(middle[shown], SMALLEST), line,
              color=colour, lw=1.4, label=label)  # fmt: skip
    band = shown & np.isfinite(high)
    axes.fill_between(grid[band], np.maximum(low[band], SMALLEST), np.maximum(high[band], SMALLEST),
                      color=colour, alpha=0.08, lw=0)  # fmt: skip


_QUANTITIES = (("position", ""), ("velocity", "/s"), ("acceleration", "/s²"), ("jerk", "/s³"))


@styled
def motion_figure(problem: Problem, ladder: dict[str, Any], rows: list[dict[str, Any]]) -> Figure:
    """Position to jerk of the best motion with the limits drawn in; and of the papers' coding, as
    claimed, red where it breaks them.
    """
    family = FAMILIES[problem.family]
    best = best_row(rows)
    optimum = np.array(ladder["durations"]["family"])
    title, motion = "optimum of the family (NLP)", family.trajectory(problem, optimum)
    if best is not None:
        title = f"best swarm: {best['swarm']}, {best['coding']}, {best['seconds']:.4f} s"
        motion = family.trajectory(problem, durations_of(best))
    claim = best_claim(rows)
    claimed: Trajectory | None = None
    if claim is not None:
        # the row keeps the durations of the verified motion; the claim is faster by one factor
        scale = claim["claimed"] / claim["seconds"]
        claimed = family.trajectory(problem, durations_of(claim) * scale)

    unit = 180.0 / np.pi if problem.display_unit == "deg" else 1.0
    joints = problem.moving_joints
    figure, grid = plt.subplots(
        4, len(joints), figsize=(1.2 + 2.0 * len(joints), 7.2), sharex=True, squeeze=False
    )
    for column, j in enumerate(joints):
        for order, (name, per) in enumerate(_QUANTITIES):
            axes = grid[order][column]
            _curves(axes, problem, motion, claimed, j, order, unit)
            if column == 0:
                axes.set_ylabel(f"{name}\n[{problem.display_unit}{per}]")
            axes.tick_params(labelsize=7)
        grid[0][column].set_title(f"joint {j + 1}", fontsize=9)
        grid[3][column].set_xlabel("time [s]")
    handles = [
        Line2D([], [], color=BLUE, lw=1.4),
        Line2D([], [], color=BLACK, lw=0.8, ls="--"),
    ]
    labels = [title, "limit"]
    if claimed is not None and claim is not None:
        verdict = check(problem, claimed)
        ends = "keeps the limits" if verdict.feasible else f"breaks limits: {verdict.worst}"
        handles.append(Line2D([], [], color=VERMILION, lw=1.0))
        labels.append(
            f"papers' coding ({claim['swarm']}), as claimed, {claim['claimed']:.4f} s: {ends}"
        )
    figure.legend(handles, labels, loc="outside upper left", fontsize=8, frameon=False)
    return figure


def _curves(
    axes: Axes,
    problem: Problem,
    motion: Trajectory,
    claimed: Trajectory | None,
    joint: int,
    order: int,
    unit: float,
) -> None:
    """One joint, one quantity."""
    t, x = samples(motion, joint, order)
    low, high = (
        problem.position_bounds[joint]
        if order == 0
        else np.array([-1.0, 1.0]) * problem.limits.derivatives[order - 1, joint]
    )
    extent = np.abs(x).max()
    if claimed is not None:
        tc, xc = samples(claimed, joint, order)
        axes.plot(tc, xc * unit, color=VERMILION, lw=0.9, alpha=0.8)
        over = np.where((xc > high * (1 + 1e-6)) | (xc < low * (1 + 1e-6)), xc, np.nan)
        axes.plot(tc, over * unit, color=VERMILION, lw=3.0)
        extent = max(extent, np.abs(xc).max())
    axes.plot(t, x * unit, color=BLUE, lw=1.4)
    for limit in (low, high):
        # a position limit far away would flatten the curve
        if np.isfinite(limit) and (order > 0 or abs(limit) < 2.0 * extent):
            axes.axhline(limit * unit, color=BLACK, lw=0.8, ls="--")
    if order == 0:
        axes.plot(motion.passage_times, problem.waypoints[:, joint] * unit, "o", color=BLUE, ms=3)
    for passage in motion.passage_times[1:-1]:
        axes.axvline(passage, color=GREY, lw=0.4, alpha=0.6)


def samples(motion: Trajectory, joint: int, order: int) -> tuple[Array, Array]:
    """Curve points for drawing; pieces are kept apart, so that jumps of the jerk are upright."""
    s = np.linspace(1e-9, 1.0 - 1e-9, 60)
    t = (motion.breaks[:-1, None] + motion.durations[:, None] * s).ravel()
    return t, motion.at(t, order)[:, joint]
