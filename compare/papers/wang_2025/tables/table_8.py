"""Wang 2025, Table 8: joint 1 of the SR4C alone, by several swarms, with the bound that nobody can beat.

``timebound table8`` runs it again: 50 particles, 50 iterations, and many more than the paper's 10
repetitions. The protocol and the two readings of the limits stand in ``joint_1``.
"""

from __future__ import annotations

from dataclasses import astuple
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from scipy import stats

from compare.audit.motion.minima import impossible
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.verdicts import AT_A_LIMIT, Reproduction, agrees, held
from compare.papers.wang_2025.joint_1 import (
    FEW,
    IN_FORCE,
    LIMITS,
    PRINTED,
    RIVALS,
    SWARMS,
    TABLE_6,
    JointOneRun,
    accelerations,
    cells,
    joint_1,
    repeat,
    summarise,
)
from compare.papers.wang_2025.paper import ALONE, SWARM, paper
from compare.papers.wang_2025.tables.table_8_boxes import (
    box_remarks,
    box_table,
    box_verdicts,
    gain_over_pso,
    make_boxes,
)
from compare.papers.words import above, listed, seconds
from compare.report.style import BLACK, BLUE, GREY, ORANGE, VERMILION, styled
from compare.screen import table

RUNS = {False: 60, True: 1000}
ALPHA = 0.05  # significance of a difference in scatter


@styled
def table8_figure(rows: list[JointOneRun], summary: dict[str, Any]) -> Figure:
    """Draw a panel per reading of the limits: printed runs, reproduced runs, the bound.

    Parameters
    ----------
    rows : list of JointOneRun
        Every run.
    summary : dict
        Of ``joint_1.summarise``.

    Returns
    -------
    Figure
    """
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
            if np.isfinite(times).any():
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
    """Write the statistics of each reading as a table for the terminal.

    Parameters
    ----------
    summary : dict
        Of ``joint_1.summarise``.

    Returns
    -------
    str
    """
    parts = []
    for limit, facts in summary.items():
        lines = []
        for name, entry in facts["printed"].items():
            lines.append([f"{name}, printed", *cells(entry), str(facts["printed_below_bound"][name])])
        for swarm, entry in facts["swarms"].items():
            lines += [[swarm, *cells(entry[which]), ""] for which in ("few", "all")]
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
    peaks = ", ".join(f"{value:.2f} ({table})" for table, value in accelerations().items())
    parts.append(f"peak acceleration of joint 1 in the printed time vectors [deg/s^2]: {peaks}")
    return "\n\n".join(parts)


def make_table_8(full: bool) -> dict[str, Any]:
    """Run every swarm under both readings of the limits, and prove the bounds."""
    runs = range(RUNS[full])
    rows = [r for limit in LIMITS for swarm in SWARMS
            for r in repeat(limit, swarm, runs)]  # fmt: skip
    force, halves = joint_1(IN_FORCE), paper().halves_of(0)
    proved = {
        name: sum(impossible(force, halves, t.value.high) for t in paper().totals if t.by == name)
        for name in PRINTED
    }
    return {
        "runs": len(runs),
        "impossible": proved,
        "rows": [list(astuple(row)) for row in rows],
        "summary": summarise(rows),
        "boxes": make_boxes(range((len(runs) + 1) // 2)),
        "scatter": {limit: _same_scatter(rows, limit) for limit in LIMITS},
        "accelerations": accelerations(),
    }


def show_table_8(data: dict[str, Any]) -> Shown:
    """Show the ten runs as the paper has them, the statistics of all runs, and the picture."""
    rows = [JointOneRun(*row) for row in data["rows"]]
    found, few = data["summary"], min(FEW, data["runs"])
    ours = [(limit, swarm) for limit in (IN_FORCE, TABLE_6) for swarm in ("pso", SWARM)]
    times = {key: [r.seconds for r in rows if (r.limit, r.swarm) == key][:few] for key in ours}
    names = [f"{s.upper()}, {found[limit]['acceleration']:.0f} deg/s²" for limit, s in ours]
    header = ["run", *(f"{name}, printed" for name in PRINTED), *names]
    lines = [
        [str(i + 1), *(seconds(column[i]) for column in PRINTED.values()),
         *(seconds(times[key][i]) if i < few else "" for key in ours)]
        for i in range(FEW)
    ]  # fmt: skip
    printed_means = {name: float(np.mean(column)) for name, column in PRINTED.items()}
    means = [seconds(found[limit]["swarms"][swarm]["few"]["mean"]) for limit, swarm in ours]
    lines.append(["mean", *map(seconds, printed_means.values()), *means])
    first = Table(
        header, lines, f"Time of joint 1 alone [s]; reproduced: seeds 0 to {few - 1}.", range(1, 8)
    )

    header = ["swarm", "limit [deg/s²]", "runs", "mean [s]", "95 % interval", "deviation", "best", "worst",
              "certified bound"]  # fmt: skip
    lines = []
    for facts in (found[IN_FORCE], found[TABLE_6]):
        groups = {f"{name}, printed": entry for name, entry in facts["printed"].items()}
        groups |= {name: entry["all"] for name, entry in facts["swarms"].items()}
        for name, e in groups.items():
            runs, *described = cells(e)
            limit = f"{facts['acceleration']:.0f}"
            lines.append([name, limit, runs, *described, f"{facts['bound']:.6f}"])
    second = Table(header, lines, "Every run; the printed runs against either limit.", range(1, 9))
    remarks = [*_remarks_8(data, printed_means), *box_remarks(data, printed_means)]
    verdicts = [*_verdicts_8(data, printed_means), *box_verdicts(data, printed_means)]
    return Shown([first, second, box_table(data), table8_figure(rows, found)], remarks, verdicts)


def _verdicts_8(data: dict[str, Any], printed_means: dict[str, float]) -> list[ItemVerdict]:
    both = [
        (limit, f"{data['summary'][limit]['acceleration']:.0f} deg/s²") for limit in (IN_FORCE, TABLE_6)
    ]
    return [
        *(
            ItemVerdict(f"that all runs of {name} are possible, {both[0][1]}", held(not n))
            for name, n in data["impossible"].items()
        ),
        *(
            ItemVerdict(
                f"the gain of MIPSO over PSO, {words}",
                gain_over_pso(_means(data["summary"][limit]), printed_means),
            )
            for limit, words in both
        ),
        *(
            ItemVerdict(
                f"that MIPSO is more stable than PSO, {words}",
                _steadier(data["summary"][limit], data["scatter"][limit]),
            )
            for limit, words in both
        ),
    ]


def _means(facts: dict[str, Any]) -> dict[str, float | None]:
    """Mean of all runs of each swarm under one limit [s]."""
    return {swarm: entry["all"]["mean"] for swarm, entry in facts["swarms"].items()}


def _steadier(facts: dict[str, Any], p: float) -> Reproduction:
    """Judge whether MIPSO scatters less than PSO; not decided where a test shows no difference."""
    mine, other = (facts["swarms"][swarm]["all"]["deviation"] for swarm in (SWARM, "pso"))
    if mine is None or other is None or p >= ALPHA:
        return Reproduction.UNDECIDED
    return held(mine < other)


def _remarks_8(data: dict[str, Any], printed_means: dict[str, float]) -> list[str]:
    force, stated = data["summary"][IN_FORCE], data["summary"][TABLE_6]
    found = data["accelerations"].values()
    limit, implied = stated["acceleration"], force["acceleration"]
    at_implied = all(abs(peak / implied - 1.0) <= AT_A_LIMIT for peak in found)
    remarks = [
        f"Table 6 limits the acceleration of joint 1 to {limit:.0f} deg/s². The vectors of Tables 9 and 10 "
        f"peak between {min(found):.2f} and {max(found):.2f} deg/s²: "
        + (
            f"{implied:.0f} deg/s² was in force."
            if at_implied
            else f"they do not agree with one limit of {implied:.0f} deg/s²."
        )
        + f" The certified bound is {force['bound']:.6f} s under {implied:.0f} deg/s² and "
        f"{stated['bound']:.6f} s under Table 6. Against the latter the best printed run of MIPSO is "
        f"{above(min(PRINTED['MIPSO']), stated['bound'])}, and the worst of {data['runs']} reproduced runs "
        f"is {above(stated['swarms'][SWARM]['all']['worst'], stated['bound'])}.",
        _impossible(data["impossible"], implied),
    ]
    for facts in (force, stated):
        means = _means(facts)
        mine = means[SWARM]
        if mine is None or means["pso"] is None:
            remarks.append(
                f"Under {facts['acceleration']:.0f} deg/s² no run of MIPSO or of PSO is feasible."
            )
            continue
        remarks.append(
            f"The gain of MIPSO over PSO is {gain_over_pso(means, printed_means).inside} under "
            f"{facts['acceleration']:.0f} deg/s². Printed: "
            f"{printed_means['PSO'] - printed_means['MIPSO']:.4f} s. Mean of {data['runs']} reproduced runs: "
            + "; ".join(
                f"{mean - mine:+.4f} s over {name}"
                for swarm, name in RIVALS.items()
                if (mean := means[swarm]) is not None
            )
            + "."
        )
    remarks.append(_stability(data["summary"], data["scatter"]))
    return remarks


def _same_scatter(rows: list[JointOneRun], limit: str) -> float:
    """The p value that MIPSO and PSO scatter alike (Brown and Forsythe)."""
    groups = [
        [r.seconds for r in rows if (r.limit, r.swarm) == (limit, swarm) and r.seconds is not None]
        for swarm in (SWARM, "pso")
    ]
    p = stats.levene(*groups, center="median").pvalue if min(map(len, groups)) > 1 else np.nan
    return float(p) if np.isfinite(p) else 1.0


def _stability(summary: dict[str, Any], scatter: dict[str, float]) -> str:
    """Whether MIPSO scatters less than PSO, as the paper says."""
    printed = [summary[IN_FORCE]["printed"][name]["deviation"] for name in ("MIPSO", "PSO")]
    text = (
        f"Sec. 4.2.2 calls MIPSO the more stable one: its printed runs scatter by {printed[0]:.4f} s, those "
        f"of PSO by {printed[1]:.4f} s (standard deviation)."
    )
    for limit in (IN_FORCE, TABLE_6):
        facts, p = summary[limit], scatter[limit]
        mine, other = (facts["swarms"][swarm]["all"]["deviation"] for swarm in (SWARM, "pso"))
        if mine is not None and other is not None:
            outcome = _steadier(facts, p)
            told = (
                "which shows no difference"
                if outcome is Reproduction.UNDECIDED
                else agrees(outcome is Reproduction.REPRODUCED)
            )
            text += (
                f" Under {facts['acceleration']:.0f} deg/s² the reproduced runs scatter by {mine:.4f} s and "
                f"{other:.4f} s (Brown-Forsythe test, p = {p:.2g}), {told}."
            )
    return text


def _impossible(counts: dict[str, int], acceleration: float) -> str:
    """How many printed runs of each method are proved impossible."""
    wrong = [f"{n} of {name}" for name, n in counts.items() if n]
    if not wrong:
        return f"No printed run is proved impossible under {acceleration:.0f} deg/s²."
    return (
        f"Printed runs that are proved impossible under {acceleration:.0f} deg/s²: {listed(wrong)}. No spline "
        "through waypoints that print like these is as fast, whatever the rounding hides."
    )


TABLE_8 = Item(
    "Table 8",
    "ten runs of PSO, IPSO and MIPSO on joint 1",
    make_table_8,
    show_table_8,
    ALONE
    + "Two limits of acceleration are read: Table 6's, and the one that Tables 9 and 10 imply; and three "
    "search boxes.",
    cost=30.0,
)
