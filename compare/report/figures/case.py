"""Draw and save all figures of one case."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from compare.benchmark.grade import Trace
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import Row, RunKey
from compare.benchmark.summaries import times_of
from compare.files import write_text
from compare.report.figures import convergence_figure, gap_figure, ladder_figure, motion_figure
from compare.report.motion_picture import fastest_spline
from compare.report.style import STYLE
from compare.statistics.medians import lower_median
from compare.studies.time_split import Share, split, split_figure
from formulations import Problem


def draw_case(
    folder: Path,
    case: str,
    problem: Problem,
    ladder: LadderRecord,
    rows: Sequence[Row],
    traces: Mapping[RunKey, list[Trace]],
) -> list[str]:
    """Draw every figure of one case into DIR/figures: as SVG; the moving arm too.

    Parameters
    ----------
    folder : Path
        Folder of the report.
    case : str
    problem : Problem
    ladder : LadderRecord
        Its bounds.
    rows : sequence of Row
        Its rows, judged again.
    traces : mapping of RunKey to list of Trace
        The traces of their runs.

    Returns
    -------
    list of str
        Names of the figures, without ending.
    """
    draw: dict[str, Callable[[], Figure]] = {
        "ladder": lambda: ladder_figure(problem, ladder, rows),
        "gaps": lambda: gap_figure(problem, rows),
        "convergence": lambda: convergence_figure(problem, ladder, rows, traces),
        "motion": lambda: motion_figure(problem, ladder, rows),
        "split": lambda: where_the_time_goes(problem, ladder, rows),
    }
    mpl.use("Agg")  # a worker has no screen
    target = folder / "figures"
    target.mkdir(exist_ok=True)
    names = []
    for name, make in draw.items():
        figure = make()
        with mpl.rc_context(STYLE):
            figure.savefig(target / f"{case}-{name}.svg", metadata={"Date": None})
        plt.close(figure)
        names.append(f"{case}-{name}")
    durations = ladder["durations"].get("family")
    arm = None if durations is None else fastest_spline(case, problem, np.array(durations))
    if arm is not None:
        write_text(target / f"{case}-arm.svg", arm)
        names.append(f"{case}-arm")
    else:  # an earlier comparison in this folder may have left one
        (target / f"{case}-arm.svg").unlink(missing_ok=True)
    return names


def where_the_time_goes(problem: Problem, ladder: LadderRecord, rows: Sequence[Row]) -> Figure:
    """Draw the shares of lost time of one swarm's median motion, in each variant of a coding.

    Parameters
    ----------
    problem : Problem
    ladder : LadderRecord
        Its bounds.
    rows : sequence of Row
        Its rows.

    Returns
    -------
    Figure
    """
    swarm, splits = splits_of(problem, ladder, rows)
    return split_figure(f"{problem.name}: where the time of {swarm} goes (median seed)", splits)


def splits_of(
    problem: Problem, ladder: LadderRecord, rows: Sequence[Row]
) -> tuple[str, dict[str, list[Share]]]:
    """Split the median time of one swarm into its shares, in each variant of a coding.

    Parameters
    ----------
    problem : Problem
    ladder : LadderRecord
        Its bounds.
    rows : sequence of Row
        Its rows; PSO is taken if it ran, else the swarm of the first row.

    Returns
    -------
    swarm : str
    splits : dict of str to list of Share
        By variant; without those that have no verified motion.
    """
    swarm = rows[0].swarm if all(row.swarm != "pso" for row in rows) else "pso"
    splits = {}
    for variant in dict.fromkeys(row.variant for row in rows):
        mine = [row for row in rows if row.swarm == swarm and row.variant == variant]
        times = times_of(mine)
        if times and ladder["ladder"]["free_form"]["seconds"]:
            seconds = float(lower_median(times))
            splits[variant] = split(problem, ladder["ladder"], seconds, mine[0].coding)
    return swarm, splits
