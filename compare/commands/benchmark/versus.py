"""``timebound versus``: any two swarms, without the others."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.commands.benchmark.grading_options import Instances, graded_page
from compare.commands.options import CORES, Budget, Jobs, Json, OnCluster, Out, Seeds
from compare.grading.protocol import SEEDS, GradingProtocol


def versus(
    first: Annotated[str, Parameter(name="A")],
    second: Annotated[str, Parameter(name="B")],
    /,
    *,
    out: Out = "grade",
    json: Json = None,
    seeds: Seeds = SEEDS,
    budget: Budget = GradingProtocol.budget,
    cases: Instances = None,
    jobs: Jobs = CORES,
    cluster: OnCluster = None,
) -> int:
    """Compare two swarms on the held-out instances, with the same seeds and budget.

    The verdict is that of ``timebound grade``; the page is DIR/versus.html.

    Parameters
    ----------
    first
        mine.py:swarm, module:function, library:Name, or a name of docs/reference/algorithms.md.
    second
        The other one.
    seeds
        Number of seeds.
    budget
        Evaluations of each run, over the whole motion.
    """
    return graded_page(
        first, second, "versus", (),
        out=out, json=json, seeds=seeds, budget=budget, cases=cases, jobs=jobs, cluster=cluster, zero=False,
    )  # fmt: skip
