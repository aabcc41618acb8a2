"""Lu 2024, eq. 17 and 22: the constants b and s of the whales, which the paper does not print."""

from __future__ import annotations

from typing import Any

from compare.papers.item import Item, Shown, Table
from compare.papers.lu_2024.plan import between, losses, plan, shared, solved
from compare.papers.words import listed, percent
from compare.statistics.medians import gain_over, median_of
from compare.studies.readings import READINGS

RUNS = {False: 6, True: 50}
QUESTIONS = ("Lu 2024, eq. 17: b", "Lu 2024, eq. 22: s")


def make_constants(full: bool) -> dict[str, Any]:
    """Run each reading of b and s on the task of Fig. 5; the first one is the default of both."""
    found: dict[str, Any] = {}
    objective = shared("b-spline-5")
    for question in QUESTIONS:
        for value, (swarm, changed) in READINGS[question].items():
            if changed or not found:
                name = f"{question[-1]} = {value}" if changed else "b = 1, s = 1"
                found[name] = plan(
                    objective, objective.problem.n_segments, swarm, RUNS[full], **changed
                )
                del found[name]["descent"]
    return found


def show_constants(data: dict[str, Any]) -> Shown:
    """Show the ends, and which readings differ from the default."""
    default, *others = data
    level = 1.0 - 0.05 / len(others)
    gains = {
        name: gain_over(losses(data[name]), losses(data[default]), seed=0, level=level)
        for name in others
    }
    rows = [
        [name, solved(found), between(median_of(losses(found))),
         f"{percent(gains[name].low)} to {percent(gains[name].high)}" if name in gains else ""]
        for name, found in data.items()
    ]  # fmt: skip
    runs = len(data[default]["seconds"])
    header = ["constants", "solved", "median [s]", "gain over the first row"]
    caption = (
        f"{runs} runs each, on the waypoints of the case z1, budget and box as printed; the other constant "
        "is 1. In brackets the 95 % interval of the median. Last column: by how much the median is below "
        f"that of the first row; the {len(others)} intervals hold together at 95 % (bootstrap, Bonferroni)."
    )
    better = [name for name, gain in gains.items() if gain.low > 0.0]
    worse = [name for name, gain in gains.items() if gain.high < 0.0]
    remarks = [
        f"Shown by {runs} runs to be better than the default: {listed(better)}; to be worse: "
        f"{listed(worse)}. For "
        f"{len(others) - len(better) - len(worse)} of the {len(others)} other readings they decide nothing.",
        "The study of readings (timebound readings) runs the same values on other tasks with the exact "
        "stretch.",
    ]
    return Shown([Table(header, rows, caption, (1, 2, 3))], remarks, ())


EQUATIONS_17_22 = Item(
    "Eqs 17, 22",
    "constants b of the spiral and s of the inertia",
    make_constants,
    show_constants,
    "The paper prints no b, and of s only that it is greater than -1. Both are taken as 1: b as in "
    "Mirjalili and "
    "Lewis 2016, s because it is the plainest choice.",
    cost=9.0,
)
