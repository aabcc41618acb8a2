"""Table 8 of Wang 2025 run again (``timebound table8``), with the bound that nobody can beat.

The protocol of its section 4.2.2: joint 1 of the SR4C alone, a candidate that breaks a limit is out,
50 particles, 50 iterations, 10 repetitions, which is few: 1,000 are run as well. Table 6 limits the
acceleration of joint 1 to 110 deg/s^2; but every time vector that tables 9 and 10 print for joint 1
peaks at 60 deg/s^2 (59.98 to 60.00), so that is what was in force. Both are run. The evaluations of 50
iterations and of the first population are the budget; mutants count.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.benchmark.grade import Run, grade
from compare.report.style import BLACK, BLUE, GREY, ORANGE, VERMILION, styled
from compare.screen import table
from formulations import FAMILIES, Problem, family_optimum, load
from formulations.problem.arrays import Array
from formulations.proofs.family import family_bound

PRINTED = {  # 000, table 8 [s]
    "PSO": [3.5079, 3.5419, 3.5916, 3.6221, 3.5801, 3.5746, 3.5962, 3.5823, 3.5383, 3.5049],
    "IPSO": [3.4688, 3.3529, 3.4316, 3.3752, 3.4127, 3.3795, 3.3788, 3.3991, 3.3896, 3.4215],
    "MIPSO": [3.2837, 3.2886, 3.2824, 3.2793, 3.2812, 3.2788, 3.2886, 3.2695, 3.2632, 3.2735],
}
# limits of joint 1 on speed [deg/s] and acceleration [deg/s^2]
LIMITS = {"as printed in table 6": (90.0, 110.0), "as tables 9 and 10 imply": (90.0, 60.0)}
VECTORS = {  # what tables 9 and 10 print for joint 1 [s]
    "table 9": [0.8660, 0.6812, 1.7331],
    "table 10, 35 deg/s": [0.8662, 0.9329, 2.6606],
    "table 10, 45 deg/s": [0.8660, 0.7869, 2.0901],
    "table 10, 55 deg/s": [0.8660, 0.6937, 1.7333],
}
SWARMS = ["pso-1995", "pso-linear", "pso", "mipso", "mipso-printed"]
POPULATION, ITERATIONS, FEW = 50, 50, 10


@dataclass(frozen=True)
class Row:
    """One run: verified time of joint 1 [s], None if nothing feasible was found."""

    limit: str
    swarm: str
    seed: int
    seconds: float | None
    status: str


def joint_1(limit: str) -> Problem:
    """Joint 1 of sr4c alone under one of LIMITS."""
    alone = load("sr4c").joint(0)
    speed, acceleration = np.radians([[value] for value in LIMITS[limit]])
    return replace(alone, limits=replace(alone.limits, velocity=speed, acceleration=acceleration))


def accelerations() -> dict[str, float]:
    """Peak acceleration of joint 1 that each printed time vector implies [deg/s^2]."""
    problem = load("sr4c").joint(0)
    family = FAMILIES[problem.family]
    return {
        name: float(np.degrees(family.peaks(problem, np.array([times]))[0, 0, 1]))
        for name, times in VECTORS.items()
    }


def repeat(limit: str, swarm: str, seeds: range) -> list[Row]:
    """Runs of one swarm under one limit."""
    problem = joint_1(limit)
    rows = []
    for seed in seeds:
        run = Run(f"sr4c joint 1 {limit}", "shared", swarm, seed,
                  POPULATION * (ITERATIONS + 1), POPULATION)  # fmt: skip
        row = grade(run, problem, None, "none").row
        rows.append(Row(limit, swarm, seed, row.seconds, row.status))
    return rows


def bounds(limit: str) -> tuple[float, float]:
    """Certified lower bound and optimum of joint 1 alone [s]."""
    problem = joint_1(limit)
    optimum = family_optimum(problem).seconds
    return family_bound(problem).seconds, optimum


def summarise(rows: list[Row]) -> dict[str, Any]:
    """By limit: bound, optimum, and by swarm all that table 8 shows, of few and of all runs."""
    found: dict[str, Any] = {}
    for limit in LIMITS:
        lower, optimum = bounds(limit)
        swarms = {}
        for swarm in SWARMS:
            times = np.array(
                [r.seconds for r in rows if (r.limit, r.swarm) == (limit, swarm)], dtype=float
            )
            swarms[swarm] = {"few": _few(times[:FEW]), "all": _few(times)}
        printed = {name: _few(np.array(times)) for name, times in PRINTED.items()}
        below = {name: int(sum(t < lower for t in times)) for name, times in PRINTED.items()}
        found[limit] = {
            "speed": LIMITS[limit][0], "acceleration": LIMITS[limit][1],
            "bound": lower, "optimum": optimum,
            "swarms": swarms, "printed": printed, "printed_below_bound": below,
        }  # fmt: skip
    return found


def _few(times: Array) -> dict[str, float | int | list[float]]:
    """Count, mean with its 95 % interval, standard deviation, best and worst; unsolved apart."""
    solved = times[np.isfinite(times)]
    error = 1.96 * solved.std(ddof=1) / np.sqrt(len(solved)) if len(solved) > 1 else np.nan
    mean = float(solved.mean())
    return {
        "runs": len(times),
        "unsolved": len(times) - len(solved),
        "mean": mean,
        "interval": [mean - float(error), mean + float(error)],
        "deviation": float(solved.std(ddof=1)),
        "best": float(solved.min()),
        "worst": float(solved.max()),
    }


@styled
def table8_figure(rows: list[Row], summary: dict[str, Any]) -> Figure:
    """A panel per limit: printed runs, our runs, the bound."""
    figure, panels = plt.subplots(1, len(LIMITS), figsize=(10.5, 3.9), sharey=True)
    names = [*(f"{name}, printed" for name in PRINTED), *SWARMS]
    for axes, (limit, facts) in zip(panels, summary.items(), strict=True):
        groups = [np.array(times) for times in PRINTED.values()]
        groups += [
            np.array([r.seconds for r in rows if (r.limit, r.swarm) == (limit, swarm)], dtype=float)
            for swarm in SWARMS
        ]
        rng = np.random.default_rng(0)  # spreads the marks, nothing else
        for y, (name, times) in enumerate(zip(names, groups, strict=True)):
            printed = name.endswith("printed") and y < len(PRINTED)
            colour = VERMILION if printed else BLUE
            spread = y + rng.uniform(-0.28, 0.28, len(times)) * (len(times) > FEW)
            axes.plot(times, spread, ".", color=colour, ms=6 if printed else 2.5,
                      alpha=0.9 if printed else 0.25)  # fmt: skip
            axes.plot(np.nanmean(times), y, "|", color=BLACK, ms=13, mew=1.6)
        axes.axvspan(0.0, facts["bound"], color=GREY, alpha=0.18, lw=0)
        axes.axvline(facts["bound"], color=ORANGE, lw=1.2)
        axes.annotate(f"certified: none below {facts['bound']:.4f} s", (facts["bound"], -0.62),
                      color=ORANGE, fontsize=8, ha="left")  # fmt: skip
        everything = np.concatenate([g[np.isfinite(g)] for g in groups])
        least = min(facts["bound"], float(everything.min()))
        most = max(float(np.quantile(everything, 0.998)), *map(max, PRINTED.values()))
        axes.set_xlim(least - 0.06, most + 0.03)
        axes.set_yticks(range(len(names)), names)
        axes.set_ylim(len(names) - 0.4, -0.95)
        axes.set_xlabel("time of joint 1 alone [s]; every run a mark, | the mean")
        axes.set_title(f"{facts['acceleration']:.0f} deg/s², {limit}", loc="left")
    return figure


def as_text(summary: dict[str, Any]) -> str:
    """The table of each limit."""
    parts = []
    for limit, facts in summary.items():
        lines = []
        for name, entry in facts["printed"].items():
            lines.append([f"{name}, printed", *_cells(entry), str(facts["printed_below_bound"][name])])
        for swarm, entry in facts["swarms"].items():
            lines += [[swarm, *_cells(entry[which]), ""] for which in ("few", "all")]
        header = [
            "swarm",
            "runs",
            "mean [s]",
            "95 % interval",
            "deviation",
            "best",
            "worst",
            "below bound",
        ]
        parts.append(
            f"joint 1, {facts['speed']:.0f} deg/s, {facts['acceleration']:.0f} deg/s^2, {limit}:"
            f" certified bound {facts['bound']:.6f} s, optimum {facts['optimum']:.6f} s\n"
            + table(header, lines, right=range(1, len(header)))
        )
    peaks = ", ".join(f"{value:.2f} ({name})" for name, value in accelerations().items())
    parts.append(f"peak acceleration of joint 1 in the printed time vectors [deg/s^2]: {peaks}")
    return "\n\n".join(parts)


def _cells(entry: dict[str, Any]) -> list[str]:
    low, high = entry["interval"]
    runs = f"{entry['runs']}" + (f" ({entry['unsolved']} unsolved)" if entry["unsolved"] else "")
    return [runs, f"{entry['mean']:.4f}", f"{low:.4f} to {high:.4f}", f"{entry['deviation']:.4f}",
            f"{entry['best']:.4f}", f"{entry['worst']:.4f}"]  # fmt: skip
