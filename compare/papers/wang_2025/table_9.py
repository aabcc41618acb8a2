"""Wang 2025, Table 9: every joint by MIPSO, and the rule of the longest time per segment (sec. 4.2.2)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.paper import PrintedTimes, with_limits
from compare.benchmark.grade import Graded, durations_of
from compare.papers.item import Item, Shown, Table
from compare.papers.measure import judged, judged_row, least, summary, trials
from compare.papers.verdicts import BEST, UNUSED
from compare.papers.wang_2025.joint_1 import IN_FORCE, LIMITS, joint_1
from compare.papers.wang_2025.paper import SWARM, budget, paper
from compare.papers.words import above, listed, seconds
from formulations import Problem, load, longest_segment
from formulations.problem.arrays import Array


def make_table_9(full: bool) -> dict[str, Any]:
    """Judge, repeat and certify each joint alone; apply the rule of the longest time."""
    problem, table = load("sr4c"), paper().rows
    runs = 30 if full else 10
    joints, found = [], []
    for row in (r for r in table if r.where.startswith("Table 9")):
        assert row.joint is not None
        one = problem.joint(row.joint)
        found.append(trials(one, SWARM, budget(), runs))
        joints.append({
            "printed": judged_row(paper(), row), "own": _own_limits(row),
            "trials": summary(found[-1]), "least": least(one),
        })  # fmt: skip
    whole = next(row for row in table if row.joint is None)
    other = [trials(problem.joint(j), "mipso-printed", budget(), runs) for j in range(problem.dof)]
    return {
        "runs": runs,
        "joints": joints,
        "printed": judged_row(paper(), whole),
        "rule": [_rule(problem, group) for group in zip(*found, strict=True)],
        "rule_printed": [_rule(problem, group) for group in zip(*other, strict=True)],
        "least": least(problem),
        "joint_1": least(joint_1(IN_FORCE)),
    }


def _own_limits(row: PrintedTimes) -> dict[str, Any]:
    """Lowest limits of two digits that a printed vector keeps, and the optimum under them."""
    motion = PrintedMotion.of(paper(), row)
    velocity, acceleration = (float(np.degrees(motion.rounded[k, 0])) for k in (0, 1))
    found = least(with_limits(motion.problem, motion.rounded))
    return {"velocity": velocity, "acceleration": acceleration, **found}


def _rule(problem: Problem, found: Sequence[Graded]) -> dict[str, Any]:
    """Judge the longest time per segment over the joints of one seed."""
    vectors = [durations_of(g.row) for g in found]
    if not all(v.size for v in vectors):
        return {"durations": None, "seconds": None, "keeps": False, "stretch": None}
    return judged(problem, longest_segment(problem, vectors).claimed)


def _honest(rule: Sequence[dict[str, Any]]) -> Array:
    return np.array([r["seconds"] * max(r["stretch"], 1.0) for r in rule if r["seconds"] is not None])


def show_table_9(data: dict[str, Any]) -> Shown:
    """Show every joint, the rule, and the limits that were in force."""
    header = ["joint", "t1", "t2", "t3", "total, printed", "uses", "t1", "t2", "t3", "total, reproduced",
              "best", "certified optimum"]  # fmt: skip
    lines = []
    for number, joint in enumerate(data["joints"], start=1):
        p, t = joint["printed"], joint["trials"]
        lines.append([str(number), *p["times"], str(p["total"]), p["most"].replace(" of joint 1", ""),
                      *map(seconds, t["durations"]), seconds(t["median"]), seconds(t["seconds"][0]),
                      seconds(joint["least"]["optimum"])])  # fmt: skip
    p, rule = data["printed"], _median(data["rule"])
    lines.append(["longest", *p["times"], str(p["total"]), p["most"], *map(seconds, rule["durations"]),
                  seconds(rule["seconds"]), seconds(min(_claims(data["rule"]))),
                  seconds(data["least"]["optimum"])])  # fmt: skip
    caption = (
        f"Times [s]; reproduced: median of {data['runs']} seeds and the best total. Uses: the limit of Table 6 "
        "that the printed vector uses most. Certified optimum: nothing is faster by more than 1e-6 of it; "
        "each joint alone, in the last line all joints together."
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
    return Shown([Table(header, lines, caption, right), own], _remarks_9(data))


def _claims(rule: Sequence[dict[str, Any]]) -> list[float]:
    return sorted(r["seconds"] for r in rule if r["seconds"] is not None)


def _median(rule: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Median claim of all seeds (the lower one of two)."""
    solved = sorted((r for r in rule if r["seconds"] is not None), key=lambda r: float(r["seconds"]))
    return solved[(len(solved) - 1) // 2]


def _remarks_9(data: dict[str, Any]) -> list[str]:
    unused = [
        f"{i} ({j['own']['acceleration']:.3g} deg/s²)"
        for i, j in enumerate(data["joints"], start=1)
        if j["printed"]["stretch"] < 1.0 - UNUSED
    ]
    near = [
        str(i) for i, j in enumerate(data["joints"], start=1)
        if abs(j["printed"]["seconds"] / j["least"]["bound"] - 1.0) < BEST
    ]  # fmt: skip
    p, optimum = data["printed"], data["least"]["optimum"]
    keeping = sum(bool(r["keeps"]) for r in data["rule"])
    claims, honest = _claims(data["rule"]), _honest(data["rule"])
    other, other_honest = _claims(data["rule_printed"]), _honest(data["rule_printed"])
    first = data["joints"][0]
    return [
        f"Joints whose printed total lies within 0.1 % of the certified optimum under Table 6: {listed(near)}.",
        f"Joints that leave their limits unused: {listed(unused)}."
        + (" Other limits of acceleration than those of Table 6 were in force there." if unused else "")
        + f" The printed total of joint 1 is {first['printed']['total']} s. Under "
        f"{LIMITS[IN_FORCE][1]:.0f} deg/s² joint 1 cannot be faster than {data['joint_1']['bound']:.4f} s, "
        f"under Table 6 not faster than {first['least']['bound']:.4f} s.",
        f"The printed motion of the rule takes {p['total']} s and keeps Table 6: {p['keeps']} "
        f"({p['most']}). It "
        f"is {above(p['seconds'], optimum)} against the certified optimum of all joints together, "
        f"{optimum:.4f} s.",
        f"Reproduced under Table 6, the rule claims {claims[0]:.4f} to {claims[-1]:.4f} s; {keeping} of "
        f"{data['runs']} motions keep the limits. Slowed down until they keep them, they take "
        f"{honest.min():.4f} to {honest.max():.4f} s.",
        f"The other reading takes eq. 15 and 16 as they are printed: it claims {other[0]:.4f} to "
        f"{other[-1]:.4f} s, and {other_honest.min():.4f} to {other_honest.max():.4f} s once the motions keep "
        "the limits.",
    ]


TABLE_9 = Item(
    "Table 9",
    "times of every joint by MIPSO, and the longest per segment",
    make_table_9,
    show_table_9,
    "Each joint alone under Table 6, with 50 particles and 50 iterations. The paper prints one run; several "
    "are made here.",
    cost=15.0,
)
