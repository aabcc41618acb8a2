"""Zhang 2025, Table 4 and sec. 2.3: times of each joint by the improved PSO, then of the whole arm."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.paper import settings
from compare.audit.paper.digits import values
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.measure import judged, least, summary
from compare.papers.verdicts import Reproduction, held, same_times, yes_no
from compare.papers.words import percent
from compare.papers.zhang_2025.layers import first_layer, layers_remarks, layers_table, make_layers
from compare.papers.zhang_2025.paper import RUNS, paper
from formulations import FAMILIES, load, longest_segment

_ROUNDING = 1e-3  # s: sums of printed times


def make_times(full: bool) -> dict[str, Any]:
    """Run the improved PSO on each joint alone, then on the whole arm from their results (sec. 2.3)."""
    printed, problem = paper(), load("cobot")
    runs = RUNS[full]
    solved = first_layer(problem, runs)
    alone, layers = [summary(found) for found in solved], make_layers(problem, solved)
    rule = longest_segment(problem, [np.array(found["durations"]) for found in alone])
    rows = [row for row in printed.rows if row.by == "improved PSO"]
    implied = []
    for row in rows:
        motion = PrintedMotion.of(printed, row)
        family = FAMILIES[motion.problem.family]
        speeds = family.peaks(motion.problem, motion.times[None])[0, :, 0]
        implied.append(np.rad2deg(speeds).tolist())
    return {
        "printed": [[str(t) for t in row.times] for row in rows],
        "total": str(rows[-1].total),
        "speeds": implied,
        "arm": judged(problem, values(rows[-1].times)),
        "alone": alone,
        "whole": layers["readings"]["longest"],
        "layers": layers,
        "rule": judged(problem, rule.claimed),
        "least": [least(problem.joint(j))["bound"] for j in range(problem.dof)]
        + [least(problem)["bound"]],
        "limit": float(np.rad2deg(problem.limits.velocity[0])),
        "runs": runs,
    }


def show_times(data: dict[str, Any]) -> Shown:
    """Show printed and reproduced times, with the arm in the last row."""
    lines = []
    for j in range(7):
        found = data["alone"][j] if j < 6 else data["whole"]
        times = data["printed"][j]
        lines.append(
            [
                f"joint {j + 1}" if j < 6 else "arm: longest, whole",
                ", ".join(times),
                f"{sum(map(float, times)):.4f}",
                f"{max(data['speeds'][j]):.1f}",
                ", ".join(f"{t:.4f}" for t in found["durations"]),
                f"{found['median']:.4f}",
                f"{data['least'][j]:.4f}",
            ]
        )
    header = [
        "",
        "printed",
        "sum",
        "peak speed implied [deg/s]",
        "reproduced",
        "sum",
        "certified least sum",
    ]
    caption = (
        f"Times of the three segments [s]. Reproduced: improved PSO under {data['limit']:.0f} deg/s for every "
        f"joint, each joint alone and, last row, the whole arm from their results; median of {data['runs']} "
        "runs."
    )
    layers, bound = data["layers"], data["least"][6]
    return Shown(
        [Table(header, lines, caption, (1, 2, 3, 4, 5, 6)), layers_table(layers, bound)],
        [*_remarks(data), *layers_remarks(layers, bound)],
        _verdicts(data),
    )


def _sums(data: dict[str, Any]) -> list[float]:
    """Printed sums of each joint, then of the arm [s]."""
    return [sum(map(float, times)) for times in data["printed"]]


def _alone(data: dict[str, Any]) -> Reproduction:
    """Judge the printed times of the joints as those of each joint alone."""
    return same_times(_sums(data)[:6], [found["median"] for found in data["alone"]])


def _adds_up(data: dict[str, Any]) -> bool:
    return abs(_sums(data)[6] - float(data["total"])) <= _ROUNDING


def _verdicts(data: dict[str, Any]) -> list[ItemVerdict]:
    return [
        ItemVerdict("the total as the sum of the longest times", held(_adds_up(data))),
        ItemVerdict("the times of each joint alone", _alone(data)),
    ]


def _remarks(data: dict[str, Any]) -> list[str]:
    sums = _sums(data)
    bound, arm, rule = data["least"][6], data["arm"], data["rule"]
    first = data["printed"][0]
    later = float(first[1]) + float(first[2])
    left_out = abs(later - float(data["total"])) <= _ROUNDING and not _adds_up(data)
    ratios = [sums[j] / data["least"][j] for j in range(6)]
    peak = max(data["speeds"][6])
    keeps = "keeps the limit" if rule["keeps"] else f"is too fast by a factor of {rule['stretch']:.4f}"
    return [
        f"The printed total is {data['total']} s. "
        + ("It leaves the first segment out" if left_out else "Without the first segment joint 1 needs")
        + f" ({first[1]} + {first[2]} = {later:.4f} s): each row adds up to at least {min(sums[:6]):.4f} "
        "s, the "
        f"longest times of all segments to {sums[6]:.4f} s.",
        f"As the optimum of each joint alone the rows are {_alone(data).inside}: they take "
        f"{min(ratios):.2f} to {max(ratios):.2f} times what the joints need. As times of the whole arm they "
        f"are {percent(arm['seconds'] / bound - 1.0)} above its certified optimum of {bound:.4f} s under "
        f"{data['limit']:.0f} deg/s. The improved PSO, reproduced, comes within "
        f"{data['whole']['median'] / bound - 1.0:.1e} of that optimum.",
        f"No limit is printed. The printed motion peaks at {peak:.1f} deg/s and keeps {data['limit']:.0f} "
        f"deg/s: {yes_no(peak <= data['limit'])}. The other reading, its own peak as the limit, multiplies "
        "every time "
        f"here by {data['limit'] / peak:.4f}.",
        f"The first of the two layers alone, the longest time per segment over the joints, takes "
        f"{rule['seconds']:.4f} s and {keeps}.",
    ]


TABLE_4 = Item(
    "Table 4",
    "times of each joint by the improved PSO, and the two layers of sec. 2.3",
    make_times,
    show_times,
    "The speed limit of eq. 13 is not printed: 100 deg/s for every joint. Each joint alone and then the whole "
    "arm from the joints' results, as sec. 2.3 has it. How they are put together is open: one particle starts "
    "at the longest time of each segment; the other readings are seven particles, the joints' own times too; "
    "one particle at longest times that were slowed until they keep the limit; and a fresh "
    "start. alpha and beta of eq. 6, open in (0, 1), are 0.5. Budget as printed: "
    f"{settings('cobot')['swarm']['population']} particles, {settings('cobot')['swarm']['iterations']} "
    "iterations.",
    cost=14.0,
)
