"""Zhang 2025, sec. 2.3: two layers, each joint alone first, then the whole arm from the joints' results."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.benchmark.grade import Graded, durations_of
from compare.benchmark.objective import search_box
from compare.benchmark.protocol import Budget
from compare.papers.item import Table
from compare.papers.measure import judged, summary, trials
from compare.papers.verdicts import more_often, pairs_won
from compare.papers.zhang_2025.paper import BUDGET
from formulations import Problem, longest_segment
from formulations.problem.arrays import Array

SWARM = "pso-zhang-2025"
READINGS = {
    "longest": "from the longest times per segment",
    "all": "from the longest times and each joint's own",
    "slowed": "from the longest times, slowed until they keep the limit",
    "afresh": "afresh",
    "afresh, all evaluations": "afresh, with the evaluations of both layers",
}
"""How the whole arm's search starts; the first is the default."""


def first_layer(problem: Problem, runs: int) -> list[list[Graded]]:
    """Search each joint alone.

    Parameters
    ----------
    problem : Problem
        The whole arm.
    runs : int
        Number of runs, with seeds 0, 1, ...

    Returns
    -------
    list of (list of Graded)
        Runs by joint.
    """
    return [trials(problem.joint(j), SWARM, BUDGET, runs) for j in range(problem.dof)]


def integrated(problem: Problem, alone: list[list[Graded]]) -> list[Array]:
    """Put the joints' results together, run by run, with no evaluation.

    Parameters
    ----------
    problem : Problem
        The whole arm.
    alone : list of (list of Graded)
        Of ``first_layer``; each run has solved its joint.

    Returns
    -------
    list of Array, shape (2 + dof, n_segments) [s]
        Per run: the longest time of each segment over the joints; each joint's times; the longest times,
        slowed until the arm keeps its limits.
    """
    lo, hi = search_box(problem)  # a joint alone may have gone below the arm's box
    found = []
    for graded in zip(*alone, strict=True):
        vectors = [durations_of(g.row) for g in graded]
        rule = longest_segment(problem, vectors)
        found.append(np.clip([rule.claimed, *vectors, rule.durations], lo, hi))
    return found


def second_layer(problem: Problem, starts: list[Array], reading: str = "longest") -> list[Graded]:
    """Search the whole arm, a run per start.

    Parameters
    ----------
    problem : Problem
        The whole arm.
    starts : list of Array, shape (2 + dof, n_segments) [s]
        Of ``integrated``.
    reading : str
        A key of ``READINGS``.

    Returns
    -------
    list of Graded
        Runs of one seed have the same random numbers in each reading.
    """
    rows = {"longest": slice(1), "all": slice(-1), "slowed": slice(-1, None)}.get(reading)
    given = None if rows is None else [start[rows] for start in starts]
    budget = BUDGET
    if reading == "afresh, all evaluations":
        times = 1 + problem.dof
        budget = Budget(BUDGET.population, times * (BUDGET.iterations + 1) - 1)
    return trials(problem, SWARM, budget, len(starts), starts=given)


def make_layers(problem: Problem, alone: list[list[Graded]]) -> dict[str, Any]:
    """Compare the readings of the second layer, and judge the longest times that it starts from.

    Parameters
    ----------
    problem : Problem
        The whole arm.
    alone : list of (list of Graded)
        Of ``first_layer``.

    Returns
    -------
    dict
        readings: summary and evaluations of each; starts: judged, by seed.
    """
    starts = integrated(problem, alone)
    found = {reading: second_layer(problem, starts, reading) for reading in READINGS}
    first = sum(runs[0].row.evaluations for runs in alone)
    return {
        "readings": {
            reading: {
                **summary(runs),
                "evaluations": runs[0].row.evaluations + (0 if "afresh" in reading else first),
            }
            for reading, runs in found.items()
        },
        "starts": [judged(problem, start[0]) for start in starts],
    }


def layers_table(layers: dict[str, Any], bound: float) -> Table:
    """Show the readings of the second layer side by side.

    Parameters
    ----------
    layers : dict
        Of ``make_layers``.
    bound : float [s]
        Certified optimum of the whole arm.

    Returns
    -------
    Table
    """
    lines = []
    for reading, found in layers["readings"].items():
        gaps = np.array([s if s is not None else np.inf for s in found["by_seed"]]) / bound - 1.0
        quartiles = (f"{q:.1e}" for q in np.quantile(gaps, [0.25, 0.5, 0.75], method="nearest"))
        pairs = "" if reading == "afresh" else f"{lower(layers, reading):g} of {len(gaps)}"
        lines.append([READINGS[reading], str(found["evaluations"]), f"{found['median']:.5f}",
                      *quartiles, pairs])  # fmt: skip
    header = ["the whole arm's search starts", "evaluations", "median [s]", "gap, 25 %", "median", "75 %",
              "lower than afresh"]  # fmt: skip
    caption = (
        f"Sec. 2.3: the second layer. Gaps to the certified optimum of {bound:.5f} s; runs of one seed have "
        "the same random numbers, a tie counts half."
    )
    return Table(header, lines, caption, range(1, 7))


def lower(layers: dict[str, Any], reading: str, rival: str = "afresh") -> float:
    """On how many seeds one reading ends lower than another; a tie counts half."""
    readings = layers["readings"]
    return pairs_won(readings[reading]["by_seed"], readings[rival]["by_seed"])


def layers_remarks(layers: dict[str, Any], bound: float) -> list[str]:
    """Say whether the first layer helps the second, and what it costs.

    Parameters
    ----------
    layers : dict
        Of ``make_layers``.
    bound : float [s]
        Certified optimum of the whole arm.

    Returns
    -------
    list of str
        Remarks of the page.
    """
    readings, starts = layers["readings"], layers["starts"]
    n = len(starts)
    gap = {key: found["median"] / bound - 1.0 for key, found in readings.items()}
    compared = [
        f"{READINGS[key]} it ends lower on {lower(layers, key):g} of {n} seeds, "
        f"{more_often(lower(layers, key) / n, n)} (median gap {gap[key]:.1e})"
        for key in ("longest", "all", "slowed")
    ]
    kept = sum(start["keeps"] for start in starts)
    wins = lower(layers, "afresh, all evaluations", "longest")
    return [
        "Sec. 2.3: the search of the whole arm starts from the joints' results. Beside the same search that "
        f"starts afresh (median gap {gap['afresh']:.1e}): {'; '.join(compared)}.",
        f"The longest times of the first layer keep the limit on {kept} of {n} seeds; they would have to be "
        f"stretched by a factor of up to {max(start['stretch'] for start in starts):.4f}."
        + (" Where they break it, the particle that starts there is infeasible." if kept < n else ""),
        f"Both layers take {readings['longest']['evaluations']} evaluations. Spent on the whole arm at once, "
        f"from a fresh start, as many end at a median gap of {gap['afresh, all evaluations']:.1e}, lower than "
        f"the two layers on {wins:g} of {n} seeds: {more_often(wins / n, n)}.",
    ]
