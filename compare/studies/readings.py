"""What a paper prints, and what it can mean: the study behind ``timebound readings``.

Some printed formulas cannot be right, and some values are left open. Each reading of them runs on arm
problems in the stretched coding: median gap, and share of the seeds that end below 0.1 %.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.benchmark.grade import REACHED
from compare.benchmark.objective import Objective, search_box
from compare.report.style import BLUE, GREY, ORANGE, styled
from compare.screen import table
from compare.studies.study import Call, Study, optima_of
from formulations import Problem, load
from metaheuristics import ALGORITHMS, minimise

# paper, question -> reading -> algorithm and what is changed; the first is the default
READINGS: dict[str, dict[str, tuple[str, dict[str, Any]]]] = {
    "Wang 2025, eq. 15, 16: inertia, mutation": {
        "resolved": ("mipso", {}),
        "as printed": ("mipso-printed", {}),
    },
    "Wang 2025, eq. 12: peak of the tent map": {
        "0.499": ("mipso", {}),
        "0.5 (collapses)": ("mipso", {"lam": 0.5}),
        "no map": ("mipso-pso1", {}),
    },
    "Li 2022, eq. 15, 16: factors": {
        "as printed": ("mpso", {}),
        "times ten": ("mpso-times-ten", {}),
    },
    "Li 2022, sec. 3, step 1: populations": {
        "one of vectors": ("mpso", {}),
        "one per segment": ("mpso", {"split": True}),
    },
    "Zhou 2025, eq. 8, 10: sparrows": {
        "resolved": ("sparrow", {}),
        "as printed": ("sparrow-printed", {}),
    },
    "Zhou 2025: share of scouts": {
        "10 %": ("sparrow", {}),
        "20 %": ("sparrow", {"scouts": 0.2}),
    },
    "Zhou 2025, sec. 4.2, step 1: groups": {
        "one flock": ("issa", {}),
        "two groups": ("issa", {"two_groups": True}),
    },
    "Zhou 2025: how the weights enter": {
        "each chooses": ("issa", {}),
        "blended": ("issa-blended", {}),
    },
    "Zhou 2025, eq. 14: threshold, share of the best": {
        "1e-3": ("issa", {}),
        "1e-2": ("issa", {"threshold": 1e-2}),
        "1e-4": ("issa", {"threshold": 1e-4}),
        "1e-6": ("issa", {"threshold": 1e-6}),
    },
    "Zhou 2025, eq. 13: window": {
        "5": ("issa", {}),
        "1": ("issa", {"window": 1}),
        "20": ("issa", {"window": 20}),
    },
    "Lu 2024, eq. 16, 19, 21, 23: whales": {
        "resolved": ("whale-lu-2024", {}),
        "as printed": ("whale-lu-2024-printed", {}),
        "no weight (2016)": ("whale", {}),
    },
    "Lu 2024, eq. 17: b": {
        "1": ("whale-lu-2024", {}),
        "0.5": ("whale-lu-2024", {"b": 0.5}),
        "2": ("whale-lu-2024", {"b": 2.0}),
    },
    "Lu 2024, eq. 22: s": {
        "1": ("whale-lu-2024", {}),
        "-0.9": ("whale-lu-2024", {"s": -0.9}),
        "0": ("whale-lu-2024", {"s": 0.0}),
        "5": ("whale-lu-2024", {"s": 5.0}),
        "50": ("whale-lu-2024", {"s": 50.0}),
    },
    "Zhang 2025, eq. 7: else-branch": {
        "keeps its own": ("pso-zhang-2025", {}),
        "as printed": ("pso-zhang-2025-printed", {}),
        "no crossover": ("pso-zhang-2025", {"CR": 0.0}),
    },
    "Zhang 2025, eq. 6: alpha, beta": {
        "0.5, 0.5": ("pso-zhang-2025", {}),
        "0.9, 0.1": ("pso-zhang-2025", {"alpha": 0.9, "beta": 0.1}),
        "0.1, 0.9": ("pso-zhang-2025", {"alpha": 0.1, "beta": 0.9}),
        "0.9, 0.9": ("pso-zhang-2025", {"alpha": 0.9, "beta": 0.9}),
    },
}


@dataclass(frozen=True)
class ReadingRun:
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
) -> list[ReadingRun]:
    """Run all seeds of one reading on one case.

    Parameters
    ----------
    question, reading : str
        Keys of READINGS.
    case : str
        Name of the problem.
    problem : Problem
        The problem.
    optimum : float
        Optimum of its family [s].
    seeds : int
        Number of seeds.
    budget : int
        Evaluations per run.

    Returns
    -------
    list of ReadingRun
        A row per seed.
    """
    name, changed = READINGS[question][reading]
    entry = ALGORITHMS[name]
    objective = Objective(problem, stretch=True)
    lo, hi = search_box(problem)
    rows = []
    for seed in range(seeds):
        parameters = entry.parameters | changed
        result = minimise(entry.function, objective, lo, hi, budget=budget, seed=seed, **parameters)
        gap = None if result.x is None else result.fitness / optimum - 1.0
        rows.append(ReadingRun(question, reading, case, seed, budget, gap, result.status.value))
    return rows


def summarise(rows: list[ReadingRun]) -> list[dict[str, Any]]:
    """Take quartiles of the gap, and the share that reached the optimum, by question and reading.

    Parameters
    ----------
    rows : list of ReadingRun
        All runs.

    Returns
    -------
    list of dict
        An entry per reading; a quartile is None where too many runs found nothing feasible.
    """
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
def readings_figure(rows: list[ReadingRun], summary: list[dict[str, Any]]) -> Figure:
    """Draw a line per reading, grouped by question.

    Parameters
    ----------
    rows : list of ReadingRun
        All runs.
    summary : list of dict
        Of ``summarise``.

    Returns
    -------
    Figure
        The picture.
    """
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


def as_text(rows: list[ReadingRun], summary: list[dict[str, Any]]) -> str:
    """Lay the readings out as a table.

    Parameters
    ----------
    rows : list of ReadingRun
        All runs.
    summary : list of dict
        Of ``summarise``.

    Returns
    -------
    str
        A line per reading.
    """
    lines = [
        [
            entry["question"], entry["reading"],
            *("none" if g is None else f"{g:.1e}" for g in entry["quartiles"]),
            f"{entry['reached']:.0%}",
        ]
        for entry in summary
    ]  # fmt: skip
    header = ["question", "reading", "gap, 25 %", "median", "75 %", "below 0.1 %"]
    return table(header, lines, right=(2, 3, 4, 5))


def calls(cases: list[str], seeds: int, budget: int) -> list[Call]:
    """List the calls of the study; the optimum of each case is computed here.

    Parameters
    ----------
    cases : list of str
        Shipped cases.
    seeds : int
        Number of seeds.
    budget : int
        Evaluations per run.

    Returns
    -------
    list of tuples
        Arguments of ``repeat``.
    """
    problems = {case: load(case) for case in cases}
    optima = optima_of(problems)
    return [
        (question, reading, case, problems[case], optima[case], seeds, budget)
        for case in cases
        for question, readings in READINGS.items()
        for reading in readings
    ]


STUDY = Study(
    name="readings",
    row=ReadingRun,
    compute=repeat,
    summarise=summarise,
    text=as_text,
    figure=readings_figure,
)
