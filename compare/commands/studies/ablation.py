"""``timebound ablation``: Table 3 of Wang 2025 run again, MIPSO without one strategy at a time."""

from __future__ import annotations

from compare.commands.options import CORES, Jobs, Json, Out, Resume
from compare.commands.studies import in_workers
from compare.papers.wang_2025 import cec2017
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
    protocol = cec2017.FULL if full else cec2017.SHORT
    cec2017.cec2017(3, 10)  # says at once what is missing
    cec2017.holm([0.5])
    study = Study(
        name="ablation",
        row=cec2017.Row,
        compute=cec2017.repeat,
        summarise=cec2017.summarise,
        text=lambda rows, summary: cec2017.as_text(summary),
        figure=lambda rows, summary: cec2017.ablation_figure(summary, protocol),
    )
    calls: list[Call] = [
        (number, swarm, protocol, range(start, min(start + _BATCH, protocol.runs)))
        for number in cec2017.PRINTED
        for swarm in ("mipso", *cec2017.STRATEGIES)
        for start in range(0, protocol.runs, _BATCH)
    ]
    return in_workers(study, calls, out=out, jobs=jobs, resume=resume, json=json)
