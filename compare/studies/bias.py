"""``python -m compare.bias``: which swarms are drawn to x = 0, and by how much.

Two tests. Functions of ten coordinates whose optimum is the centre of the box, x = 0; with all moved
away from zero together; and with the optimum at a random place of the box. And arm problems in the
stretched coding with coordinates as printed, mirrored and offset. A search that does not know where
zero is has the ratio 1; one that knows where the box's centre is shows in the shifted functions alone.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.benchmark import suite
from compare.benchmark.objective import Objective, search_box
from compare.benchmark.run import workers
from compare.commands import shared as commands
from compare.report.style import BLUE, GREY, ORANGE, PURPLE, VERMILION, styled
from compare.studies.origin_shift import COORDINATES, seen_in
from compare.studies.study import collect, finish
from formulations import CASES, Problem, family_optimum, load
from formulations.problem.arrays import Array
from metaheuristics import algorithm, minimise

DIM, HALF = 10, 100.0  # coordinates, half the width of the functions' box
SHIFT = 0.8  # largest shift, as a share of HALF
FLOOR_FUNCTION, FLOOR_GAP = 1e-15, 1e-9  # errors below are rounding


def sphere(x: Array) -> Array:
    """Sum of squares."""
    return np.asarray((x**2).sum(axis=1))


def rastrigin(x: Array) -> Array:
    """Many local optima on a grid of 1 (Rastrigin 1974), scaled to the box."""
    z = x * 5.12 / HALF
    return np.asarray((z**2 - 10 * np.cos(2 * np.pi * z) + 10).sum(axis=1))


def ackley(x: Array) -> Array:
    """A narrow hole in a rough plain (Ackley 1987), scaled to the box."""
    z = x * 32.0 / HALF
    root = np.sqrt((z**2).mean(axis=1))
    cosines = np.cos(2 * np.pi * z).mean(axis=1)
    # expm1: the sum of four terms would cancel near the optimum
    return np.asarray(-20 * np.expm1(-0.2 * root) - np.e * np.expm1(cosines - 1))


FUNCTIONS: dict[str, Callable[[Array], Array]] = {
    "sphere": sphere,
    "rastrigin": rastrigin,
    "ackley": ackley,
}


# there: (here, in words, colour, marker)
COMPARED = {
    "translated": ("centre", "functions: zero moved far away, all else the same", VERMILION, "o"),
    "shifted": ("centre", "functions: optimum moved from the box's centre, x = 0", PURPLE, "v"),
    "mirrored": ("printed", "arms: coordinates mirrored", BLUE, "s"),
    "offset": ("printed", "arms: zero moved far away, all else the same", ORANGE, "D"),
}


@dataclass(frozen=True)
class Row:
    """One run. place: a key of COMPARED, or what it is compared with. error: f - f*, or the gap [1]."""

    task: str
    place: str
    swarm: str
    library: str
    seed: int
    budget: int
    error: float | None
    status: str


def on_function(name: str, swarm: str, seeds: int, budget: int) -> list[Row]:
    """A swarm on a function in each place; seed by seed the same shift for all swarms."""
    rows = []
    for seed in range(seeds):
        shift = np.random.default_rng([seed, 17]).uniform(-SHIFT, SHIFT, DIM) * HALF
        lo, hi = np.full(DIM, -HALF), np.full(DIM, HALF)
        places: dict[str, tuple[Callable[[Array], Array], Array, Array]] = {
            "centre": (FUNCTIONS[name], lo, hi),
            "translated": seen_in("offset", FUNCTIONS[name], lo, hi),
            "shifted": (partial(_minus, FUNCTIONS[name], shift), lo, hi),
        }
        rows += [_run(name, place, swarm, seed, budget, *seen) for place, seen in places.items()]
    return rows


def on_arm(
    case: str, problem: Problem, optimum: float, swarm: str, seeds: int, budget: int
) -> list[Row]:
    """A swarm on an arm problem in each of the coordinates."""
    gap = partial(_gap, Objective(problem, stretch=True), optimum)
    return [
        _run(case, name, swarm, seed, budget, *seen_in(name, gap, *search_box(problem)))
        for name in COORDINATES
        for seed in range(seeds)
    ]


def _minus(f: Callable[[Array], Array], shift: Array, x: Array) -> Array:
    return f(x - shift)


def _gap(objective: Objective, optimum: float, x: Array) -> Array:
    return objective(x) / optimum - 1.0


def _run(
    task: str,
    place: str,
    swarm: str,
    seed: int,
    budget: int,
    f: Callable[[Array], Array],
    lo: Array,
    hi: Array,
) -> Row:
    entry = algorithm(swarm)
    result = minimise(entry.search(), f, lo, hi, budget=budget, seed=seed, **entry.parameters)
    error = None if result.x is None else result.fitness
    return Row(task, place, swarm, entry.versions, seed, budget, error, result.status.value)


def summarise(rows: list[Row]) -> dict[str, dict[str, float | None]]:
    """By swarm and comparison: the ratio of median errors, there over here.

    Geometric means over the tasks; None where some task was never solved.
    """
    found: dict[str, dict[str, float | None]] = {}
    for swarm in dict.fromkeys(row.swarm for row in rows):
        mine = [row for row in rows if row.swarm == swarm]
        found[swarm] = {there: _ratio(mine, there, here) for there, (here, *_) in COMPARED.items()}
    return found


def _ratio(rows: list[Row], there: str, here: str) -> float | None:
    floor = FLOOR_FUNCTION if here == "centre" else FLOOR_GAP
    ratios = []
    for task in dict.fromkeys(row.task for row in rows if row.place == here):
        medians = []
        for place in (there, here):
            errors = [np.inf if row.error is None else row.error
                      for row in rows if (row.task, row.place) == (task, place)]  # fmt: skip
            medians.append(max(float(np.median(errors)), floor))
        ratios.append(medians[0] / medians[1])
    if not ratios or not np.isfinite(ratios).all():
        return None
    return float(np.exp(np.mean(np.log(ratios))))


@styled
def bias_figure(summary: dict[str, dict[str, float | None]]) -> Figure:
    """A row per swarm, three marks."""
    figure, axes = plt.subplots(figsize=(9.0, 1.3 + 0.24 * len(summary)))
    axes.axvspan(0.1, 10.0, color=GREY, alpha=0.12, lw=0)
    for y, ratios in enumerate(summary.values()):
        for there, (_, _, colour, marker) in COMPARED.items():
            ratio = ratios[there]
            if ratio is not None:
                axes.plot(ratio, y, marker, color=colour, ms=5, alpha=0.85)
    for _, words, colour, marker in COMPARED.values():
        axes.plot([], [], marker, color=colour, ls="", label=words)
    axes.set_yticks(range(len(summary)), list(summary))
    axes.set_ylim(len(summary) - 0.5, -0.5)
    axes.set_xscale("log")
    axes.grid(axis="y", alpha=0.25, lw=0.5)
    axes.set_xlabel("median error there / median error here [1]; grey: within ten")
    axes.set_title("Who is drawn to zero: 1 means that it does not matter where zero lies", loc="left")
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=8, frameon=False)
    return figure


def study(
    pool: ProcessPoolExecutor,
    folder: Path,
    *,
    cases: list[str],
    functions: list[str],
    swarms: list[str],
    seeds: int,
    budget: int,
) -> dict[str, dict[str, float | None]]:
    """Run all, write DIR/bias.csv, bias.json and the picture."""
    calls: list[tuple[Any, ...]] = [
        (on_function, f, s, seeds, budget) for s in swarms for f in functions
    ]
    for case in cases:
        problem = load(case)
        optimum = family_optimum(problem).seconds
        calls += [(on_arm, case, problem, optimum, s, seeds, budget) for s in swarms]
    rows = collect(pool, folder, "bias", _apply, calls, list(Row.__annotations__))
    rows.sort(key=lambda row: (swarms.index(row.swarm), row.task, row.place, row.seed))
    summary = summarise(rows)
    finish(folder, "bias", summary, bias_figure(summary))
    return summary


def _apply(function: Callable[..., list[Row]], *arguments: Any) -> list[Row]:
    return function(*arguments)


def as_text(summary: dict[str, dict[str, float | None]]) -> str:
    """A line per swarm."""
    lines = [
        [swarm, *("none" if r is None else f"{r:.3g}" for r in ratios.values())]
        for swarm, ratios in summary.items()
    ]
    header = ["swarm", *(f"{there} / {here}" for there, (here, *_) in COMPARED.items())]
    return commands.table(header, lines, right=range(1, len(header)))


def main() -> int:
    """Measure the bias of every swarm."""
    parser = commands.parser(
        "bias",
        "How much worse each swarm does when the optimum, or zero, is moved.",
        "python -m compare.bias --swarms pso,whale,sparrow --seeds 30 --out report",
    )
    parser.add_argument("--swarms", help="as in compare.all")
    parser.add_argument("--cases", default="sr4c,ur5,cobot,bagging", help=f"some of {','.join(CASES)}")
    parser.add_argument("--seeds", type=int, default=10, help="number of seeds")
    parser.add_argument("--budget", type=int, default=5000, help="evaluations per run")
    parser.add_argument("--out", default="report", metavar="DIR", help="folder of the report")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="worker processes")
    options = parser.parse_args()
    for key in ("seeds", "budget", "jobs"):
        commands.positive(f"--{key}", getattr(options, key))
    swarms = commands.swarms("--swarms", options.swarms, suite.swarms_of("default"))
    cases = commands.chosen("--cases", options.cases, CASES)
    folder = commands.output_folder(options.out)
    with workers(options.jobs) as pool:
        summary = study(
            pool, folder, cases=cases, functions=list(FUNCTIONS), swarms=swarms,
            seeds=options.seeds, budget=options.budget,
        )  # fmt: skip
    print(as_text(summary))
    return commands.DONE


if __name__ == "__main__":
    commands.run(main)
