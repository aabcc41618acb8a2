"""Paper 004 (moxibustion cobot, improved PSO): Fig. 6 (convergence) and Figs 7 to 9 (the joints)."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.audit.paper_file import load_papers
from compare.audit.printed import values
from compare.benchmark.suite import PAPER_BUDGETS
from compare.papers.curves import all_joints, verdict_told
from compare.papers.descent import descent, draw_descent
from compare.papers.item import Item, Shown, Table
from compare.papers.measure import judged, least, listed, percent, summary, trials
from compare.papers.panels import panels
from compare.papers.printed import tables
from compare.report.style import BLUE, GREEN, ORANGE, VERMILION, styled
from formulations import FAMILIES, load

RUNS = {False: 15, True: 100}
_BUDGET = PAPER_BUDGETS["cobot"]

# --- Fig. 6 ---------------------------------------------------------------------------------------

SWARMS = {
    "improved": ("improved PSO", "pso-zhang-2025", (BLUE, "-")),
    "PSO": ("standard PSO", "pso-linear", (VERMILION, "-")),
    "WOA": ("standard whales", "whale", (GREEN, "-")),
    "PSO, no inertia": ("PSO of eq. 1-2", "pso-1995", (ORANGE, "-")),
}


def make_descents(full: bool) -> dict[str, Any]:
    """Best time of each joint alone against iterations, by swarm."""
    problem = load("cobot")
    joints = []
    for j in range(problem.dof):
        alone = problem.joint(j)
        found = {}
        for key, (_, swarm, _) in SWARMS.items():
            runs = trials(alone, swarm, _BUDGET, RUNS[full])
            traces = [graded.traces[0] for graded in runs]
            found[key] = {
                "descent": descent(traces, _BUDGET.population, _BUDGET.iterations),
                **summary(runs),
            }
        joints.append({"found": found, "bound": least(alone)["bound"]})
    return {
        "joints": joints,
        "limit": float(np.rad2deg(problem.limits.velocity[0])),
        "crossing": np.rad2deg(np.abs(problem.displacements).sum(axis=0)).tolist(),
        "runs": RUNS[full],
    }


@styled
def descent_figure(data: dict[str, Any]) -> Figure:
    """A panel per joint: gap to the certified bound."""
    figure, grid = plt.subplots(2, 3, figsize=(10.5, 5.4), sharex=True, sharey=True)
    for j, (axes, joint) in enumerate(zip(grid.ravel(), data["joints"], strict=True)):
        for key, (name, _, style) in SWARMS.items():
            draw_descent(axes, joint["found"][key]["descent"], name, style, above=joint["bound"])
        axes.set_yscale("log")
        axes.set_title(f"joint {j + 1}: certified {joint['bound']:.4f} s", loc="left", fontsize=8.5)
    for axes in grid[-1]:
        axes.set_xlabel("iteration")
    for axes in grid[:, 0]:
        axes.set_ylabel("best time over the bound,\nminus 1")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=4, fontsize=8, frameon=False)
    return figure


def show_descents(data: dict[str, Any]) -> Shown:
    """Printed and reproduced reductions, the curves, and whether the printed ends are possible."""
    printed = tables("cobot")
    lines = []
    for j, joint in enumerate(data["joints"]):
        ends = {key: joint["found"][key]["median"] for key in SWARMS}
        line = [f"joint {j + 1}", *(f"{ends[key]:.4f}" for key in SWARMS), f"{joint['bound']:.4f}"]
        for rival in ("PSO", "WOA"):
            line += [printed["reductions"][rival][j], f"{_reduction(ends, rival):.2f}"]
        lines.append(line)
    header = ["", "improved", "standard PSO", "whales", "eq. 1-2", "certified",
              "below PSO: printed", "reproduced", "below whales: printed", "reproduced"]  # fmt: skip
    caption = (
        f"Ends of the curves [s], medians of {data['runs']} runs under {data['limit']:.0f} deg/s; by how many "
        "per cent the improved PSO ends below its rivals."
    )
    end, standard = (float(printed["ends"][name]) for name in ("improved", "PSO"))
    bound, way, limit = data["joints"][0]["bound"], data["crossing"][0], data["limit"]
    own = float(values(load_papers("cobot")[0].rows[0].times).sum())
    medians = [{k: joint["found"][k]["median"] for k in SWARMS} for joint in data["joints"]]
    restless = [
        ends["PSO, no inertia"] / joint["bound"] - 1.0
        for ends, joint in zip(medians, data["joints"], strict=True)
    ]
    says = {key: printed["converged"][key] for key in ("improved", "PSO", "WOA")}
    steady = {key: _steady(data["joints"][1]["found"][key]["descent"]) for key in says}
    gains = [_reduction(ends, "PSO") for ends in medians]
    whales = [_reduction(ends, "WOA") for ends in medians]
    return Shown(
        [Table(header, lines, caption, range(1, len(header))), descent_figure(data)],
        [
            f"Not reproduced: printed, the improved PSO ends {_range(printed['reductions']['PSO'])} % below "
            f"the standard one; reproduced, {min(gains):.2f} to {max(gains):.2f} % (negative: above it). "
            f"Below the whales it ends by {min(whales):.1f} to {max(whales):.1f} % (printed "
            f"{_range(printed['reductions']['WOA'])} %).",
            f"Printed times cannot hold together: joint 1 ends at {end} s in Fig. 6 and at {own:.4f} s in "
            f"Table 4, of the same algorithm. {end} s over {way:.0f} deg asks for {way / end:.1f} deg/s on "
            f"average of any motion, and of a 3-5-3 spline for a limit of at least "
            f"{limit * bound / end:.1f} deg/s, where the motion of Table 4 stays below {limit:.0f} deg/s.",
            f"A drop of {printed['reductions']['PSO'][5]} % (joint 6) means that the standard PSO ended at "
            f"{1.0 / (1.0 - float(printed['reductions']['PSO'][5]) / 100.0):.0f} times the time of the "
            f"improved one; of {data['runs']} runs of the standard PSO here, the worst on joint 6 is "
            f"{max(data['joints'][5]['found']['PSO']['seconds']) / data['joints'][5]['bound']:.5f} times the "
            "certified optimum.",
            "Joint 2 is within 1 % of its end (median run) from iteration "
            + listed([f"{steady[key]} on ({SWARMS[key][0]}, printed {i})" for key, i in says.items()])
            + ".",
            f"The other reading of the standard PSO, eq. 1-2 without inertia, ends {percent(min(restless))} to "
            f"{percent(max(restless))} above the optimum; the printed {standard} s for joint 1 is "
            f"{percent(standard / bound - 1.0, 0)} above.",
        ],
    )


def _reduction(ends: dict[str, float], rival: str) -> float:
    """By how much the improved PSO ends below a rival, per cent."""
    return 100.0 * (1.0 - ends["improved"] / ends[rival])


def _steady(found: dict[str, Any]) -> int:
    """First iteration at which the median is within 1 % of its end."""
    curve = np.array(found["quartiles"][1], dtype=float)
    return int(found["iterations"][np.flatnonzero(curve <= 1.01 * curve[-1])[0]])


def _range(printed: list[str]) -> str:
    numbers = sorted(printed, key=float)
    return f"{numbers[0]} to {numbers[-1]}"


# --- Figs 7 to 9 ----------------------------------------------------------------------------------


def make_curves(full: bool) -> dict[str, Any]:
    """The motion before, that of Table 4, and the improved PSO's on the whole arm; all judged."""
    problem = load("cobot")
    row = next(r for r in load_papers("cobot")[0].rows if r.joint is None)
    seconds = float(tables("cobot")["first_plan"]["seconds"])
    whole = summary(trials(problem, "pso-zhang-2025", _BUDGET, RUNS[full]))
    motions = {
        "before": judged(problem, np.full(3, seconds / 3.0)),
        "before, 2, 3 and 2 s": judged(problem, seconds * np.array([2.0, 3.0, 2.0]) / 7.0),
        "printed": judged(problem, values(row.times)),
        "reproduced": judged(problem, np.array(whole["durations"])),
    }
    family = FAMILIES[problem.family]
    speeds = {
        name: np.rad2deg(family.peaks(problem, np.array([m["durations"]]))[0, :, 0]).tolist()
        for name, m in motions.items()
    }
    return {
        "motions": motions,
        "speeds": speeds,
        "total": str(row.total),
        "bound": least(problem)["bound"],
        "limit": float(np.rad2deg(problem.limits.velocity[0])),
    }


def show_curves(data: dict[str, Any]) -> Shown:
    """Three motions side by side."""
    problem, motions = load("cobot"), data["motions"]
    titles = {
        "before": "before, equal times",
        "printed": "Table 4, longest times",
        "reproduced": "improved PSO again",
    }
    columns = [
        all_joints(
            f"{title}, {motions[name]['seconds']:.3f} s:\n{verdict_told(motions[name])}",
            problem, motions[name]["durations"],
        )
        for name, title in titles.items()
    ]  # fmt: skip
    before, printed, again = (motions[name]["seconds"] for name in titles)
    total, top = float(data["total"]), {name: max(s) for name, s in data["speeds"].items()}
    late = [j + 1 for j, s in enumerate(data["speeds"]["printed"]) if s > 0.99 * top["printed"]]
    return Shown(
        [panels(columns)],
        [
            f"Smooth, and at rest at both ends, as printed; but the motion takes {printed:.4f} s, not "
            f"{data['total']} s, and is {percent(1.0 - printed / before, 2)} shorter than {before:.0f} s, not "
            f"{percent(1.0 - total / before, 2)}.",
            f"Reproduced, the improved PSO takes {again:.4f} s under {data['limit']:.0f} deg/s, "
            f"{percent(1.0 - again / before, 2)} less than before; certified is {data['bound']:.4f} s. "
            f"In {data['total']} s no 3-5-3 spline can do it under that limit: it would need "
            f"{data['limit'] * data['bound'] / total:.1f} deg/s.",
            f"The speed is at its highest, {top['printed']:.1f} deg/s, on joint{'s' * (len(late) > 1)} "
            f"{listed(late)}. Acceleration is drawn in Fig. 9 but has no limit, in the paper's eq. 13 or "
            "anywhere in it: that it stays within one cannot be judged.",
            f"Before: how the {before:.0f} s are shared is not said. Equal times peak at {top['before']:.1f} "
            f"deg/s, the other reading, 2, 3 and 2 s, at {top['before, 2, 3 and 2 s']:.1f} deg/s.",
        ],
    )


ITEMS: tuple[Item, ...] = (
    Item(
        "Fig 6",
        "convergence for each joint",
        make_descents,
        show_descents,
        "100 deg/s for the limit that is not printed. The standard PSO is eq. 3-4 with c = 2, the whales those "
        "of 2016; one run of each is printed, here the median of several and the quartiles.",
        cost=10.0,
    ),
    Item(
        "Figs 7-9",
        "position, velocity and acceleration of the joints, before and after",
        make_curves,
        show_curves,
        "The shares of the 7 s before are not printed: equal. After: the longest times of Table 4, as one "
        "motion needs them.",
        cost=3.0,
    ),
)
