"""Paper 000, its times: Table 8 and Fig. 10 (joint 1 by several swarms), Tables 9 and 10."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, replace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare import table8
from compare.audit.minima import impossible, with_limits
from compare.audit.motions import Motion
from compare.audit.paper import Paper, Row
from compare.audit.paper_file import load_papers
from compare.grade import Graded, durations_of
from compare.papers.descent import descent, draw_descent
from compare.papers.item import Item, Shown, Table
from compare.papers.measure import judged, least, listed, summary, trials
from compare.papers.printed import tables
from compare.papers.printed_motions import printed
from compare.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, styled
from compare.suite import Budget
from formulations import Problem, load, longest_segment
from formulations.problem import Array

TABLE_6, IN_FORCE = table8.LIMITS  # names of the two readings of joint 1's acceleration limit
SWARM = "mipso"
_HALF = 5e-5  # s, half a unit of Table 8's last digit


def paper() -> Paper:
    """Paper 000 as data."""
    return load_papers("sr4c")[0]


def budget() -> Budget:
    """Table 7."""
    settings = tables("sr4c")["swarm"]
    return Budget(settings["particles"], settings["iterations"])


def seconds(value: float) -> str:
    """A time, to the papers' digits."""
    return f"{value:.4f}"


def above(value: float, least: float) -> str:
    """By how much a time is above another one."""
    return f"{round(100.0 * (value / least - 1.0), 2) + 0.0:+.2f} %"  # no -0.00


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


# --- Tables 9 and 10 ------------------------------------------------------------------------------


def make_table_9(full: bool) -> dict[str, Any]:
    """Each joint alone: printed, repeated, certified; and the rule of the longest time."""
    problem, table = load("sr4c"), paper().rows
    runs = 30 if full else 10
    joints, found = [], []
    for row in (r for r in table if r.where.startswith("Table 9")):
        assert row.joint is not None
        one = problem.joint(row.joint)
        found.append(trials(one, SWARM, budget(), runs))
        joints.append({
            "printed": printed(paper(), row), "own": _own_limits(row),
            "trials": summary(found[-1]), "least": least(one),
        })  # fmt: skip
    whole = next(row for row in table if row.joint is None)
    other = [trials(problem.joint(j), "mipso-printed", budget(), runs) for j in range(problem.dof)]
    return {
        "runs": runs,
        "joints": joints,
        "printed": printed(paper(), whole),
        "rule": [_rule(problem, group) for group in zip(*found, strict=True)],
        "rule_printed": [_rule(problem, group) for group in zip(*other, strict=True)],
        "least": least(problem),
        "joint_1": least(table8.joint_1(IN_FORCE)),
    }


def _own_limits(row: Row) -> dict[str, Any]:
    """The least two-digit limits that a printed vector keeps, and the optimum under them."""
    motion = Motion.of(paper(), row)
    velocity, acceleration = (float(np.degrees(motion.rounded[k, 0])) for k in (0, 1))
    found = least(with_limits(motion.problem, motion.rounded))
    return {"velocity": velocity, "acceleration": acceleration, **found}


def _rule(problem: Problem, found: Sequence[Graded]) -> dict[str, Any]:
    """The longest time per segment over the joints of one seed, judged; None where a run failed."""
    vectors = [durations_of(g.row) for g in found]
    if not all(v.size for v in vectors):
        return {"durations": None, "seconds": None, "keeps": False, "stretch": None}
    return judged(problem, longest_segment(problem, vectors).claimed)


def _honest(rule: Sequence[dict[str, Any]]) -> Array:
    return np.array([r["seconds"] * max(r["stretch"], 1.0) for r in rule if r["seconds"] is not None])


def show_table_9(data: dict[str, Any]) -> Shown:
    """Joint by joint, the rule, and which limits were in force."""
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
        "that the printed vector uses most. Certified optimum: nothing is faster by more than 1e-5 of it; "
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
    """The median claim of all seeds (the lower of two)."""
    solved = sorted((r for r in rule if r["seconds"] is not None), key=lambda r: float(r["seconds"]))
    return solved[(len(solved) - 1) // 2]


def _remarks_9(data: dict[str, Any]) -> list[str]:
    slack = [
        f"{i} ({j['own']['acceleration']:.3g} deg/s²)"
        for i, j in enumerate(data["joints"], start=1)
        if j["printed"]["stretch"] < 0.99
    ]
    near = [
        str(i) for i, j in enumerate(data["joints"], start=1)
        if abs(j["printed"]["seconds"] / j["least"]["bound"] - 1.0) < 1e-3
    ]  # fmt: skip
    p, optimum = data["printed"], data["least"]["optimum"]
    keeping = sum(bool(r["keeps"]) for r in data["rule"])
    claims, honest = _claims(data["rule"]), _honest(data["rule"])
    other, other_honest = _claims(data["rule_printed"]), _honest(data["rule_printed"])
    first = data["joints"][0]
    return [
        f"Joints {listed(near)}: the printed totals lie within 0.1 % of the certified optimum of Table 6.",
        f"Joints {listed(slack)} leave their limits unused: other limits of acceleration than Table 6's were "
        "in force. Joint 1 under "
        f"{table8.LIMITS[IN_FORCE][1]:.0f} deg/s² cannot be faster than {data['joint_1']['bound']:.4f} s, and "
        f"under Table 6 not than {first['least']['bound']:.4f} s; printed: {first['printed']['total']} s.",
        f"The rule's motion as printed, {p['total']} s, keeps Table 6: {p['keeps']} ({p['most']}); it is "
        f"{above(p['seconds'], optimum)} against the certified optimum of all joints together, "
        f"{optimum:.4f} s.",
        f"Reproduced under Table 6, the rule claims {claims[0]:.4f} to {claims[-1]:.4f} s; {keeping} of "
        f"{data['runs']} motions keep the limits, and slowed down until they do they take "
        f"{honest.min():.4f} to {honest.max():.4f} s.",
        f"The other reading, eq. 15 and 16 by their letter: {other[0]:.4f} to {other[-1]:.4f} s claimed, "
        f"{other_honest.min():.4f} to {other_honest.max():.4f} s once they keep the limits.",
    ]


def with_speed(velocity: float, acceleration: float) -> Problem:
    """Joint 1 of sr4c alone under a velocity [deg/s] and an acceleration limit [deg/s²]."""
    alone = load("sr4c").joint(0)
    speed, rate = np.radians([[velocity], [acceleration]])
    return replace(alone, limits=replace(alone.limits, velocity=speed, acceleration=rate))


def table_10_rows() -> list[tuple[float, Row]]:
    """Rows of Table 10 with their velocity limit [deg/s]."""
    rows = [row for row in paper().rows if row.where.startswith("Table 10")]
    return [(float(np.degrees(paper().stated[str(row.limits)].derivatives[0, 0])), row) for row in rows]


def make_table_10(full: bool) -> dict[str, Any]:
    """Joint 1 under three velocity limits and both acceleration limits."""
    runs = 30 if full else 10
    found = []
    for velocity, row in table_10_rows():
        entry: dict[str, Any] = {"velocity": velocity, "printed": printed(paper(), row), "limits": []}
        for name in (TABLE_6, IN_FORCE):
            problem = with_speed(velocity, table8.LIMITS[name][1])
            entry["limits"].append({
                "acceleration": table8.LIMITS[name][1], "least": least(problem),
                "trials": summary(trials(problem, SWARM, budget(), runs)),
                "printed": judged(problem, [float(t) for t in entry["printed"]["times"]]),
            })  # fmt: skip
        found.append(entry)
    return {"runs": runs, "rows": found}


def show_table_10(data: dict[str, Any]) -> Shown:
    """Printed beside both readings of the acceleration limit."""
    header = [
        "velocity limit [deg/s]",
        "",
        "t1",
        "t2",
        "t3",
        "total",
        "above the optimum",
        "certified optimum",
    ]
    lines, best = [], []
    for row in data["rows"]:
        p = row["printed"]
        for index, limit in enumerate(row["limits"]):
            optimum, t = limit["least"]["optimum"], limit["trials"]
            name = f"{limit['acceleration']:.0f} deg/s²"
            lines.append([f"{row['velocity']:g}", f"printed, against {name}", *p["times"], p["total"],
                          above(p["seconds"], optimum), seconds(optimum)])  # fmt: skip
            lines.append([f"{row['velocity']:g}", f"reproduced, {name}", *map(seconds, t["durations"]),
                          seconds(t["median"]), above(t["median"], optimum), seconds(optimum)])  # fmt: skip
            if index:
                best.append((row, limit))
    caption = f"Joint 1 alone, times [s]; reproduced: median of {data['runs']} seeds of MIPSO."
    remarks = []
    for row, limit in best:
        p, other = row["printed"], row["limits"][0]
        near, far = (above(p["seconds"], one["least"]["optimum"]) for one in (limit, other))
        remarks.append(
            f"{row['velocity']:g} deg/s: printed {p['total']} s, {near} against the certified optimum under "
            f"{limit['acceleration']:.0f} deg/s², {far} against that under the "
            f"{other['acceleration']:.0f} deg/s² of Table 6. It keeps those limits: {p['keeps']}."
        )
    slowest = data["rows"][-1]
    remarks.append(
        f"From {slowest['velocity']:g} deg/s on the speed no longer matters under "
        f"{slowest['limits'][1]['acceleration']:.0f} deg/s²: the optimum is "
        f"{slowest['limits'][1]['least']['optimum']:.4f} s, as in Table 9."
    )
    return Shown([Table(header, lines, caption, (0, 2, 3, 4, 5, 6, 7))], remarks)


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
    Item(
        "Table 9",
        "times of every joint by MIPSO, and the longest per segment",
        make_table_9,
        show_table_9,
        "Each joint alone under Table 6, 50 particles and 50 iterations; one run is printed, several are "
        "made again.",
        cost=15.0,
    ),
    Item(
        "Table 10",
        "joint 1 under three velocity limits",
        make_table_10,
        show_table_10,
        "The acceleration limit is not named: Table 6's, and the one in force elsewhere, are read.",
        cost=6.0,
    ),
)
