"""Wang 2025, Table 10 and Figs 12 to 14: joint 1 under three velocity limits."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.audit.paper import PrintedTimes
from compare.audit.paper.digits import values
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.measure import judged, judged_row, least, peaks, spline, summary, trials
from compare.papers.pictures.panels import Curve, panels
from compare.papers.verdicts import BEST, Reproduction, held, same_times
from compare.papers.wang_2025.joint_1 import IN_FORCE, LIMITS, TABLE_6, under
from compare.papers.wang_2025.paper import PRINTED_TIMES, SWARM, boxes, budget, in_words, paper
from compare.papers.words import above, seconds
from compare.report.style import BLUE, GREEN, VERMILION
from formulations import load


def table_10_rows() -> list[tuple[float, PrintedTimes]]:
    """Rows of Table 10 with their velocity limit [deg/s]."""
    rows = [row for row in paper().rows if row.where.startswith("Table 10")]
    return [(float(np.degrees(paper().stated[str(row.limits)].derivatives[0, 0])), row) for row in rows]


# --- Table 10 -------------------------------------------------------------------------------------


def make_table_10(full: bool) -> dict[str, Any]:
    """Run joint 1 under three velocity limits and both acceleration limits."""
    runs = 30 if full else 10
    found = []
    for velocity, row in table_10_rows():
        entry: dict[str, Any] = {
            "velocity": velocity,
            "printed": judged_row(paper(), row),
            "limits": [],
        }
        for name in (TABLE_6, IN_FORCE):
            problem = under(velocity, LIMITS[name][1])
            entry["limits"].append({
                "acceleration": LIMITS[name][1], "least": least(problem),
                "trials": summary(trials(problem, SWARM, budget(), runs)),
                "boxed": summary(trials(problem, SWARM, budget(), runs, boxes()[PRINTED_TIMES])),
                "printed": judged(problem, [float(t) for t in entry["printed"]["times"]]),
            })  # fmt: skip
        found.append(entry)
    fastest = least(under(LIMITS[IN_FORCE][0], LIMITS[IN_FORCE][1]))["optimum"]
    return {
        "runs": runs,
        "box": list(boxes()[PRINTED_TIMES]),
        "rows": found,
        "at_table_6_speed": fastest,
    }


def show_table_10(data: dict[str, Any]) -> Shown:
    """Show the printed rows beside both readings of the acceleration limit."""
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
            optimum = limit["least"]["optimum"]
            name = f"{limit['acceleration']:.0f} deg/s²"
            lines.append([f"{row['velocity']:g}", f"printed, against {name}", *p["times"], p["total"],
                          above(p["seconds"], optimum), seconds(optimum)])  # fmt: skip
            for box, t in (("", limit["trials"]), (", other box", limit["boxed"])):
                times = map(seconds, t["durations"] or [None] * 3)
                lines.append([f"{row['velocity']:g}", f"reproduced, {name}{box}", *times,
                              seconds(t["median"]), above(t["median"], optimum), seconds(optimum)])  # fmt: skip
            if index:
                best.append((row, limit))
    caption = (
        f"Joint 1 alone, times [s]; reproduced: median of {data['runs']} seeds of MIPSO. The "
        f"other box: {in_words(*data['box'])}."
    )
    remarks = []
    for row, limit in best:
        p, other = row["printed"], row["limits"][0]
        near, far = (above(p["seconds"], one["least"]["optimum"]) for one in (limit, other))
        remarks.append(
            f"{row['velocity']:g} deg/s: the printed {p['total']} s is {near} against the certified "
            "optimum under "
            f"{limit['acceleration']:.0f} deg/s², and {far} against the optimum under the "
            f"{other['acceleration']:.0f} deg/s² of Table 6. It keeps these limits: {p['keeps']}. By the "
            "median of MIPSO it is "
            + " and ".join(
                f"{_again(row, one).inside} under {one['acceleration']:.0f} deg/s²"
                for one in (limit, other)
            )
            + "."
        )
    remarks.append(_saturated(data))
    verdicts = [
        ItemVerdict(
            f"the time under {row['velocity']:g} deg/s, {one['acceleration']:.0f} deg/s²",
            _again(row, one),
        )
        for row in data["rows"]
        for one in row["limits"]
    ]
    return Shown([Table(header, lines, caption, (0, 2, 3, 4, 5, 6, 7))], remarks, verdicts)


def _again(row: dict[str, Any], limit: dict[str, Any]) -> Reproduction:
    """Judge a printed total by the median of MIPSO under one reading of the acceleration limit."""
    found = limit["trials"]["median"]
    return same_times([row["printed"]["seconds"]], [np.inf if found is None else found])


def _saturated(data: dict[str, Any]) -> str:
    """Whether a higher velocity limit would still shorten the optimum under the limit in force."""
    last, before = data["rows"][-1], data["rows"][-2]
    limit, slower = last["limits"][1], before["limits"][1]
    optimum = limit["least"]["optimum"]
    free = data["at_table_6_speed"]
    text = (
        f"Under {limit['acceleration']:.0f} deg/s² the optimum falls from {slower['least']['optimum']:.4f} "
        "s at "
        f"{before['velocity']:g} deg/s to {optimum:.4f} s at {last['velocity']:g} deg/s. "
    )
    if optimum <= free * (1.0 + BEST):
        return (
            text
            + f"A higher limit changes nothing: at {LIMITS[IN_FORCE][0]:g} deg/s it is {free:.4f} s."
        )
    return (
        text
        + f"A higher limit shortens it further: at {LIMITS[IN_FORCE][0]:g} deg/s it is {free:.4f} s."
    )


# --- Figs 12-14 -----------------------------------------------------------------------------------


def make_speeds(full: bool) -> dict[str, Any]:
    """Judge the printed vectors and the certified optima of joint 1 under each velocity limit."""
    rows = []
    for velocity, row in table_10_rows():
        motions = {"printed": values(row.times).tolist()}
        entry: dict[str, Any] = {"velocity": velocity, "keeps": judged_row(paper(), row)["keeps"]}
        for name in (IN_FORCE, TABLE_6):
            problem = under(velocity, LIMITS[name][1])
            motions[name] = least(problem)["durations"]
        entry["motions"] = {
            name: {
                **judged(under(velocity, LIMITS[TABLE_6][1]), times),
                "peaks": np.degrees(peaks(spline(load("sr4c").joint(0), times))[:, 0]).tolist(),
            }
            for name, times in motions.items()
        }
        rows.append(entry)
    return {"rows": rows}


def show_speeds(data: dict[str, Any]) -> Shown:
    """Show a column per velocity limit."""
    accelerations = {name: LIMITS[name][1] for name in (IN_FORCE, TABLE_6)}
    drawn = {
        "printed": ("printed in Table 10", (VERMILION, "-"), accelerations[TABLE_6]),
        IN_FORCE: (
            f"optimum, {accelerations[IN_FORCE]:.0f} deg/s²",
            (BLUE, "--"),
            accelerations[IN_FORCE],
        ),
        TABLE_6: (
            f"optimum, {accelerations[TABLE_6]:.0f} deg/s²",
            (GREEN, "-."),
            accelerations[TABLE_6],
        ),
    }
    columns = []
    rows, remarks = [], []
    for row in data["rows"]:
        curves = []
        for name, (label, style, acceleration) in drawn.items():
            problem = under(row["velocity"], acceleration)
            motion = row["motions"][name]
            curves.append(Curve(label, style, problem, spline(problem, motion["durations"])))
            speed, rate = motion["peaks"]
            rows.append(
                [
                    f"{row['velocity']:g}",
                    label,
                    seconds(motion["seconds"]),
                    f"{speed:.2f}",
                    f"{rate:.2f}",
                ]
            )
        columns.append((f"limit {row['velocity']:g} deg/s", curves))
        speed, rate = row["motions"]["printed"]["peaks"]
        remarks.append(
            f"Limit {row['velocity']:g} deg/s: the printed vector peaks at {speed:.2f} deg/s and "
            f"{rate:.2f} deg/s². It keeps the limits: {row['keeps']}. It uses "
            f"{100 * rate / accelerations[TABLE_6]:.0f} % of the acceleration that Table 6 allows."
        )
    table = Table(
        ["limit [deg/s]", "motion of joint 1", "time [s]", "peak speed [deg/s]", "peak acceleration [deg/s²]"],
        rows, "", (0, 2, 3, 4),
    )  # fmt: skip
    verdicts = [
        ItemVerdict(
            f"that the printed times keep {row['velocity']:g} deg/s and Table 6", held(_kept(row))
        )
        for row in data["rows"]
    ]
    return Shown([panels(columns), table], remarks, verdicts)


def _kept(row: dict[str, Any]) -> bool:
    return bool(row["keeps"] != "no")


TABLE_10 = Item(
    "Table 10",
    "joint 1 under three velocity limits",
    make_table_10,
    show_table_10,
    "The acceleration limit is not named: Table 6's, and the one in force elsewhere, are read. The search box "
    "is not printed: the other reading is the range of the times that Tables 9 and 10 print.",
    cost=6.0,
)
FIGURES_12_14 = Item(
    "Figs 12-14",
    "joint 1 under three velocity limits",
    make_speeds,
    show_speeds,
    "The printed vectors of Table 10 put back into the spline. The acceleration limit is not named: the "
    "optima under Table 6's limit and under the one in force elsewhere are added.",
    cost=5.0,
)
