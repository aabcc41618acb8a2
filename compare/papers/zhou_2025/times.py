"""Tables 4 to 6 of 002: times of each joint by PSO, sparrow search and ISSA."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.audit.minima import with_limits
from compare.audit.motions import Motion
from compare.audit.paper import Paper
from compare.audit.paper_file import load_papers
from compare.benchmark.suite import PAPER_BUDGETS
from compare.papers.item import Item, Shown, Table
from compare.papers.measure import judged, least, listed, percent, summary, trials
from compare.papers.printed import tables
from formulations import Problem, load, longest_segment

SWARMS = {"PSO": "pso", "SSA": "sparrow", "ISSA": "issa"}  # as the paper calls them
RUNS = {False: 5, True: 30}


def as_meant() -> tuple[Paper, Problem]:
    """The paper and its task with the sign of one angle restored."""
    paper = next(p for p in load_papers("ur5") if p.name == "ur5-corrected")
    return paper, load("ur5-corrected")


# --- Tables 4 to 6 --------------------------------------------------------------------------------


def make_times(full: bool) -> dict[str, Any]:
    """By algorithm: printed and reproduced times of each joint and of the arm, beside the optimum."""
    paper, problem = as_meant()
    swarms = {}
    for name, swarm in SWARMS.items():
        runs = [
            trials(problem.joint(j), swarm, PAPER_BUDGETS["ur5"], RUNS[full])
            for j in range(problem.dof)
        ]
        found = [summary(r) for r in runs]
        rule = longest_segment(problem, [np.array(f["durations"]) for f in found])
        rows = [row for row in paper.rows if row.by == name]
        motions = [Motion.of(paper, row) for row in rows]
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
    # the limits as if degrees were radians, and joint 6 as its sign is printed
    rad = with_limits(problem, problem.limits.derivatives * 180.0 / np.pi)
    return {
        "swarms": swarms,
        "least": [least(problem.joint(j))["bound"] for j in range(problem.dof)]
        + [least(problem)["bound"]],
        "other_sign": least(load("ur5").joint(5))["bound"],
        "other_unit": least(rad.joint(0))["bound"],
        "crossing": float((np.abs(problem.displacements) / problem.limits.velocity).max(axis=1).sum()),
        "runs": RUNS[full],
    }


def show_times(data: dict[str, Any]) -> Shown:
    """A table per algorithm, then what is to be said of all three."""
    parts = [_table(data, name) for name in SWARMS]
    bounds = data["least"]
    remarks = []
    for name, s in data["swarms"].items():
        joints = [j + 1 for j in range(6) if s["impossible"][j]]
        total = float(sum(float(t) for t in s["printed"][-1]))
        remarks.append(
            f"{s['where']}, {name}: not reproduced. Joints {listed(joints)} take less time in print than any "
            f"3-5-3 spline that keeps the limits of Table 3 (proved); as one motion of {s['total']} s the "
            f"arm breaks them until all times are stretched by {s['stretch'][-1]:.3f}, to "
            f"{total * s['stretch'][-1]:.2f} s; the certified optimum is {bounds[-1]:.3f} s."
        )
    short = [f"{name} {s['total']} s" for name, s in data["swarms"].items()
             if float(s["total"]) < data["crossing"]]  # fmt: skip
    remarks.append(
        f"Displacement over speed limit alone asks for {data['crossing']:.3f} s of any motion, spline or "
        f"not: more than what is printed for {listed(short) if short else 'none of them'}."
    )
    claim = next(c for c in load_papers("ur5")[0].claims if c.rule == "reduction")  # over PSO
    medians = {name: sum(f["median"] for f in s["found"]) for name, s in data["swarms"].items()}
    best = bounds[:-1]
    gaps = ", ".join(f"{name} {medians[name] / sum(best) - 1.0:.1e}" for name in medians)
    pso, issa = medians["PSO"], medians["ISSA"]
    remarks.append(
        f"What ISSA gains is not reproduced: printed, {claim.equals} % over PSO; with the same budget its "
        f"median runs, summed over the joints, are {percent(abs(issa / pso - 1.0), 3)} "
        f"{'shorter' if issa < pso else 'longer'} than those of PSO. Gaps to the optimum: {gaps}."
    )
    joint_1 = sum(float(t) for t in data["swarms"]["ISSA"]["printed"][0])
    remarks.append(
        f"The other reading of the limits, radians for the printed degrees, does not help: joint 1 then "
        f"still needs {data['other_unit']:.3f} s, printed {joint_1:.3f} s. "
        f"With the sign of joint 6 as printed that joint needs {data['other_sign']:.3f} s instead of "
        f"{bounds[5]:.3f} s."
    )
    return Shown(parts, remarks)


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


ITEMS: tuple[Item, ...] = (
    Item(
        "Tables 4-6",
        "times of each joint by PSO, sparrow search and ISSA",
        make_times,
        show_times,
        "Open: constants of the swarms (as in their sources; PSO with constriction), the box (to three times "
        "the shortest feasible equal times), what an infeasible candidate costs (it is out). Budget as "
        f"printed: {tables('ur5')['swarm']['population']} individuals, "
        f"{tables('ur5')['swarm']['iterations']} iterations, every evaluation counted. Joint 6 with its sign "
        "restored.",
        cost=25.0,
    ),
)
