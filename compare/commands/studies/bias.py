"""``timebound bias``: which swarms are drawn to zero, and by how much."""

from __future__ import annotations

from compare.benchmark.protocol import swarms_of
from compare.commands.options import CORES, Budget, Cases, Jobs, Json, Out, Resume, Seeds, Swarms
from compare.commands.studies import in_workers
from compare.studies.drawn_to_zero.bias import STUDY, calls
from compare.studies.drawn_to_zero.centred_functions import FUNCTIONS
from formulations import CASES


def bias(
    *,
    swarms: Swarms = None,
    cases: Cases = ("sr4c", "ur5", "cobot", "bagging"),
    seeds: Seeds = 10,
    budget: Budget = 5000,
    out: Out = "report",
    jobs: Jobs = CORES,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Measure which swarms are drawn to zero.

    The table shows by which factor the median error of each swarm grows when the optimum of a
    function, or the zero of its coordinates, is moved. A swarm that does not know where zero is has
    the factor 1. Files: DIR/bias.csv, bias.json, figures/bias.svg.
    """
    wanted = list(swarms or swarms_of("default"))
    listed = calls(list(FUNCTIONS), list(cases or CASES), wanted, seeds, budget)
    return in_workers(STUDY, listed, out=out, jobs=jobs, resume=resume, json=json)
