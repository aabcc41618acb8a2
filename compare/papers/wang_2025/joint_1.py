"""Paper 000, joint 1 by several swarms: Table 8 and Fig. 10."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.audit.minima import impossible
from compare.benchmark.grade import Graded
from compare.benchmark.suite import Budget
from compare.papers.descent import descent, draw_descent
from compare.papers.item import Item, Shown, Table
from compare.papers.measure import listed, trials
from compare.papers.wang_2025 import table_8 as table8
from compare.papers.wang_2025.paper import IN_FORCE, SWARM, TABLE_6, above, budget, paper, seconds
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, styled

_HALF = 5e-5  # s, half a unit of Table 8's last digit


# --- Table 8 --------------------------------------------------------------------------------------


def make_table_8(full: bool) -> dict[str, Any]:
    """Runs of every swarm under both limits, and the certified bounds."""
    runs = range(1000 if full else 60)
    rows = [r for limit in table8.LIMITS for swarm in table8.SWARMS
            for r in table8.repeat(limit, swarm, runs)]  # fmt: skip
    force = table8.joint_1(IN_FORCE)
    halves = paper().halves_of(0)
    proved = {
        name: sum(impossible(force, halves, t + _HALF) for t in times)
        for name, times in table8.PRINTED.items()
    }
    return {
        "runs": len(runs),
        "impossible": proved,
        "rows": [list(astuple(row)) for row in rows],
        "summary": table8.summarise(rows),
        "accelerations": table8.accelerations(),
    }


def show_table_8(data: dict[str, Any]) -> Shown:
    """The ten runs as the paper has them, the statistics of all, the picture."""
    rows = [table8.Row(*row) for row in data["rows"]]
    found, few = data["summary"], table8.FEW
    ours = [(limit, swarm) for limit in (IN_FORCE, TABLE_6) for swarm in ("pso", SWARM)]
    times = {key: [r.seconds for r in rows if (r.limit, r.swarm) == key][:few] for key in ours}
    names = [f"{s.upper()}, {found[limit]['acceleration']:.0f} deg/s²" for limit, s in ours]
    header = ["run", *(f"{name}, printed" for name in table8.PRINTED), *names]
    lines = [
        [str(i + 1), *(seconds(column[i]) for column in table8.PRINTED.values()),
         *("none" if t is None else seconds(t) for t in (times[key][i] for key in ours))]
        for i in range(few)
    ]  # fmt: skip
    printed_means = {name: float(np.mean(column)) for name, column in table8.PRINTED.items()}
    means = [seconds(found[limit]["swarms"][swarm]["few"]["mean"]) for limit, swarm in ours]
    lines.append(["mean", *map(seconds, printed_means.values()), *means])
    first = Table(header, lines, "Time of joint 1 alone [s]; reproduced: seeds 0 to 9.", range(1, 8))

    header = ["swarm", "limit [deg/s²]", "runs", "mean [s]", "95 % interval", "deviation", "best", "worst",
              "certified bound"]  # fmt: skip
    lines = []
    for facts in (found[IN_FORCE], found[TABLE_6]):
        groups = {f"{name}, printed": entry for name, entry in facts["printed"].items()}
        groups |= {name: entry["all"] for name, entry in facts["swarms"].items()}
        for name, e in groups.items():
            low, high = e["interval"]
            runs = str(e["runs"]) + (f", {e['unsolved']} unsolved" if e["unsolved"] else "")
            lines.append([name, f"{facts['acceleration']:.0f}", runs, seconds(e["mean"]),
                          f"{low:.4f} to {high:.4f}", seconds(e["deviation"]), seconds(e["best"]),
                          seconds(e["worst"]), f"{facts['bound']:.6f}"])  # fmt: skip
    second = Table(header, lines, "Every run; the printed runs against either limit.", range(1, 9))
    remarks = _remarks_8(data, printed_means)
    return Shown([first, second, table8.table8_figure(rows, found)], remarks)


def _remarks_8(data: dict[str, Any], printed_means: dict[str, float]) -> list[str]:
    force, stated = data["summary"][IN_FORCE], data["summary"][TABLE_6]
    peaks = data["accelerations"].values()
    gain = printed_means["PSO"] - printed_means["MIPSO"]
    remarks = [
        f"Table 6 limits the acceleration of joint 1 to {stated['acceleration']:.0f} deg/s², but the vectors "
        f"of Tables 9 and 10 peak between {min(peaks):.2f} and {max(peaks):.2f} deg/s²: "
        f"{force['acceleration']:.0f} was in force. The certified bound is {force['bound']:.6f} s there, "
        f"{stated['bound']:.6f} s under Table 6, where the best printed run is "
        f"{above(min(table8.PRINTED['MIPSO']), stated['bound'])} and the worst of {data['runs']} reproduced "
        f"MIPSO runs {above(stated['swarms'][SWARM]['all']['worst'], stated['bound'])}.",
        "Of the printed runs, "
        f"{listed([f'{n} of {name}' for name, n in data['impossible'].items()])} are proved impossible under "
        f"{force['acceleration']:.0f} deg/s²: no spline through waypoints that print like "
        "these is as fast, whatever the rounding hides.",
    ]
    for facts in (force, stated):
        e = facts["swarms"]
        remarks.append(
            f"Printed, MIPSO gains {gain:.4f} s over PSO. Reproduced under {facts['acceleration']:.0f} deg/s², "
            f"mean of {data['runs']}: {e['pso']['all']['mean'] - e[SWARM]['all']['mean']:+.4f} s over PSO with "
            f"the constants of constriction, {e['pso-1995']['all']['mean'] - e[SWARM]['all']['mean']:+.4f} s "
            f"over the form of 1995, {e['mipso-printed']['all']['mean'] - e[SWARM]['all']['mean']:+.4f} s over "
            "MIPSO with eq. 15 and 16 by their letter."
        )
    return remarks


# --- Fig. 10 --------------------------------------------------------------------------------------

_SWARMS: dict[str, tuple[str, tuple[Any, Any]]] = {
    "pso": ("PSO, constriction", (BLACK, "-")),
    "pso-1995": ("PSO, 1995", (GREY, "-")),
    "mipso": ("MIPSO", (BLUE, "-")),
    "mipso-pso1": ("PSO1, no tent map", (SKY, "--")),
    "mipso-pso2": ("PSO2, nothing dynamic", (ORANGE, "--")),
    "mipso-pso3": ("PSO3, no mutation", (GREEN, "--")),
    "mipso-printed": ("MIPSO by the letter", (PURPLE, "-.")),
}


def make_fig_10(full: bool) -> dict[str, Any]:
    """Quartiles of the best time found, by swarm, under the limit in force."""
    runs, more = 300 if full else 60, Budget(budget().population, round(1.2 * budget().iterations))
    problem, stated = table8.joint_1(IN_FORCE), table8.joint_1(TABLE_6)
    found = {swarm: trials(problem, swarm, budget(), runs) for swarm in _SWARMS}
    return {
        "runs": runs,
        "accelerations": [table8.LIMITS[name][1] for name in (IN_FORCE, TABLE_6)],
        "bound": table8.bounds(IN_FORCE)[0],
        "descents": {swarm: descent([g.traces[0] for g in group], *astuple(budget()))
                     for swarm, group in found.items()},
        "free_mutants": _end(trials(problem, SWARM, more, runs), more),
        "table_6": _end(trials(stated, SWARM, budget(), runs), budget()),
    }  # fmt: skip


def _end(found: Sequence[Graded], spent: Budget) -> float | None:
    """Median best time at the end [s]."""
    quartiles = descent([g.traces[0] for g in found], *astuple(spent))["quartiles"]
    return quartiles[1][-1]  # type: ignore[no-any-return]


def show_fig_10(data: dict[str, Any]) -> Shown:
    """The picture, the medians in a table."""
    at = data["descents"][SWARM]["iterations"]
    median = {swarm: d["quartiles"][1][-1] for swarm, d in data["descents"].items()}
    shown = [at.index(k) for k in (5.0, 10.0, 20.0, 30.0, 50.0)]
    header = ["swarm", *(f"iteration {at[i]:g}" for i in shown), "above the bound"]
    lines = []
    for swarm, (title, _) in _SWARMS.items():
        medians = data["descents"][swarm]["quartiles"][1]
        cells = ["none" if medians[i] is None else seconds(medians[i]) for i in shown]
        lines.append([title, *cells, above(median[swarm], data["bound"])])
    caption = f"Median best time of joint 1 [s] of {data['runs']} runs after so many iterations."
    force, stated = data["accelerations"]
    order = [_SWARMS[s][0] for s in sorted(median, key=lambda swarm: float(median[swarm]))]
    remarks = [
        f"Printed: MIPSO ends before IPSO, and IPSO before PSO. Reproduced, the medians end in the order "
        f"{'; '.join(order)}.",
        f"Were mutants free, at most 20 % more evaluations, MIPSO's median would end at "
        f"{data['free_mutants']:.4f} s in place of {median[SWARM]:.4f} s.",
        f"Under the {stated:.0f} deg/s² of Table 6 the same runs end at {data['table_6']:.4f} s: all times "
        f"divide by {median[SWARM] / data['table_6']:.4f}, as sqrt({stated:.0f}/{force:.0f}) = "
        f"{np.sqrt(stated / force):.4f} says where the acceleration alone holds; the printed means "
        f"({', '.join(f'{np.mean(c):.4f} s' for c in table8.PRINTED.values())}) cannot be meant.",
    ]
    table = Table(header, lines, caption, range(1, len(header)))
    return Shown([fig_10(data), table], remarks)


@styled
def fig_10(data: dict[str, Any]) -> Figure:
    """Median and quartiles against iterations: times with the printed means, and gaps."""
    figure, (times, gaps) = plt.subplots(1, 2, figsize=(10.4, 3.9))
    bound = data["bound"]
    for swarm, (title, style) in _SWARMS.items():
        found = data["descents"][swarm]
        draw_descent(times, found, title, style)
        middle = np.array(found["quartiles"][1], dtype=float)
        gaps.plot(
            found["iterations"], 100.0 * (middle / bound - 1.0), color=style[0], ls=style[1], lw=1.4
        )
    times.axhline(bound, color=BLACK, lw=0.9, ls=":")
    times.text(1, bound, "certified: none below", va="top", fontsize=7.5)
    times.set_ylim(bound - 0.1, bound + 1.2)
    for name, column in table8.PRINTED.items():
        mean = float(np.mean(column))
        times.annotate(f"{name}, printed", (1.0, mean), (1.03, mean), va="center", fontsize=7.5,
                       color=VERMILION, xycoords=("axes fraction", "data"),
                       arrowprops={"arrowstyle": "-", "color": VERMILION, "lw": 1.6})  # fmt: skip
    times.set_ylabel("best time of joint 1 [s]")
    times.set_title(f"{data['accelerations'][0]:.0f} deg/s²; band: quartiles", loc="left")
    gaps.set_yscale("log")
    gaps.set_yticks([0.1, 1.0, 10.0, 100.0], ["0.1", "1", "10", "100"])
    gaps.set_ylabel("above the certified bound [%]")
    gaps.set_title("the same medians", loc="left")
    for axes in (times, gaps):
        axes.set_xlabel("iteration [1]")
        axes.set_xlim(0, data["descents"][SWARM]["iterations"][-1])
    handles, labels = times.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=8)
    return figure


_ALONE = (
    "Joint 1 alone; a candidate that breaks a limit is out. The search box is not printed, nor are the "
    "constants of PSO; IPSO's equations are not in the paper, so it cannot be run. "
)


ITEMS = (
    Item(
        "Table 8",
        "ten runs of PSO, IPSO and MIPSO on joint 1",
        make_table_8,
        show_table_8,
        _ALONE
        + "Two limits of acceleration are read: Table 6's, and the one that Tables 9 and 10 imply.",
        cost=30.0,
    ),
    Item(
        "Fig 10",
        "fitness over the iterations",
        make_fig_10,
        show_fig_10,
        _ALONE
        + "Iterations are counted by evaluations, 50 each; mutants count. Band: quartiles. Added: "
        "MIPSO without one strategy at a time, and by the letter of eq. 15 and 16.",
        cost=15.0,
    ),
)
