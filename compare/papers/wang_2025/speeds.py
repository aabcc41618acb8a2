"""Paper 000, joint 1 under three velocity limits: Table 10 and Figs 12-14."""

from __future__ import annotations

from typing import Any

from compare.audit.printed import values
from compare.papers.item import Item, Shown, Table
from compare.papers.measure import judged, least, summary, trials
from compare.papers.panels import Curve, panels
from compare.papers.printed_motions import printed
from compare.papers.wang_2025 import table_8 as table8
from compare.papers.wang_2025.paper import (
    IN_FORCE,
    SWARM,
    TABLE_6,
    above,
    budget,
    paper,
    peaks,
    seconds,
    spline,
    table_10_rows,
    with_speed,
)
from compare.report.style import BLUE, GREEN, VERMILION
from formulations import load

# --- Table 10 -------------------------------------------------------------------------------------


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


# --- Figs 12-14 -----------------------------------------------------------------------------------


def make_speeds(full: bool) -> dict[str, Any]:
    """Printed vectors and certified optima of joint 1 under each speed limit."""
    rows = []
    for velocity, row in table_10_rows():
        motions = {"printed": values(row.times).tolist()}
        entry: dict[str, Any] = {"velocity": velocity, "keeps": printed(paper(), row)["keeps"]}
        for name in (IN_FORCE, TABLE_6):
            problem = with_speed(velocity, table8.LIMITS[name][1])
            motions[name] = least(problem)["durations"]
        entry["motions"] = {
            name: {
                **judged(with_speed(velocity, table8.LIMITS[TABLE_6][1]), times),
                "peaks": peaks(spline(load("sr4c").joint(0), times))[:, 0].tolist(),
            }
            for name, times in motions.items()
        }
        rows.append(entry)
    return {"rows": rows}


def show_speeds(data: dict[str, Any]) -> Shown:
    """A column per speed limit."""
    accelerations = {name: table8.LIMITS[name][1] for name in (IN_FORCE, TABLE_6)}
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
            problem = with_speed(row["velocity"], acceleration)
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
            f"{rate:.2f} deg/s². It keeps the limits: {row['keeps']}; the acceleration that Table 6 allows is "
            f"used to {100 * rate / accelerations[TABLE_6]:.0f} %."
        )
    table = Table(
        ["limit [deg/s]", "motion of joint 1", "time [s]", "peak speed [deg/s]", "peak acceleration [deg/s²]"],
        rows, "", (0, 2, 3, 4),
    )  # fmt: skip
    return Shown([panels(columns), table], remarks)


ITEMS = (
    Item(
        "Table 10",
        "joint 1 under three velocity limits",
        make_table_10,
        show_table_10,
        "The acceleration limit is not named: Table 6's, and the one in force elsewhere, are read.",
        cost=6.0,
    ),
    Item(
        "Figs 12-14",
        "joint 1 under three velocity limits",
        make_speeds,
        show_speeds,
        "The printed vectors of Table 10 put back into the spline. The acceleration limit is not named: the "
        "optimum under Table 6's and under the one in force elsewhere stand beside them.",
        cost=5.0,
    ),
)
