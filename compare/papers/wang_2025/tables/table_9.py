"""Wang 2025, Table 9: every joint by MIPSO, and the rule of the longest time per segment (sec. 4.2.2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.paper import PrintedTimes, with_limits
from compare.benchmark.grade import durations_of
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.measure import judged, judged_row, least, summary, trials
from compare.papers.verdicts import BEST, UNUSED, Reproduction, same_times
from compare.papers.wang_2025.joint_1 import IN_FORCE, LIMITS, joint_1
from compare.papers.wang_2025.paper import (
    PRINTED_TIMES,
    SWARM,
    boxes,
    budget,
    fitting_limits,
    in_words,
    paper,
)
from compare.papers.words import above, listed, seconds
from formulations import Problem, load, longest_segment
from formulations.problem.arrays import Array

FITTED, STATED = "the limits that fit", "Table 6"
BY = {
    "exact": "certified optima",
    SWARM: "MIPSO",
    "boxed": "MIPSO in the other box",
    "mipso-printed": "MIPSO, eq. 15 and 16 as printed",
}


def make_table_9(full: bool) -> dict[str, Any]:
    """Judge, repeat and certify each joint alone; apply the rule under both readings of the limits."""
    problem, table = load("sr4c"), paper().rows
    runs = 30 if full else 10
    single = [row for row in table if row.where.startswith("Table 9")]
    whole = next(row for row in table if row.joint is None)
    own = [_own_limits(row) for row in single]
    fit = np.radians([limits["acceleration"] for limits in own])
    fitted = replace(problem, limits=replace(problem.limits, acceleration=fit))
    return {
        "runs": runs,
        "box": list(boxes()[PRINTED_TIMES]),
        "joints": [
            {"printed": judged_row(paper(), row), "own": limits}
            for row, limits in zip(single, own, strict=True)
        ],
        "printed": judged_row(paper(), whole),
        "printed_if_fitted": judged(fitted, [time.value for time in whole.times]),
        "rules": {FITTED: _apply_rule(fitted, runs), STATED: _apply_rule(problem, runs)},
        "joint_1": least(joint_1(IN_FORCE)),
    }


def _own_limits(row: PrintedTimes) -> dict[str, Any]:
    """Lowest limits of two digits that a printed vector keeps, and the optimum under them."""
    motion = PrintedMotion.of(paper(), row)
    velocity, acceleration = fitting_limits(row)
    found = least(with_limits(motion.problem, motion.rounded))
    return {"velocity": velocity, "acceleration": acceleration, **found}


def _apply_rule(problem: Problem, runs: int) -> dict[str, Any]:
    """Search and certify each joint alone, apply the rule to them, and certify all joints together."""
    alone = [problem.joint(j) for j in range(problem.dof)]
    repeated = {
        name: [trials(one, swarm, budget(), runs, box) for one in alone]
        for name, swarm, box in (
            (SWARM, SWARM, None),
            ("boxed", SWARM, boxes()[PRINTED_TIMES]),
            ("mipso-printed", "mipso-printed", None),
        )
    }
    single = [least(one) for one in alone]
    motions = {"exact": [_longest(problem, [np.array(one["durations"]) for one in single])]}
    for name, groups in repeated.items():
        seeds = zip(*groups, strict=True)
        motions[name] = [_longest(problem, [durations_of(g.row) for g in seed]) for seed in seeds]
    return {
        "acceleration": np.degrees(problem.limits.acceleration).tolist(),
        "single": single,
        "trials": [summary(group) for group in repeated[SWARM]],
        "least": least(problem),
        "motions": motions,
    }


def _longest(problem: Problem, vectors: list[Array]) -> dict[str, Any] | None:
    """Judge the longest time per segment over the joints; None if a joint has no feasible motion."""
    if not all(v.size for v in vectors):
        return None
    return judged(problem, longest_segment(problem, vectors).claimed)


def show_table_9(data: dict[str, Any]) -> Shown:
    """Show every joint, the limits that were in force, and the rule under each reading."""
    header = ["joint", "t1", "t2", "t3", "total, printed", "uses", "t1", "t2", "t3", "total, reproduced",
              "best", "certified optimum"]  # fmt: skip
    lines, stated = [], data["rules"][STATED]
    for number, joint in enumerate(data["joints"], start=1):
        p, t = joint["printed"], stated["trials"][number - 1]
        lines.append([str(number), *p["times"], str(p["total"]), p["most"].replace(" of joint 1", ""),
                      *map(seconds, t["durations"]), seconds(t["median"]), seconds(t["seconds"][0]),
                      seconds(stated["single"][number - 1]["optimum"])])  # fmt: skip
    caption = (
        f"Times [s]; reproduced: median of {data['runs']} seeds and the best total. Uses: the limit of Table 6 "
        "that the printed vector uses most. Certified optimum: nothing is faster by more than 1e-6 of it."
    )
    right = [0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 11]
    own = Table(
        ["joint", "keeps Table 6", "peak velocity [deg/s]", "peak acceleration [deg/s²]",
         "certified optimum under these", "printed above it"],
        [[str(i), j["printed"]["keeps"], f"{j['own']['velocity']:.3g}", f"{j['own']['acceleration']:.3g}",
          seconds(j["own"]["optimum"]), above(j["printed"]["seconds"], j["own"]["optimum"])]
         for i, j in enumerate(data["joints"], start=1)],
        "The peaks of the printed vectors, raised to two digits within the print's rounding, taken as limits.",
        range(2, 6),
    )  # fmt: skip
    parts = [Table(header, lines, caption, right), own, _rule_table(data)]
    return Shown(parts, _remarks_9(data), _verdicts_9(data))


def _verdicts_9(data: dict[str, Any]) -> list[ItemVerdict]:
    return [
        verdict
        for limits in (FITTED, STATED)
        for verdict in (
            ItemVerdict(f"the total of each joint, {limits}", _totals(data, limits)),
            ItemVerdict(f"the total by the rule, {limits}", _by_rule(data, limits)),
        )
    ]


def _totals(data: dict[str, Any], limits: str) -> Reproduction:
    """Judge the printed totals of all joints by the medians of MIPSO under some limits."""
    found = [t["median"] for t in data["rules"][limits]["trials"]]
    printed = [j["printed"]["seconds"] for j in data["joints"]]
    return same_times(printed, [np.inf if median is None else median for median in found])


def _by_rule(data: dict[str, Any], limits: str) -> Reproduction:
    """Judge the printed total of the rule by the certified optima of the joints under some limits."""
    (exact,) = _solved(data["rules"][limits]["motions"]["exact"])
    return same_times([data["printed"]["seconds"]], [exact["seconds"]])


def _rule_table(data: dict[str, Any]) -> Table:
    """The longest time per segment, printed and by every reading."""
    p = data["printed"]
    header = ["limits", "single joints by", "t1", "t2", "t3", "total", "printed above it", "all totals",
              "keep the limits", "slowed down until they do", "certified optimum together"]  # fmt: skip
    lines = [["", "printed", *p["times"], str(p["total"]), "", "", "", "", ""]]
    for limits, rule in data["rules"].items():
        for by, motions in rule["motions"].items():
            solved = _solved(motions)
            if not solved:
                lines.append([limits, BY[by], *["none"] * 8, seconds(rule["least"]["optimum"])])
                continue
            median, honest = solved[(len(solved) - 1) // 2], _honest(solved)
            lines.append([limits, BY[by], *map(seconds, median["durations"]), seconds(median["seconds"]),
                          above(p["seconds"], median["seconds"]), _range([m["seconds"] for m in solved]),
                          f"{sum(m['keeps'] for m in solved)} of {len(motions)}", _range(honest),
                          seconds(rule["least"]["optimum"])])  # fmt: skip
    caption = (
        f"The longest time of each segment over the joints [s]; MIPSO: median of {data['runs']} seeds. The "
        f"limits that fit: {_accelerations(data)} deg/s², velocity as in Table 6. The other box: "
        f"{in_words(*data['box'])}."
    )
    return Table(header, lines, caption, range(2, 11))


def _accelerations(data: dict[str, Any]) -> str:
    return "/".join(f"{a:.3g}" for a in data["rules"][FITTED]["acceleration"])


def _range(values: Sequence[float]) -> str:
    low, high = seconds(min(values)), seconds(max(values))
    return low if low == high else f"{low} to {high}"


def _solved(motions: Sequence[dict[str, Any] | None]) -> list[dict[str, Any]]:
    """Motions of the rule, shortest first."""
    return sorted((m for m in motions if m is not None), key=lambda m: float(m["seconds"]))


def _honest(solved: Sequence[dict[str, Any]]) -> list[float]:
    """Times of the motions of the rule once they keep the limits."""
    return [m["seconds"] * max(m["stretch"], 1.0) for m in solved]


def _remarks_9(data: dict[str, Any]) -> list[str]:
    unused = [
        f"{i} ({j['own']['acceleration']:.3g} deg/s²)"
        for i, j in enumerate(data["joints"], start=1)
        if j["printed"]["stretch"] < 1.0 - UNUSED
    ]
    bounds = [one["bound"] for one in data["rules"][STATED]["single"]]
    near = [
        str(i) for i, (j, bound) in enumerate(zip(data["joints"], bounds, strict=True), start=1)
        if abs(j["printed"]["seconds"] / bound - 1.0) < BEST
    ]  # fmt: skip
    p, optimum = data["printed"], data["rules"][STATED]["least"]["optimum"]
    first = data["joints"][0]
    return [
        f"Joints whose printed total lies within 0.1 % of the certified optimum under Table 6: {listed(near)}.",
        f"Joints that leave their limits unused: {listed(unused)}."
        + (" Other limits of acceleration than those of Table 6 were in force there." if unused else "")
        + f" The printed total of joint 1 is {first['printed']['total']} s. Under "
        f"{LIMITS[IN_FORCE][1]:.0f} deg/s² joint 1 cannot be faster than {data['joint_1']['bound']:.4f} s, "
        f"under Table 6 not faster than {bounds[0]:.4f} s.",
        f"The printed motion of the rule takes {p['total']} s and keeps Table 6: {p['keeps']} ({p['most']}). "
        f"It is {above(p['seconds'], optimum)} against the certified optimum of all joints together, "
        f"{optimum:.4f} s.",
        "The totals of the single joints are "
        + " and ".join(f"{_totals(data, limits).inside} under {limits}" for limits in (FITTED, STATED))
        + ", by the medians of MIPSO.",
        *(_claim(data, limits) for limits in (FITTED, STATED)),
        _together(data),
    ]


def _claim(data: dict[str, Any], limits: str) -> str:
    """Whether the printed total follows from the rule under some limits."""
    p, found = data["printed"], data["rules"][limits]["motions"]
    (exact,), solved = _solved(found["exact"]), _solved(found[SWARM])
    name = f"{limits} ({_accelerations(data)} deg/s²)" if limits == FITTED else limits
    text = (
        f"{_by_rule(data, limits)} under {name}: the longest segments of the joints' certified optima take "
        f"{exact['seconds']:.4f} s, and the printed {p['total']} s is {above(p['seconds'], exact['seconds'])} "
        "against them."
    )
    if not solved:
        return text + f" MIPSO finds no motion of every joint in {data['runs']} runs."
    return (
        text + f" By MIPSO they take {_range([m['seconds'] for m in solved])} s; "
        f"{sum(m['keeps'] for m in solved)} of {data['runs']} motions keep the limits. Slowed down until they "
        f"keep them, they take {_range(_honest(solved))} s."
    )


def _together(data: dict[str, Any]) -> str:
    """What the printed motion does to the limits that its own joints were planned under."""
    motion, optimum = data["printed_if_fitted"], data["rules"][FITTED]["least"]["optimum"]
    if motion["keeps"]:
        return f"The printed motion keeps the limits that fit, too ({motion['most']})."
    slowed = motion["seconds"] * motion["stretch"]
    return (
        f"The printed motion breaks the limits that fit ({motion['most']}): the rule lengthens a segment and "
        f"not its neighbours. Slowed down until it keeps them, it takes {slowed:.4f} s; the certified optimum "
        f"of all joints together takes {optimum:.4f} s there."
    )


TABLE_9 = Item(
    "Table 9",
    "times of every joint by MIPSO, and the longest per segment",
    make_table_9,
    show_table_9,
    "Each joint alone, with 50 particles and 50 iterations. The paper prints one run; several are made here. "
    "The rule is run under Table 6 and under the limits of acceleration that fit the printed times. The search "
    "box is not printed: one of 3 equal plans is taken; the other reading is the range of the printed times.",
    cost=15.0,
)
