"""Which swarms are drawn to x = 0, and by how much: the study behind ``timebound bias``.

There are two tests. The first has functions of ten coordinates: with the optimum in the centre of the
box, at x = 0; with box and optimum moved away from zero together; and with the optimum moved to a
random place of the box. The second has arm problems in the stretched coding, with the coordinates as
printed, mirrored and offset. A search that does not know where zero is has the ratio 1 everywhere. A
search that is drawn to the centre of the box differs in the shifted functions alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.benchmark.coordinates import seen_in
from compare.benchmark.objective import Objective, search_box
from compare.benchmark.protocol import Coordinates
from compare.benchmark.records.provenance import code_digest
from compare.report.style import BLUE, GREY, ORANGE, PURPLE, VERMILION, styled
from compare.screen import table
from compare.studies.drawn_to_zero.centred_functions import DIM, FUNCTIONS, HALF
from compare.studies.study import Call, Study, optima_of
from formulations import Problem, load
from formulations.problem.arrays import Array
from metaheuristics import algorithm, minimise

SHIFT = 0.8  # largest shift, as a share of HALF
FLOOR_FUNCTION, FLOOR_GAP = 1e-15, 1e-9  # errors below are rounding


Summary = dict[str, dict[str, float | None]]

# there: (here, in words, colour, marker)
COMPARED = {
    "translated": ("centre", "functions: zero moved far away, all else the same", VERMILION, "o"),
    "shifted": ("centre", "functions: optimum moved from the box's centre, x = 0", PURPLE, "v"),
    "mirrored": ("printed", "arms: coordinates mirrored", BLUE, "s"),
    "offset": ("printed", "arms: zero moved far away, all else the same", ORANGE, "D"),
}


@dataclass(frozen=True)
class BiasRun:
    """One run. place: a key of COMPARED, or what it is compared with. error: f - f*, or the gap [1]."""

    task: str
    place: str
    swarm: str
    library: str
    seed: int
    budget: int
    error: float | None
    status: str


def on_function(name: str, swarm: str, seeds: int, budget: int) -> list[BiasRun]:
    """Run a swarm on a function with its optimum in each place.

    Parameters
    ----------
    name : str
        A key of FUNCTIONS.
    swarm : str
        An algorithm, by name.
    seeds : int
        Number of seeds; the shift of a seed is the same for all swarms.
    budget : int
        Evaluations per run.

    Returns
    -------
    list of BiasRun
        A row per seed and place.
    """
    rows = []
    for seed in range(seeds):
        shift = np.random.default_rng([seed, 17]).uniform(-SHIFT, SHIFT, DIM) * HALF
        lo, hi = np.full(DIM, -HALF), np.full(DIM, HALF)
        places: dict[str, tuple[Callable[[Array], Array], Array, Array]] = {
            "centre": (FUNCTIONS[name], lo, hi),
            "translated": seen_in(Coordinates.offset, FUNCTIONS[name], lo, hi),
            "shifted": (partial(_minus, FUNCTIONS[name], shift), lo, hi),
        }
        rows += [_run(name, place, swarm, seed, budget, *seen) for place, seen in places.items()]
    return rows


def on_arm(
    case: str, problem: Problem, optimum: float, swarm: str, seeds: int, budget: int
) -> list[BiasRun]:
    """Run a swarm on an arm problem in each of the coordinates.

    Parameters
    ----------
    case : str
        Name of the problem.
    problem : Problem
        The problem.
    optimum : float
        Optimum of its family [s].
    swarm : str
        An algorithm, by name.
    seeds : int
        Number of seeds.
    budget : int
        Evaluations per run.

    Returns
    -------
    list of BiasRun
        A row per coordinates and seed.
    """
    gap = partial(_gap, Objective(problem, stretch=True), optimum)
    return [
        _run(case, name, swarm, seed, budget, *seen_in(name, gap, *search_box(problem)))
        for name in Coordinates
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
) -> BiasRun:
    entry = algorithm(swarm)
    result = minimise(entry.search(), f, lo, hi, budget=budget, seed=seed, **entry.parameters)
    error = None if result.x is None else result.fitness
    return BiasRun(task, place, swarm, entry.versions, seed, budget, error, result.status.value)


def summarise(rows: list[BiasRun]) -> Summary:
    """Take the ratio of median errors, there over here, by swarm and comparison.

    Parameters
    ----------
    rows : list of BiasRun
        All runs.

    Returns
    -------
    dict
        Ratio [1] by swarm and key of COMPARED, the geometric mean over the tasks; None where some
        task was never solved.
    """
    found: Summary = {}
    for swarm in dict.fromkeys(row.swarm for row in rows):
        mine = [row for row in rows if row.swarm == swarm]
        found[swarm] = {there: _ratio(mine, there, here) for there, (here, *_) in COMPARED.items()}
    return found


def _ratio(rows: list[BiasRun], there: str, here: str) -> float | None:
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
def bias_figure(rows: list[BiasRun], summary: Summary) -> Figure:
    """Draw a line per swarm with a mark per comparison.

    Parameters
    ----------
    rows : list of BiasRun
        All runs.
    summary : dict
        Of ``summarise``.

    Returns
    -------
    Figure
        The picture.
    """
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


def as_text(rows: list[BiasRun], summary: Summary) -> str:
    """Lay the ratios out as a table, a line per swarm.

    Parameters
    ----------
    rows : list of BiasRun
        All runs.
    summary : dict
        Of ``summarise``.

    Returns
    -------
    str
        The table.
    """
    lines = [
        [swarm, *("none" if r is None else f"{r:.3g}" for r in ratios.values())]
        for swarm, ratios in summary.items()
    ]
    header = ["swarm", *(f"{there} / {here}" for there, (here, *_) in COMPARED.items())]
    return table(header, lines, right=range(1, len(header)))


def calls(
    functions: list[str], cases: list[str], swarms: list[str], seeds: int, budget: int
) -> list[Call]:
    """List the calls of the study; the optimum of each arm problem is computed here.

    Parameters
    ----------
    functions : list of str
        Keys of FUNCTIONS.
    cases : list of str
        Shipped cases.
    swarms : list of str
        Algorithms, by name.
    seeds : int
        Number of seeds.
    budget : int
        Evaluations per run.

    Returns
    -------
    list of tuples
        Arguments of ``STUDY.compute``.
    """
    problems = {case: load(case) for case in cases}
    optima = optima_of(problems)
    found: list[Call] = []
    for swarm in swarms:
        code = code_digest(swarm)
        found += [(code, on_function, name, swarm, seeds, budget) for name in functions]
        found += [
            (code, on_arm, case, problems[case], optima[case], swarm, seeds, budget) for case in cases
        ]
    return found


def _compute(code: str, function: Callable[..., list[BiasRun]], *arguments: Any) -> list[BiasRun]:
    """Run a call; the digest of the swarm's code only tells it from a call of other code."""
    return function(*arguments)


STUDY = Study(
    name="bias",
    row=BiasRun,
    compute=_compute,
    summarise=summarise,
    text=as_text,
    figure=bias_figure,
)
