"""The two families of Lu 2024 on further sets of waypoints: which of them has a motion, and how fast it is.

Whether a spline keeps the position limits depends on its shape alone, the ratios of the durations. A search
that is told "infeasible" and nothing else cannot find its way to the shapes that keep them. Here shapes
that do not are ranked by how far they leave them, so that one search looks for a feasible shape first and
for a fast one then (Deb 2000, "An efficient constraint handling method for genetic algorithms", sec. 3).
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from compare.benchmark.objective import search_box
from compare.papers.item import Table
from compare.papers.lu_2024.plan import drawn_waypoints, task
from compare.papers.measure import spline
from compare.papers.words import listed, percent
from formulations import FAMILIES, NoFeasibleMotion, NotFoundInTime, Problem, check, family_optimum
from formulations.families.population_times import PopulationTimes
from formulations.optima.family.optimum import local_optimum
from formulations.problem.arrays import Array
from metaheuristics import algorithm, minimise

SETS = {False: 6, True: 30}
FAMILIES_COMPARED = ("b-spline-5", "quintic")
OTHER_DEGREE = "b-spline-3"  # the other reading, asked where degree 5 has no motion
_BUDGET = {False: 5000, True: 10_000}  # evaluations of a start
_STARTS = {False: 1, True: 3}  # where the first one finds a feasible shape
_ALL_STARTS = {False: 4, True: 20}  # where none does
_WORST = 1e6  # s; above every time
_SAME = 1e-3  # rad; ends of two starts that count as the same
_NLP = 30.0  # s, of the nonlinear program where no start found a feasible shape


def search(problem: Problem, full: bool) -> dict[str, Any]:
    """Search for the fastest spline that keeps all limits, by CMA-ES on the logarithms of the durations.

    Parameters
    ----------
    problem : Problem
        With the family.
    full : bool
        More starts and evaluations; the exact nonlinear program goes on from the best shape.

    Returns
    -------
    dict
        seconds [s] and durations of the best motion that passed the check (None: there is none), excess: least
        distance beyond the position limits of each start [rad], program: what the nonlinear program says of a
        set without a motion.
    """
    family = FAMILIES[problem.family]
    times = PopulationTimes(family, problem, stretched=True)

    def ranked(logarithms: Array) -> Array:
        shapes = np.exp(logarithms)
        found = times(shapes)
        out = np.isinf(found)
        if out.any():
            found[out] = _WORST * (1.0 + family.position_excess(problem, shapes[out]))
        return found

    box = [np.log(edge) for edge in search_box(problem)]
    entry = algorithm("cma-es")
    excess: list[float] = []
    best, seconds = None, np.inf
    while len(excess) < (_STARTS if best is not None else _ALL_STARTS)[full]:
        result = minimise(
            entry.function, ranked, *box, budget=_BUDGET[full], seed=len(excess), **entry.parameters
        )
        assert result.x is not None
        shape = np.exp(result.x)
        excess.append(float(family.position_excess(problem, shape[None])[0]))
        found = shape * family.stretch(problem, shape[None])[0]
        verdict = check(problem, spline(problem, found))
        if verdict.feasible and verdict.seconds < seconds:
            best, seconds = found, verdict.seconds
    program = ""
    if full and best is not None:
        start = local_optimum(problem, best)
        verdict = check(problem, spline(problem, start.durations))
        if verdict.feasible and verdict.seconds < seconds:
            best, seconds = start.durations, verdict.seconds
    elif full:
        program = _program(problem)
    return {
        "seconds": None if best is None else seconds,
        "durations": None if best is None else best.tolist(),
        "excess": excess,
        "program": program,
    }


def _program(problem: Problem) -> str:
    """What the exact nonlinear program with many starts says of a set on which CMA-ES found nothing."""
    try:
        return f"found {family_optimum(problem, time_limit=_NLP).seconds:.3f} s"
    except (NoFeasibleMotion, NotFoundInTime) as failure:
        return str(failure)


def make_sets(full: bool) -> list[dict[str, Any]]:
    """Search for the best motion of both families on each set of waypoints.

    Parameters
    ----------
    full : bool
        More sets, starts and evaluations.

    Returns
    -------
    list of dict
        By set: its seed, and what ``search`` found in each family; in ``OTHER_DEGREE`` too where none of
        degree 5 was found.
    """
    sets = []
    for seed in range(SETS[full]):
        waypoints = drawn_waypoints(seed)

        def best(name: str, waypoints: Array = waypoints) -> dict[str, Any]:
            return search(replace(task(name), waypoints=waypoints), full)

        entry: dict[str, Any] = {"seed": seed} | {name: best(name) for name in FAMILIES_COMPARED}
        if entry["b-spline-5"]["seconds"] is None:
            entry[OTHER_DEGREE] = best(OTHER_DEGREE)
        sets.append(entry)
    return sets


def sets_table(sets: list[dict[str, Any]]) -> Table:
    """Show each set: the best time of both families, or how far from feasible the best shape is.

    Parameters
    ----------
    sets : list of dict
        Of ``make_sets``.

    Returns
    -------
    Table
    """
    rows = []
    for entry in sets:
        spline_5, quintic = (entry[name] for name in FAMILIES_COMPARED)
        both = spline_5["seconds"] and quintic["seconds"]
        gain = percent(1.0 - spline_5["seconds"] / quintic["seconds"]) if both else ""
        rows.append([str(entry["seed"]), _told(spline_5), _told(quintic), gain])
    header = [
        "seed of the set",
        "B-spline of degree 5 [s]",
        "quintic spline [s]",
        "B-spline shorter by",
    ]
    caption = (
        "Best motion found within all limits, judged; CMA-ES on the logarithms of the durations, exact "
        "stretch, shapes beyond the position limits ranked by how far they leave them."
    )
    return Table(header, rows, caption, (1, 2, 3))


def _told(found: dict[str, Any]) -> str:
    if found["seconds"] is not None:
        return f"{found['seconds']:.3f}"
    least = min(found["excess"])
    return f"none found; the best shape is {least:.3f} rad ({math.degrees(least):.1f} deg) out"


def sets_remarks(sets: list[dict[str, Any]]) -> list[str]:
    """Say which family fails on which sets, and which is the shorter one on the others.

    Parameters
    ----------
    sets : list of dict
        Of ``make_sets``.

    Returns
    -------
    list of str
    """
    failed = {
        name: [entry for entry in sets if entry[name]["seconds"] is None] for name in FAMILIES_COMPARED
    }
    without, rival = (failed[name] for name in FAMILIES_COMPARED)
    remarks = [
        f"Further sets of waypoints, drawn alike: a quintic within all limits was found on "
        f"{len(sets) - len(rival)} of {len(sets)}, a B-spline on {len(sets) - len(without)} of {len(sets)}."
        + (" Only the B-spline fails." if without and not rival else "")
    ]
    for entry in without:
        found = entry["b-spline-5"]
        starts = found["excess"]
        alike = sum(e <= min(starts) + _SAME for e in starts)
        remarks.append(
            f"Set {entry['seed']}: no B-spline of degree 5 that keeps the position limits was found by "
            f"{len(starts)} starts. {alike} of them end at the same least excess, {min(starts):.3f} "
            "rad. This is no proof that there is none."
            + (f" The exact nonlinear program: {found['program']}." if found["program"] else "")
            + _cubic(entry[OTHER_DEGREE])
        )
    pairs = [
        (entry["b-spline-5"]["seconds"], entry["quintic"]["seconds"])
        for entry in sets
        if entry not in without and entry not in rival
    ]
    if pairs:
        gains = [1.0 - a / b for a, b in pairs]
        remarks.append(
            f"Where both have a motion ({len(pairs)} sets) the B-spline is the shorter one on "
            f"{sum(gain > 0.0 for gain in gains)}, in the median by {percent(float(np.median(gains)))}. Sets "
            f"without a B-spline: {listed([entry['seed'] for entry in without])}."
        )
    return remarks


def _cubic(found: dict[str, Any]) -> str:
    """Say what the other degree gives on a set without a B-spline of degree 5."""
    if found["seconds"] is not None:
        return f" In the other reading of the degree, 3, there is one: {found['seconds']:.3f} s."
    return (
        f" In the other reading of the degree, 3, {len(found['excess'])} starts find none either: "
        f"{min(found['excess']):.4f} rad."
    )
