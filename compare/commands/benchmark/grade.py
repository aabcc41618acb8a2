"""``timebound grade``: what a swarm is worth, in one verdict and one page."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.commands.benchmark.grading_options import Instances, graded_page
from compare.commands.options import CORES, Budget, Jobs, Json, OnCluster, Out, Seeds
from compare.grading.protocol import CONTROLS, SEEDS, GradingProtocol


def grade_swarm(
    swarm: Annotated[str, Parameter(name="SWARM")],
    /,
    *,
    against: Annotated[str, Parameter(metavar="SWARM")] = "pso",
    out: Out = "grade",
    json: Json = None,
    seeds: Seeds = SEEDS,
    budget: Budget = GradingProtocol.budget,
    cases: Instances = None,
    jobs: Jobs = CORES,
    cluster: OnCluster = None,
) -> int:
    """Say whether a swarm is better than another one, where, by how much, and whether it could be chance.

    Both run on the held-out instances of the benchmark, with the same seeds and budget, beside CMA-ES,
    differential evolution and random search. The verdict is better, worse, equal or undecided, by the
    rule of docs/methods/grade.md; the page is DIR/grade.html. Runs are kept in DIR/results.sqlite: a second
    call computes nothing again.

    Parameters
    ----------
    swarm
        mine.py:swarm, module:function, library:Name of mealpy, pymoo, nevergrad, minion, or a name of
        docs/reference/algorithms.md.
    against
        The swarm that it is compared with, named in the same ways.
    seeds
        Number of seeds. With few of them the verdict is undecided, and the page says how many it takes.
    budget
        Evaluations of each run, over the whole motion.
    """
    return graded_page(
        swarm, against, "grade", CONTROLS,
        out=out, json=json, seeds=seeds, budget=budget, cases=cases, jobs=jobs, cluster=cluster, zero=True,
    )  # fmt: skip
