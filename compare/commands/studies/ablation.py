"""``timebound ablation``: Table 3 of Wang 2025 run again, MIPSO without one strategy at a time."""

from __future__ import annotations

from compare.commands.options import CORES, Jobs, Json, Out, Resume
from compare.commands.studies import in_workers
from compare.papers.wang_2025 import ablation as runs
from compare.papers.wang_2025.cec2017 import ablation_figure, as_text
from compare.studies.study import Call, Study

_BATCH = 5  # runs per call


def ablation(
    *,
    full: bool = False,
    out: Out = "report",
    jobs: Jobs = CORES,
    resume: Resume = False,
    json: Json = None,
) -> int:
    """Run Table 3 of Wang 2025 again: MIPSO without one strategy at a time, on CEC2017.

    It needs pip install 'timebound[ablation]'. Files: DIR/ablation.csv, ablation.json,
    figures/ablation.svg.

    Parameters
    ----------
    full
        Take the paper's protocol: 500 iterations, 30 runs.
    """
    protocol = runs.FULL if full else runs.SHORT
    runs.require_packages()
    study = Study(
        name="ablation",
        row=runs.AblationRun,
        compute=runs.repeat,
        summarise=runs.summarise,
        text=lambda rows, summary: as_text(summary),
        figure=lambda rows, summary: ablation_figure(summary, protocol),
    )
    calls: list[Call] = [
        (number, swarm, protocol, range(start, min(start + _BATCH, protocol.runs)))
        for number in runs.PRINTED
        for swarm in ("mipso", *runs.STRATEGIES)
        for start in range(0, protocol.runs, _BATCH)
    ]
    return in_workers(study, calls, out=out, jobs=jobs, resume=resume, json=json)
