"""Zhang 2025, Fig. 6 (convergence) and Figs 7 to 9 (curves of the joints)."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.audit.paper import settings
from compare.audit.paper.digits import values
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.measure import judged, least, spline, summary, trials
from compare.papers.pictures.descent import descent, draw_descent
from compare.papers.pictures.panels import all_joints, panels, verdict_told
from compare.papers.verdicts import Reproduction, agrees, held, same_gains, smooth
from compare.papers.words import listed, percent
from compare.papers.zhang_2025.layers import first_layer, integrated, second_layer
from compare.papers.zhang_2025.paper import BUDGET, RUNS, ends, first_plan, paper, reductions
from compare.report.style import BLUE, GREEN, ORANGE, VERMILION, styled
from formulations import FAMILIES, load

_ROUNDING = 1e-3  # s: sums of printed times

# --- Fig. 6 ---------------------------------------------------------------------------------------

SWARMS = {
    "improved": ("improved PSO", "pso-zhang-2025", (BLUE, "-")),
    "PSO": ("standard PSO", "pso-linear", (VERMILION, "-")),
    "WOA": ("standard whales", "whale", (GREEN, "-")),
    "PSO, no inertia": ("PSO of eq. 1-2", "pso-1995", (ORANGE, "-")),
}


def make_descents(full: bool) -> dict[str, Any]:
    """Follow the best time of each joint alone over the iterations, by swarm."""
    problem = load("cobot")
    joints = []
    for j in range(problem.dof):
        alone = problem.joint(j)
        found = {}
        for key, (_, swarm, _) in SWARMS.items():
            runs = trials(alone, swarm, BUDGET, RUNS[full])
            traces = [graded.traces[0] for graded in runs]
            found[key] = {
                "descent": descent(traces, BUDGET.population, BUDGET.iterations),
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
    """Draw a panel per joint: the gap to the certified bound."""
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
    """Show printed and reproduced reductions and the curves."""
    printed = reductions()
    lines = []
    for j, joint in enumerate(data["joints"]):
        last = {key: joint["found"][key]["median"] for key in SWARMS}
        line = [f"joint {j + 1}", *(f"{last[key]:.4f}" for key in SWARMS), f"{joint['bound']:.4f}"]
        for rival in ("PSO", "WOA"):
            line += [printed[rival][j], f"{_reduction(last, rival):.2f}"]
        lines.append(line)
    header = ["", "improved", "standard PSO", "whales", "eq. 1-2", "certified",
              "below PSO: printed", "reproduced", "below whales: printed", "reproduced"]  # fmt: skip
    caption = (
        f"Ends of the curves [s], medians of {data['runs']} runs under {data['limit']:.0f} deg/s; by how many "
        "per cent the improved PSO ends below its rivals."
    )
    return Shown(
        [Table(header, lines, caption, range(1, len(header))), descent_figure(data)],
        _remarks_6(data),
        _verdicts_6(data),
    )


def _verdicts_6(data: dict[str, Any]) -> list[ItemVerdict]:
    return [
        ItemVerdict("the gain over the standard PSO", _gain(data, "PSO")),
        ItemVerdict("the gain over the whales", _gain(data, "WOA")),
        ItemVerdict("the end of joint 1, against Table 4", held(_as_in_table_4())),
    ]


def _gains(data: dict[str, Any], rival: str) -> list[float]:
    """By how much the median improved PSO ends below a rival, by joint [%]."""
    found = [joint["found"] for joint in data["joints"]]
    return [_reduction({key: f[key]["median"] for key in SWARMS}, rival) for f in found]


def _gain(data: dict[str, Any], rival: str) -> Reproduction:
    printed = [float(p) / 100.0 for p in reductions()[rival]]
    return same_gains(printed, [gain / 100.0 for gain in _gains(data, rival)])


def _own_total() -> float:
    """Sum of the times of joint 1 in Table 4 [s]."""
    return float(values(paper().rows[0].times).sum())


def _as_in_table_4() -> bool:
    return abs(float(ends()["improved"]) - _own_total()) <= _ROUNDING


def _remarks_6(data: dict[str, Any]) -> list[str]:
    printed, joints = reductions(), data["joints"]
    end, standard = (float(ends()[name]) for name in ("improved", "PSO"))
    bound, way, limit = joints[0]["bound"], data["crossing"][0], data["limit"]
    medians = [{k: joint["found"][k]["median"] for k in SWARMS} for joint in joints]
    restless = [
        m["PSO, no inertia"] / joint["bound"] - 1.0 for m, joint in zip(medians, joints, strict=True)
    ]
    says = {key: settings("cobot")["converged"][key] for key in ("improved", "PSO", "WOA")}
    steady = {key: _steady(joints[1]["found"][key]["descent"]) for key in says}
    gains = {rival: _gains(data, rival) for rival in printed}
    outcomes = {rival: _gain(data, rival) for rival in printed}
    needed = limit * bound / end
    factor = 1.0 / (1.0 - float(printed["PSO"][5]) / 100.0)
    worst = max(joints[5]["found"]["PSO"]["seconds"]) / joints[5]["bound"]
    return [
        f"The gain over the standard PSO is {outcomes['PSO'].inside}. Printed, the improved PSO ends "
        f"{_range(printed['PSO'])} % below it; reproduced, {min(gains['PSO']):.2f} to "
        f"{max(gains['PSO']):.2f} % (negative: above it). The gain over the whales is "
        f"{outcomes['WOA'].inside}: printed "
        f"{_range(printed['WOA'])} %, reproduced {min(gains['WOA']):.1f} to {max(gains['WOA']):.1f} %.",
        f"For joint 1 and the same algorithm Fig. 6 ends at {end} s and Table 4 adds up to {_own_total():.4f} s"
        + ("." if _as_in_table_4() else ": the two contradict each other.")
        + f" {end} s over {way:.0f} deg asks for {way / end:.1f} deg/s on average of any motion. A 3-5-3 "
        f"spline would need a limit of at least {needed:.1f} deg/s; the motion of Table 4 "
        f"{'stays below' if needed > limit else 'needs up to'} {limit:.0f} deg/s.",
        f"A drop of {printed['PSO'][5]} % (joint 6) means that the standard PSO ended at {factor:.0f} times "
        f"the time of the improved one. Of {data['runs']} runs of the standard PSO here, the worst on joint "
        "6 ends at "
        f"{worst:.5f} times the certified optimum.",
        "Joint 2 is within 1 % of its end (median run) from iteration "
        + listed([f"{steady[key]} on ({SWARMS[key][0]}, printed {i})" for key, i in says.items()])
        + ".",
        f"The other reading of the standard PSO, eq. 1-2 without inertia, ends {percent(min(restless))} to "
        f"{percent(max(restless))} above the optimum; the printed {standard} s for joint 1 is "
        f"{percent(standard / bound - 1.0, 0)} above it.",
    ]


def _reduction(ends: dict[str, float], rival: str) -> float:
    """By how much the improved PSO ends below a rival [%]."""
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
    """Judge the motion before, that of Table 4, and the improved PSO's in the two layers of sec. 2.3."""
    problem = load("cobot")
    row = next(r for r in paper().rows if r.joint is None)
    seconds = first_plan()
    starts = integrated(problem, first_layer(problem, RUNS[full] // 3))
    whole = summary(second_layer(problem, starts))
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
    """Show three motions side by side."""
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
    return Shown([panels(columns)], _remarks_7(data), _verdicts_7(data))


def _calm(motion: dict[str, Any]) -> bool:
    """Whether a motion is smooth, and at rest at its ends."""
    found = spline(load("cobot"), motion["durations"])
    edge = np.abs([found.at([0.0, found.seconds], order) for order in (1, 2)]).max()
    return smooth(*found.jumps.ravel(), float(edge))


def _needed(data: dict[str, Any]) -> float:
    """Speed limit under which a spline could take the printed total [deg/s]."""
    return float(data["limit"] * data["bound"] / float(data["total"]))


def _verdicts_7(data: dict[str, Any]) -> list[ItemVerdict]:
    printed = data["motions"]["printed"]
    same = abs(printed["seconds"] - float(data["total"])) <= _ROUNDING
    return [
        ItemVerdict("that the motion is smooth, and at rest at its ends", held(_calm(printed))),
        ItemVerdict("that it takes the printed total", held(same)),
        ItemVerdict(
            f"that the printed total can be done under {data['limit']:.0f} deg/s",
            held(_needed(data) <= data["limit"]),
        ),
    ]


def _remarks_7(data: dict[str, Any]) -> list[str]:
    motions = data["motions"]
    before, printed, again = (motions[name]["seconds"] for name in ("before", "printed", "reproduced"))
    total, top = float(data["total"]), {name: max(s) for name, s in data["speeds"].items()}
    late = [j + 1 for j, s in enumerate(data["speeds"]["printed"]) if s > 0.99 * top["printed"]]
    calm, needed = _calm(motions["printed"]), _needed(data)
    return [
        f"The printed motion is {'smooth and at rest' if calm else 'not smooth or not at rest'} at both ends, "
        f"{agrees(calm)}. It takes {printed:.4f} s (printed: {data['total']} s), "
        f"{agrees(abs(printed - total) <= _ROUNDING)}. That is {percent(1.0 - printed / before, 2)} "
        "shorter than "
        f"{before:.0f} s (printed: {percent(1.0 - total / before, 2)}).",
        f"Reproduced, the improved PSO takes {again:.4f} s under {data['limit']:.0f} deg/s, "
        f"{percent(1.0 - again / before, 2)} less than before; the certified minimum is {data['bound']:.4f} s. "
        f"In {data['total']} s a 3-5-3 spline would need a limit of {needed:.1f} deg/s"
        + (": under the assumed limit it cannot be done." if needed > data["limit"] else "."),
        f"The speed is highest, {top['printed']:.1f} deg/s, on joint{'s' * (len(late) > 1)} {listed(late)}. "
        "Acceleration is drawn in Fig. 9, but the paper states no limit for it, in eq. 13 or elsewhere: "
        "whether "
        "it stays within one cannot be judged.",
        f"Before: how the {before:.0f} s are shared is not said. Equal times peak at {top['before']:.1f} "
        "deg/s; "
        f"the other reading, 2, 3 and 2 s, peaks at {top['before, 2, 3 and 2 s']:.1f} deg/s.",
    ]


FIGURE_6 = Item(
    "Fig 6",
    "convergence for each joint",
    make_descents,
    show_descents,
    "100 deg/s for the limit that is not printed. The standard PSO is eq. 3-4 with c = 2, the whales are those "
    "of 2016. The paper prints one run of each; here stand the median of several runs and the quartiles.",
    cost=10.0,
)
FIGURES_7_9 = Item(
    "Figs 7-9",
    "position, velocity and acceleration of the joints, before and after",
    make_curves,
    show_curves,
    "How the 7 s before are shared is not printed: equal shares are taken. After: the longest times of Table "
    "4, which one motion of all joints needs; reproduced, the median of a third as many runs as in Table 4, in "
    "the two layers of sec. 2.3.",
    cost=5.0,
)
