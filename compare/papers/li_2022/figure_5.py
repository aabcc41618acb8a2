"""Li 2022, Fig. 5: the best particle over the iterations."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.audit.paper.digits import values
from compare.benchmark.objective import Objective, search_box
from compare.papers.item import Item, ItemVerdict, Shown
from compare.papers.li_2022.paper import SWARMS, budget, rows
from compare.papers.measure import trials
from compare.papers.pictures.descent import descent, draw_descent
from compare.papers.verdicts import Reproduction, same_times
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, styled
from formulations import Problem, load
from formulations.problem.arrays import Array
from metaheuristics import ALGORITHMS, minimise


@dataclass
class Watched:
    """An objective that remembers the best vector after each call."""

    objective: Objective
    best: float = np.inf
    x: Array | None = None
    seen: list[list[float] | None] = field(default_factory=list)

    def __call__(self, x: Array) -> Array:
        """Fitness of a population (n, dim)."""
        fitness = self.objective(x)
        first = int(fitness.argmin())
        if fitness[first] < self.best:
            self.best, self.x = float(fitness[first]), x[first].copy()
        self.seen.append(None if self.x is None else self.x.tolist())
        return fitness


def evolution(problem: Problem, swarm: str, seed: int) -> list[list[float] | None]:
    """Follow the best vector of one run.

    Parameters
    ----------
    problem : Problem
        The task.
    swarm : str
        A name of ``ALGORITHMS``.
    seed : int
        Of the run.

    Returns
    -------
    list of (list of float or None) [s]
        After the first population and after each iteration; None while nothing is feasible.
    """
    watched = Watched(Objective(problem, stretch=False))
    entry, (lo, hi) = ALGORITHMS[swarm], search_box(problem)
    parameters = entry.parameters | {"population": budget().population}
    minimise(entry.function, watched, lo, hi, budget=budget().evaluations, seed=seed, **parameters)
    return watched.seen


def make_fig_5(full: bool) -> dict[str, Any]:
    """Follow the best particle of seed 0 per joint; quartiles of the best time of many seeds."""
    problem, (single, _) = load("bagging"), rows()
    runs = 100 if full else 20
    joints = []
    for row in single:
        assert row.joint is not None
        one = problem.joint(row.joint)
        found = {swarm: trials(one, swarm, budget(), runs) for swarm in SWARMS}
        joints.append({
            "joint": row.joint + 1,
            "printed": values(row.times).tolist(),
            "best": evolution(one, "mpso", 0),
            "descents": {
                swarm: descent([g.traces[0] for g in group], budget().population, budget().iterations)
                for swarm, group in found.items()
            },
        })  # fmt: skip
    return {"runs": runs, "iterations": budget().iterations, "joints": joints}


def show_fig_5(data: dict[str, Any]) -> Shown:
    """Show both pictures, and when the particles come to rest."""
    remarks = []
    for j in data["joints"]:
        solved = [x for x in j["best"] if x is not None]
        if not solved:
            remarks.append(f"Joint {j['joint']}: seed 0 found nothing feasible.")
            continue
        last = np.array(solved[-1])
        settled = next(
            k for k, x in enumerate(j["best"]) if x is not None and abs(sum(x) / last.sum() - 1) < 1e-3
        )
        medians = {s: j["descents"][s]["quartiles"][1][-1] for s in SWARMS}
        ends = "; ".join(f"{SWARMS[s]} {v:.4f} s" for s, v in medians.items() if v is not None)
        remarks.append(
            f"Joint {j['joint']}: after {settled} of {data['iterations']} iterations the best particle of "
            "seed 0 "
            f"is within 0.1 % of its last total, {last.sum():.4f} s; printed: {sum(j['printed']):.4f} s. "
            "Medians "
            f"of {data['runs']} seeds: {ends}."
        )
    outcomes = {title: ends_again(data, swarm) for swarm, title in SWARMS.items()}
    remarks.append(
        "The printed ends of the five curves are "
        + " and ".join(f"{outcome.inside} with {title}" for title, outcome in outcomes.items())
        + ", by the medians of all seeds."
    )
    verdicts = [
        ItemVerdict(f"the ends of the curves, {title}", outcome) for title, outcome in outcomes.items()
    ]
    return Shown([fig_5(data), descents_figure(data)], remarks, verdicts)


def ends_again(data: dict[str, Any], swarm: str) -> Reproduction:
    """Judge the printed ends of all joints' curves by the medians of one reading.

    Parameters
    ----------
    data : dict
        Of ``make_fig_5``.
    swarm : str
        A key of ``SWARMS``.

    Returns
    -------
    Reproduction
        ``NOT`` if half of the seeds of a joint found nothing.
    """
    ends = [j["descents"][swarm]["quartiles"][1][-1] for j in data["joints"]]
    return same_times(
        [sum(j["printed"]) for j in data["joints"]], [np.inf if end is None else end for end in ends]
    )


_SEGMENTS = ((BLUE, "-"), (ORANGE, "-"), (GREEN, "-"), (PURPLE, "--"), (SKY, "--"), (BLACK, "-."))


@styled
def fig_5(data: dict[str, Any]) -> Figure:
    """Draw the six durations of the best particle, a panel per joint, with the printed ends."""
    figure, grid = plt.subplots(1, 5, figsize=(11.4, 3.0), sharey=True)
    for axes, j in zip(grid, data["joints"], strict=True):
        best = np.array([[np.nan] * 6 if x is None else x for x in j["best"]])
        for k, (colour, line) in enumerate(_SEGMENTS):
            axes.plot(best[:, k], color=colour, ls=line, lw=1.3, label=f"Δt{k + 1}")
            axes.plot(
                1.06 * data["iterations"], j["printed"][k], "x", color=colour, ms=5, clip_on=False
            )
        axes.set_yscale("log")
        axes.set_title(f"joint {j['joint']}", loc="left")
        axes.set_xlabel("iteration [1]")
        axes.set_xlim(0, data["iterations"])
    grid[0].set_ylabel("duration of the best particle [s]")
    grid[0].plot([], [], "x", color=GREY, label="printed in Table 3")
    handles, labels = grid[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=7, frameon=False, fontsize=8)
    return figure


@styled
def descents_figure(data: dict[str, Any]) -> Figure:
    """Draw the best total over the iterations for both readings of the factors, with the printed total."""
    figure, grid = plt.subplots(1, 5, figsize=(11.4, 2.8), sharey=True)
    for axes, j in zip(grid, data["joints"], strict=True):
        for swarm, style in zip(SWARMS, ((BLUE, "-"), (ORANGE, "--")), strict=True):
            draw_descent(axes, j["descents"][swarm], SWARMS[swarm], style)
        axes.axhline(sum(j["printed"]), color=VERMILION, lw=1.0, ls=":", label="printed in Table 3")
        axes.set_yscale("log")
        axes.set_yticks([0.3, 0.5, 1.0, 2.0, 5.0], ["0.3", "0.5", "1", "2", "5"])
        axes.minorticks_off()
        axes.set_title(f"joint {j['joint']}", loc="left")
        axes.set_xlabel("iteration [1]")
        axes.set_xlim(0, data["iterations"])
    grid[0].set_ylabel(f"best total of {data['runs']} seeds [s]")
    handles, labels = grid[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False, fontsize=8)
    return figure


FIGURE_5 = Item(
    "Fig 5",
    "the best particle over the iterations",
    make_fig_5,
    show_fig_5,
    "Read as Table 3. The paper does not say which run it prints: the first picture is seed 0, the second the "
    "quartiles of many seeds.",
    cost=20.0,
)
