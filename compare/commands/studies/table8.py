"""``timebound table8``: Table 8 of Wang 2025 run again, with the bound that nobody can beat."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.commands.options import CORES, Jobs, Json, Out, Resume, positive
from compare.commands.studies import in_workers
from compare.papers.wang_2025 import joint_1
from compare.papers.wang_2025.tables.table_8 import as_text, table8_figure
from compare.studies.study import Call, Study

_BATCH = 50  # runs per call

STUDY = Study(
    name="table8",
    row=joint_1.JointOneRun,
    compute=joint_1.repeat,
    summarise=joint_1.summarise,
    text=lambda rows, summary: as_text(summary),
    figure=table8_figure,
)


def table8(
    *,
    runs: Annotated[int, Parameter(validator=positive)] = 1000,
    out: Out = "report",
    jobs: Jobs = CORES,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Run Table 8 of Wang 2025 again, and prove the bound that no run can beat.

    The protocol is the paper's: joint 1 alone, 50 particles, 50 iterations. Files: DIR/table8.csv,
    table8.json, figures/table8.svg.

    Parameters
    ----------
    runs
        Runs of each swarm; the first 10, as many as the paper has, are shown apart.
    """
    calls: list[Call] = [
        (limit, swarm, range(start, min(start + _BATCH, runs)))
        for limit in joint_1.LIMITS
        for swarm in joint_1.SWARMS
        for start in range(0, runs, _BATCH)
    ]
    return in_workers(STUDY, calls, out=out, jobs=jobs, resume=resume, json=json)
