"""``python -m compare.readings``: what a paper prints, what it can mean, and what the difference does.

Each reading of each formula that cannot be right, and each value of what a paper leaves open, on arm
problems in the stretched coding: median gap and share of seeds below 0.1 %.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.benchmark.grade import REACHED
from compare.benchmark.objective import Objective, search_box
from compare.benchmark.run import workers
from compare.commands import shared as commands
from compare.report.style import BLUE, GREY, ORANGE, styled
from compare.studies.study import collect, finish
from formulations import CASES, Problem, family_optimum, load
from metaheuristics import ALGORITHMS, minimise

# paper, question -> reading -> algorithm and what is changed; the first is the default
READINGS: dict[str, dict[str, tuple[str, dict[str, Any]]]] = {
    "000 eq. 15, 16: inertia, mutation": {
        "resolved": ("mipso", {}),
        "as printed": ("mipso-printed", {}),
    },
    "000 eq. 12: peak of the tent map": {
        "0.499": ("mipso", {}),
        "0.5 (collapses)": ("mipso", {"lam": 0.5}),
        "no map": ("mipso-pso1", {}),
    },
    "001 eq. 15, 16: factors": {
        "as printed": ("mpso", {}),
        "times ten": ("mpso-times-ten", {}),
    },
    "002 eq. 8, 10: sparrows": {
        "resolved": ("sparrow", {}),
        "as printed": ("sparrow-printed", {}),
    },
    "002: share of scouts": {
        "10 %": ("sparrow", {}),
        "20 %": ("sparrow", {"scouts": 0.2}),
    },
    "002: how the weights enter": {
        "each chooses": ("issa", {}),
        "blended": ("issa-blended", {}),
    },
    "002 eq. 14: threshold, share of the best": {
        "1e-3": ("issa", {}),
        "1e-2": ("issa", {"threshold": 1e-2}),
        "1e-4": ("issa", {"threshold": 1e-4}),
        "1e-6": ("issa", {"threshold": 1e-6}),
    },
    "002 eq. 13: window": {
        "5": ("issa", {}),
        "1": ("issa", {"window": 1}),
        "20": ("issa", {"window": 20}),
    },
    "003 eq. 16, 19, 21, 23: whales": {
        "resolved": ("whale-lu-2024", {}),
        "as printed": ("whale-lu-2024-printed", {}),
        "no weight (2016)": ("whale", {}),
    },
    "003 eq. 22: s": {
        "1": ("whale-lu-2024", {}),
        "-0.9": ("whale-lu-2024", {"s": -0.9}),
        "0": ("whale-lu-2024", {"s": 0.0}),
        "5": ("whale-lu-2024", {"s": 5.0}),
        "50": ("whale-lu-2024", {"s": 50.0}),
    },
    "004 eq. 7: else-branch": {
        "keeps its own": ("pso-zhang-2025", {}),
        "as printed": ("pso-zhang-2025-printed", {}),
        "no crossover": ("pso-zhang-2025", {"CR": 0.0}),
    },
    "004 eq. 6: alpha, beta": {
        "0.5, 0.5": ("pso-zhang-2025", {}),
        "0.9, 0.1": ("pso-zhang-2025", {"alpha": 0.9, "beta": 0.1}),
        "0.1, 0.9": ("pso-zhang-2025", {"alpha": 0.1, "beta": 0.9}),
        "0.9, 0.9": ("pso-zhang-2025", {"alpha": 0.9, "beta": 0.9}),
    },
}


@dataclass(frozen=True)
class Row:
    """One run of one reading."""

    question: str
    reading: str
    case: str
    seed: int
    budget: int
    gap: float | None
    status: str


def repeat(
    question: str, reading: str, case: str, problem: Problem, optimum: float, seeds: int, budget: int
) -> list[Row]:
    """All seeds of one reading on one case."""
    name, changed = READINGS[question][reading]
    entry = ALGORITHMS[name]
    objective = Objective(problem, stretch=True)
    lo, hi = search_box(problem)
    rows = []
    for seed in range(seeds):
        parameters = entry.parameters | changed
        result = minimise(entry.function, objective, lo, hi, budget=budget, seed=seed, **parameters)
        gap = None if result.x is None else result.fitness / optimum - 1.0
        rows.append(Row(question, reading, case, seed, budget, gap, result.status.value))
    return rows


def summarise(rows: list[Row]) -> list[dict[str, Any]]:
    """By question and reading: quartiles of the gap and the share that reached the optimum."""
    found = []
    for question, readings in READINGS.items():
        for reading in readings:
            mine = [row for row in rows if (row.question, row.reading) == (question, reading)]
            gaps = np.array([np.inf if row.gap is None else max(row.gap, 0.0) for row in mine])
            low, middle, high = np.quantile(gaps, [0.25, 0.5, 0.75], method="nearest")
            found.append(
                {
                    "question": question,
                    "reading": reading,
                    "runs": len(mine),
                    "quartiles": [float(g) if np.isfinite(g) else None for g in (low, middle, high)],
                    "reached": float((gaps <= REACHED).mean()),
                }
            )
    return found


@styled
def readings_figure(summary: list[dict[str, Any]]) -> Figure:
    """A row per reading, grouped by question."""
    figure, axes = plt.subplots(figsize=(9.5, 1.0 + 0.22 * len(summary)))
    labels = []
    for y, entry in enumerate(summary):
        first = y == 0 or summary[y - 1]["question"] != entry["question"]
        if first:
            axes.axhline(y - 0.5, color=GREY, lw=0.5)
        low, middle, high = (1.0 if g is None else max(g, 1e-12) for g in entry["quartiles"])
        colour = ORANGE if first else BLUE
        axes.plot([low, high], [y, y], color=colour, lw=1.2)
        axes.plot(middle, y, "o", color=colour, ms=5)
        axes.text(1.01, y, f"{entry['reached']:.0%}", fontsize=7, va="center",
                  transform=axes.get_yaxis_transform())  # fmt: skip
        labels.append(f"{entry['question'] if first else ''}   {entry['reading']}")
    axes.axvline(REACHED, color=GREY, lw=0.8, ls="--")
    axes.set_xscale("log")
    axes.set_yticks(range(len(summary)), labels, fontsize=8)
    axes.set_ylim(len(summary) - 0.5, -0.5)
    axes.set_xlabel("gap in the stretched coding [1], median and quartiles; right: share below 0.1 %")
    axes.set_title("Orange: the reading that is the default", loc="left", fontsize=9)
    return figure


def as_text(summary: list[dict[str, Any]]) -> str:
    """A line per reading."""
    lines = [
        [
            entry["question"], entry["reading"],
            *("none" if g is None else f"{g:.1e}" for g in entry["quartiles"]),
            f"{entry['reached']:.0%}",
        ]
        for entry in summary
    ]  # fmt: skip
    header = ["question", "reading", "gap, 25 %", "median", "75 %", "below 0.1 %"]
    return commands.table(header, lines, right=(2, 3, 4, 5))


def main() -> int:
    """Run every reading."""
    parser = commands.parser(
        "readings",
        "What each reading of a misprinted or open formula does, on arm problems.",
        "python -m compare.readings --seeds 30 --out report",
    )
    parser.add_argument("--cases", default="sr4c,ur5,cobot", help=f"some of {','.join(CASES)}")
    parser.add_argument("--seeds", type=int, default=20, help="number of seeds")
    parser.add_argument("--budget", type=int, default=2550, help="evaluations per run")
    parser.add_argument("--out", default="report", metavar="DIR", help="folder of the report")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="worker processes")
    options = parser.parse_args()
    for key in ("seeds", "budget", "jobs"):
        commands.positive(f"--{key}", getattr(options, key))
    folder = commands.output_folder(options.out)
    calls = []
    for case in commands.chosen("--cases", options.cases, CASES):
        problem = load(case)
        optimum = family_optimum(problem).seconds
        calls += [
            (question, reading, case, problem, optimum, options.seeds, options.budget)
            for question, readings in READINGS.items()
            for reading in readings
        ]
    with workers(options.jobs) as pool:
        rows = collect(pool, folder, "readings", repeat, calls, list(Row.__annotations__))
    summary = summarise(rows)
    finish(folder, "readings", summary, readings_figure(summary))
    print(as_text(summary))
    return commands.DONE


if __name__ == "__main__":
    commands.run(main)
