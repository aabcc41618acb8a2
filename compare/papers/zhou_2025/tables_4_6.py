"""Zhou 2025, Tables 4 to 6: times of each joint by PSO, sparrow search and ISSA, the latter in two readings."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.paper import load_papers, settings, with_limits
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.measure import judged, least, summary, trials
from compare.papers.verdicts import Reproduction, same_gain, same_times
from compare.papers.words import listed, percent
from compare.papers.zhou_2025.groups import (
    groups_remark,
    groups_table,
    make_groups,
    times_by_two_groups,
)
from compare.papers.zhou_2025.paper import BUDGET, RUNS, SWARMS, as_meant
from formulations import load, longest_segment


def make_times(full: bool) -> dict[str, Any]:
    """Judge printed and reproduced times of each joint and of the arm, by algorithm."""
    paper, problem = as_meant()
    swarms, solved = {}, {}
    for name, swarm in SWARMS.items():
        solved[name] = [trials(problem.joint(j), swarm, BUDGET, RUNS[full]) for j in range(problem.dof)]
        found = [summary(runs) for runs in solved[name]]
        rule = longest_segment(problem, [np.array(f["durations"]) for f in found])
        rows = [row for row in paper.rows if row.by == name]
        motions = [PrintedMotion.of(paper, row) for row in rows]
        swarms[name] = {
            "where": rows[0].where.split(",")[0],
            "printed": [[str(t) for t in row.times] for row in rows],
            "total": str(rows[-1].total),
            "impossible": [motion.impossible for motion in motions],
            "stretch": [motion.verdict.stretch for motion in motions],
            "found": found,
            "arm": judged(problem, rule.claimed),
            "arm_honest": judged(problem, rule.durations),
        }
    # other readings: degrees taken as radians, and the sign of joint 6 as printed
    rad = with_limits(problem, problem.limits.derivatives * 180.0 / np.pi)
    return {
        "swarms": swarms,
        "groups": make_groups(problem, solved["ISSA"]),
        "least": [least(problem.joint(j))["bound"] for j in range(problem.dof)]
        + [least(problem)["bound"]],
        "other_sign": least(load("ur5").joint(5))["bound"],
        "other_unit": least(rad.joint(0))["bound"],
        "crossing": float((np.abs(problem.displacements) / problem.limits.velocity).max(axis=1).sum()),
        "runs": RUNS[full],
    }


def show_times(data: dict[str, Any]) -> Shown:
    """Show a table per algorithm, the other reading of ISSA's step 1, then what concerns all three."""
    parts = [_table(data, name) for name in SWARMS]
    remarks = [_remark(data, name) for name in data["swarms"]]
    short = [f"{name} {s['total']} s" for name, s in data["swarms"].items()
             if float(s["total"]) < data["crossing"]]  # fmt: skip
    remarks.append(
        f"Displacement over speed limit alone asks for {data['crossing']:.3f} s of any motion, spline or "
        f"not. Methods whose printed total is shorter: {listed(short)}."
    )
    issa, groups = data["swarms"]["ISSA"], data["groups"]
    printed = [sum(map(float, times)) for times in issa["printed"]]
    parts.append(groups_table(groups, data["least"], printed))
    remarks += [_gain(data), groups_remark(groups, printed, issa["impossible"])]
    verdicts = [
        *(
            ItemVerdict(f"times by {name} ({s['where']})", _times(data, name))
            for name, s in data["swarms"].items()
        ),
        ItemVerdict(
            "times by ISSA, two groups", times_by_two_groups(groups, printed, issa["impossible"])
        ),
        ItemVerdict("the gain of ISSA over PSO", _gain_found(data)[2]),
    ]
    return Shown(parts, [*remarks, _other_readings(data)], verdicts)


def _times(data: dict[str, Any], name: str) -> Reproduction:
    """Judge the printed times of one algorithm, of each joint and of the arm."""
    s = data["swarms"][name]
    printed = [sum(map(float, times)) for times in s["printed"]]
    found = [f["median"] for f in s["found"]] + [s["arm"]["seconds"]]
    return same_times(printed, found, s["impossible"])


def _gain_found(data: dict[str, Any]) -> tuple[str, float, Reproduction]:
    """Return the printed gain of ISSA over PSO [%], the one found, and what that leaves of the first."""
    claim = next(c for c in load_papers("zhou_2025")[0].claims if c.rule == "reduction")  # over PSO
    issa, pso = (sum(f["median"] for f in data["swarms"][name]["found"]) for name in ("ISSA", "PSO"))
    found = 1.0 - issa / pso
    return str(claim.equals), found, same_gain(claim.equals.value / 100.0, found)


def _remark(data: dict[str, Any], name: str) -> str:
    """Whether the printed times of one algorithm are reproduced."""
    s, bounds = data["swarms"][name], data["least"]
    joints = [j + 1 for j in range(6) if s["impossible"][j]]
    total = sum(map(float, s["printed"][-1]))
    return (
        f"{s['where']}, {name}: {_times(data, name).inside}. Joints whose printed "
        f"time is proved to be shorter than that of any 3-5-3 spline within the limits of Table 3: "
        f"{listed(joints)}. The motion of all joints takes {s['total']} s in print and "
        + (
            f"breaks the limits until all times are stretched by {s['stretch'][-1]:.3f}, to "
            f"{total * s['stretch'][-1]:.2f} s"
            if s["stretch"][-1] > 1.0
            else "keeps the limits"
        )
        + f"; the certified optimum is {bounds[-1]:.3f} s."
    )


def _gain(data: dict[str, Any]) -> str:
    """Whether the gain of ISSA over PSO is reproduced."""
    printed, found, outcome = _gain_found(data)
    medians = {name: sum(f["median"] for f in s["found"]) for name, s in data["swarms"].items()}
    best = sum(data["least"][:-1])
    gaps = ", ".join(f"{name} {medians[name] / best - 1.0:.1e}" for name in medians)
    return (
        f"The gain of ISSA over PSO is {outcome.inside}. Printed: "
        f"{printed} % shorter. With the same budget the median runs of ISSA, summed over the joints, are "
        f"{percent(abs(found), 3)} {'shorter' if found > 0.0 else 'longer'} than those of PSO. Gaps to the "
        f"optimum: {gaps}."
    )


def _other_readings(data: dict[str, Any]) -> str:
    """Whether radians for the printed degrees, or the sign as printed, would explain the times."""
    joint_1 = sum(float(t) for t in data["swarms"]["ISSA"]["printed"][0])
    helps = joint_1 >= data["other_unit"]
    return (
        f"The other reading of the limits, radians for the printed degrees, "
        f"{'explains' if helps else 'does not explain'} the times: joint 1 then needs {data['other_unit']:.3f} "
        f"s, printed {joint_1:.3f} s. With the sign of joint 6 as printed that joint needs "
        f"{data['other_sign']:.3f} s instead of {data['least'][5]:.3f} s."
    )


def _table(data: dict[str, Any], name: str) -> Table:
    s, lines = data["swarms"][name], []
    for j, found in enumerate(s["found"]):
        lines.append(
            [f"joint {j + 1}", *_printed(s["printed"][j]), *_reproduced(found["durations"]),
             f"{data['least'][j]:.4f}", "impossible" if s["impossible"][j] else "not excluded"]
        )  # fmt: skip
    lines.append(
        ["longest per segment", *_printed(s["printed"][6]), *_reproduced(s["arm"]["durations"]),
         f"{data['least'][6]:.4f}", "impossible" if s["impossible"][6] else "not excluded"]
    )  # fmt: skip
    keeps = "keeps the limits" if s["arm"]["keeps"] else "breaks the limits"
    caption = (
        f"{s['where']}: {name} ({SWARMS[name]}), each joint alone, median of {data['runs']} runs [s]. The "
        f"last row as one reproduced motion {keeps}; stretched until it just does, it takes "
        f"{s['arm_honest']['seconds']:.4f} s."
    )
    header = ["", "printed", "sum", "reproduced", "sum", "certified least sum", "printed times are"]
    return Table(header, lines, caption, (1, 2, 3, 4, 5))


def _printed(times: list[str]) -> list[str]:
    return [", ".join(times), f"{sum(float(t) for t in times):.3f}"]


def _reproduced(times: list[float]) -> list[str]:
    return [", ".join(f"{t:.3f}" for t in times), f"{sum(times):.4f}"]


TABLES_4_6 = Item(
    "Tables 4-6",
    "times of each joint by PSO, sparrow search and ISSA",
    make_times,
    show_times,
    "Open are the constants of the swarms (taken from their sources; PSO with constriction), the box (up to "
    "three times the shortest feasible equal times) and what an infeasible candidate costs (it is out). Step 1 "
    "of sec. 4.2 starts a group of sparrows and one of butterflies, eq. 8-15 move one population: one flock "
    "makes both kinds of moves. In the other reading each of a generation's moves is made by a sparrow or by a "
    "butterfly of another group, with the same weights, and both groups know the best of both. Budget "
    f"as printed: {settings('ur5')['swarm']['population']} individuals, "
    f"{settings('ur5')['swarm']['iterations']} iterations, every evaluation counted. Joint 6 has its sign "
    "restored.",
    cost=30.0,
)
