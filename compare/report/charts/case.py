"""All interactive charts of one case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from compare.benchmark.grade import Trace
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row, RunKey
from compare.report.charts.case_motions import motions_of_case
from compare.report.charts.ladder import ladder_chart
from compare.report.charts.motions import arm_chart, motions_chart
from compare.report.charts.progress import progress_chart
from compare.report.charts.seeds import seeds_chart
from compare.report.charts.split import split_chart
from compare.report.motion_picture import arm_of
from formulations import Problem


def charts_of_case(
    problem: Problem,
    ladder: LadderRecord,
    rows: Sequence[Row],
    traces: Mapping[RunKey, list[Trace]],
) -> dict[str, Any]:
    """Return the data of every chart of one case.

    Parameters
    ----------
    problem : Problem
    ladder : LadderRecord
        Its bounds.
    rows : sequence of Row
        Its rows, judged again; gaps are relative to the best motion known.
    traces : mapping of RunKey to list of Trace
        The traces of their runs.

    Returns
    -------
    dict of str to dict
        By the name of the script that draws it: ``ladder``, ``seeds``, ``progress``, and where there is
        something to show ``motion``, ``arm`` and ``split``.
    """
    charts = {
        "ladder": ladder_chart(ladder, rows),
        "seeds": seeds_chart(rows),
        "progress": progress_chart(ladder, rows, traces),
    }
    motions = motions_of_case(problem, ladder, rows)
    if motions:
        charts["motion"] = motions_chart(problem, motions)
        arm = arm_of(problem.name)
        if arm is not None:
            charts["arm"] = arm_chart(arm, motions, problem)
    split = split_chart(problem, ladder, rows)
    if split["bars"]:
        charts["split"] = split
    return charts
