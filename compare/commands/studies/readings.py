"""``timebound readings``: what each reading of a misprinted or open formula does."""

from __future__ import annotations

from compare.commands.options import CORES, Budget, Cases, Jobs, Json, Out, Resume, Seeds
from compare.commands.studies import in_workers
from compare.studies.readings import STUDY, calls
from formulations import CASES


def readings(
    *,
    cases: Cases = ("sr4c", "ur5", "cobot"),
    seeds: Seeds = 20,
    budget: Budget = 2550,
    out: Out = "report",
    jobs: Jobs = CORES,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Run each formula as printed and as it can be meant, on arm problems.

    Some printed formulas cannot be right, and some values are left open. The table shows what each
    reading of them leads to. Files: DIR/readings.csv, readings.json, figures/readings.svg.
    """
    listed = calls(list(cases or CASES), seeds, budget)
    return in_workers(STUDY, listed, out=out, jobs=jobs, resume=resume, json=json)
