"""Li 2022, Table 3: every joint by MPSO, and the rule of the longest time per segment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.paper import PrintedTimes, settings, with_limits
from compare.audit.paper.digits import values
from compare.benchmark.grade import Graded, durations_of
from compare.benchmark.protocol import Budget
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.li_2022.paper import READINGS, SWARMS, budget, certified, paper, rows, whole_optimum
from compare.papers.measure import judged, summary, trials
from compare.papers.verdicts import (
    AT_A_LIMIT,
    BEST,
    Reproduction,
    agrees,
    held,
    more_often,
    pairs_won,
    yes_no,
)
from compare.papers.words import listed
from formulations import Problem, load, longest_segment
from formulations.problem.arrays import Array


def make_table_3(full: bool) -> dict[str, Any]:
    """Judge each joint as printed, repeat it with every reading, and certify its optimum."""
    problem = load("bagging")
    single, whole = rows()
    runs, (least, most) = 30 if full else 10, settings("bagging")["box"]["seconds"]
    joints: list[dict[str, Any]] = []
    found: dict[str, list[list[Graded]]] = {reading: [] for reading in READINGS}
    for row in single:
        assert row.joint is not None
        one, motion = problem.joint(row.joint), PrintedMotion.of(paper(), row)
        for swarm in SWARMS:
            found[swarm].append(trials(one, swarm, budget(), runs))
        found["boxed"].append(trials(one, "mpso", budget(), runs, (least, most)))
        longer = Budget(budget().population, one.n_segments * budget().iterations)
        for reading, size in (("six", budget()), ("six, all iterations", longer)):
            found[reading].append(trials(one, "mpso", size, runs, split=True))
        joints.append({
            "joint": row.joint + 1,
            "times": [str(time) for time in row.times],
            "printed": judged(one, values(row.times)),
            "speed": float(motion.implied[0, 0]),
            "own": certified(with_limits(motion.problem, motion.implied)),
            "least": certified(one),
            "trials": {reading: summary(groups[-1]) for reading, groups in found.items()},
        })  # fmt: skip
    vectors = {s: [[durations_of(g.row) for g in group] for group in found[s]] for s in found}
    return {
        "runs": runs,
        "limit": float(problem.limits.velocity[0]),
        "joints": joints,
        "starred": {"times": [str(t) for t in whole.times], "total": str(whole.total),
                    **judged(problem, values(whole.times)), "speed": float(_speeds(whole).max())},
        "rule": {s: [_rule(problem, group) for group in zip(*vectors[s], strict=True)] for s in vectors},
        "least": whole_optimum(),
        "first_plan": sum(settings("bagging")["first_plan"]["times"]),
    }  # fmt: skip


def _speeds(row: PrintedTimes) -> Array:
    """Peak speed of each joint that moves in a printed motion of all joints [rad/s]."""
    implied = PrintedMotion.of(paper(), row).implied[0]
    return np.asarray(implied[np.isfinite(implied)])


def _rule(problem: Problem, vectors: tuple[Array, ...]) -> dict[str, Any] | None:
    """Judge the longest time per segment over the joints of one seed; None if a run failed."""
    if not all(v.size for v in vectors):
        return None
    return judged(problem, longest_segment(problem, list(vectors)).claimed)


def show_table_3(data: dict[str, Any]) -> Shown:
    """Show joint by joint, the speeds behind the printed times, and the rule."""
    header = ["joint", "", *(f"Δt{k}" for k in range(1, 7)), "total"]
    lines = []
    for j in data["joints"]:
        number = str(j["joint"])
        lines.append([number, "printed", *j["times"], f"{j['printed']['seconds']:.4f}"])
        for swarm, title in READINGS.items():
            t = j["trials"][swarm]
            cells = (
                ["none"] * 7
                if t["durations"] is None
                else [f"{x:.4f}" for x in (*t["durations"], t["median"])]
            )
            lines.append([number, f"reproduced, {title}", *cells])
        cells = [f"{x:.4f}" for x in (*j["least"]["durations"], j["least"]["optimum"])]
        lines.append([number, "certified optimum", *cells])
    s, least = data["starred"], data["least"]
    lines.append(["longest", "printed (starred)", *s["times"], s["total"]])
    for swarm, title in READINGS.items():
        rule = _median(data["rule"][swarm])
        cells = (
            ["none"] * 7
            if rule is None
            else [f"{x:.4f}" for x in (*rule["durations"], rule["seconds"])]
        )
        lines.append(["longest", f"reproduced, {title}", *cells])
    cells = [f"{x:.4f}" for x in (*least["durations"], least["optimum"])]
    lines.append(["all together", "certified optimum", *cells])
    caption = (
        f"Times [s]; reproduced: median of {data['runs']} seeds under {data['limit']:.4f} rad/s. Certified "
        "optimum: nothing is faster by more than 1e-4 of it."
    )
    own = Table(
        ["joint", "peak speed [rad/s]", "of pi rad/s", "printed total [s]", "optimum there [s]", "ratio"],
        [[str(j["joint"]), f"{j['speed']:.4f}", f"{100 * j['speed'] / data['limit']:.1f} %",
          f"{j['printed']['seconds']:.4f}", f"{j['own']['optimum']:.4f}",
          f"{j['printed']['seconds'] / j['own']['optimum']:.2f}"] for j in data["joints"]],
        "What each printed vector would need as its velocity limit, and the certified optimum under it.",
        range(1, 6),
    )  # fmt: skip
    return Shown(
        [Table(header, lines, caption, range(2, 9)), own],
        [*_remarks_3(data), _populations(data)],
        _verdicts_3(data),
    )


def _verdicts_3(data: dict[str, Any]) -> list[ItemVerdict]:
    return [
        ItemVerdict("the sum of the starred times", held(_adds_up(data["starred"]))),
        *(
            ItemVerdict(f"the starred total by the rule, {title}", _by_rule(data, reading))
            for reading, title in READINGS.items()
        ),
    ]


def _adds_up(starred: dict[str, Any]) -> bool:
    return abs(sum(map(float, starred["times"])) - float(starred["total"])) <= 5e-5


def _by_rule(data: dict[str, Any], reading: str) -> Reproduction:
    """Whether the printed total lies among those that the rule claims, over all seeds."""
    claims = [rule["seconds"] for rule in data["rule"][reading] if rule is not None]
    return held(bool(claims) and min(claims) <= float(data["starred"]["total"]) <= max(claims))


def _median(rule: Sequence[dict[str, Any] | None]) -> dict[str, Any] | None:
    solved = sorted((r for r in rule if r is not None), key=lambda r: float(r["seconds"]))
    return solved[(len(solved) - 1) // 2] if solved else None


def _remarks_3(data: dict[str, Any]) -> list[str]:
    limit, s, least = data["limit"], data["starred"], data["least"]
    near = [str(j["joint"]) for j in data["joints"] if abs(j["speed"] / limit - 1.0) < AT_A_LIMIT]
    over = [
        f"{j['joint']} ({j['speed']:.2f} rad/s)"
        for j in data["joints"]
        if j["speed"] > limit * (1.0 + AT_A_LIMIT)
    ]
    ratios = [j["printed"]["seconds"] / j["own"]["optimum"] for j in data["joints"]]
    best = sum(ratio <= 1.0 + BEST for ratio in ratios)
    times = [float(t) for t in s["times"]]
    saved = 100 * (1 - sum(times) / data["first_plan"])
    remarks = [
        f"The velocity limit is not printed. Joints whose printed vector reaches pi rad/s within 1 %: "
        f"{listed(near)}; joints whose vector goes beyond it: {listed(over)}."
        + (" No one limit fits them all." if near and over else ""),
        f"{best} of {len(ratios)} printed vectors are at the certified optimum under their own peak speed, "
        f"whatever the limit was. They take {min(ratios):.2f} to {max(ratios):.2f} times that optimum.",
        f"The starred times add up to {sum(times):.4f} s, printed {s['total']} s, {agrees(_adds_up(s))}: "
        f"{saved:.2f} % less than {data['first_plan']} s. Their motion peaks at {s['speed']:.4f} rad/s and "
        f"keeps pi rad/s: {yes_no(s['keeps'])}. The optimum under pi rad/s, without a limit on acceleration, "
        "takes "
        f"{least['optimum']:.4f} s (certified for the family: not less than {least['bound']:.4f} s).",
    ]
    for swarm, title in READINGS.items():
        solved = [r for r in data["rule"][swarm] if r is not None]
        if not solved:
            remarks.append(
                f"With {title} the starred total is {_by_rule(data, swarm).inside}: none of {data['runs']} "
                "seeds found a feasible motion of every joint."
            )
            continue
        claims = sorted(r["seconds"] for r in solved)
        honest = sorted(r["seconds"] * max(r["stretch"], 1.0) for r in solved)
        kept = sum(r["keeps"] for r in solved)
        outcome = _by_rule(data, swarm)
        remarks.append(
            f"With {title} the starred total is {outcome.inside}: the rule claims {claims[0]:.4f} to "
            f"{claims[-1]:.4f} s; {kept} of {len(solved)} motions keep the limits. Slowed down until they keep "
            f"them, they take {honest[0]:.4f} to {honest[-1]:.4f} s. The printed {s['total']} s "
            f"{'lies' if outcome is Reproduction.REPRODUCED else 'does not lie'} within the range of the "
            "claims."
        )
    return remarks


def _populations(data: dict[str, Any]) -> str:
    """Whether a population per segment ends lower than one population of vectors (sec. 3, step 1)."""
    told = []
    for reading, size in (("six", "evaluations"), ("six, all iterations", "iterations")):
        pairs = [
            (j["trials"][reading]["by_seed"], j["trials"]["mpso"]["by_seed"]) for j in data["joints"]
        ]
        n, won = sum(len(one) for _, one in pairs), sum(pairs_won(*pair) for pair in pairs)
        solved = [s for six, _ in pairs for s in six if s is not None]
        told.append(
            f"with as many {size} in {won:g} of {n} pairs of runs, {more_often(won / n, n)} "
            f"({len(solved)} of {n} found a feasible motion)"
        )
    return (
        "Sec. 3, step 1, both with factors as printed and each joint alone: six populations end lower than one "
        f"population of vectors {'; '.join(told)}."
    )


TABLE_3 = Item(
    "Table 3",
    "times of every joint by MPSO, and the longest per segment",
    make_table_3,
    show_table_3,
    "The paper prints neither the velocity limit nor the search box nor the updates of eq. 12-13: pi rad/s, a "
    "box of 3 equal plans and the standard updates are taken. Other readings: the factors, 0.05 falling to "
    "0.02, times ten; a box from 0.1 s, the least time of the table, to 2 s, the first plan. Step 1 of "
    "sec. 3 draws six populations, one per segment; step 4 takes the i-th particles of all six as one vector, "
    "which makes them one population of vectors: so it is read. In the other reading each population has its "
    "own bests and is judged beside the bests of the five others; it has as many evaluations, or as many "
    "iterations, which takes six times the evaluations. 20 particles, 200 iterations.",
    cost=30.0,
)
