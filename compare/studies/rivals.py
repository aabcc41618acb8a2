"""The fastest motion beside Drake's and pyroboplan's: the study behind ``timebound rivals``.

Neither is needed by anything else: ``pip install drake``, ``pip install pyroboplan``.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.screen import table
from compare.studies.free_form_study import cases, random_problems
from compare.studies.planners import RivalRun, drake, ours, pyroboplan
from compare.studies.study import Call, Study
from formulations import Problem

PACKAGES = {"drake": "pydrake", "pyroboplan": "pyroboplan"}


def installed(names: Sequence[str]) -> list[str]:
    """Choose the rivals that are installed.

    Parameters
    ----------
    names : sequence of str
        Keys of PACKAGES.

    Returns
    -------
    list of str
        Those of them whose package is there.
    """
    return [name for name in names if importlib.util.find_spec(PACKAGES[name]) is not None]


def set_beside(
    problem: Problem, names: tuple[str, ...], points: int, evaluations: int
) -> list[RivalRun]:
    """Run the free-form motion and the rivals on one problem.

    Parameters
    ----------
    problem : Problem
        The task.
    names : tuple of str
        Keys of PACKAGES.
    points : int
        Control points per segment for Drake.
    evaluations : int
        Splines that Drake may try.

    Returns
    -------
    list of RivalRun
        The free-form motion first.
    """
    first, motion = ours(problem)
    runs = [first]
    if "drake" in names:
        runs += drake(problem, points, evaluations, motion)
    if "pyroboplan" in names:
        runs += pyroboplan(problem, motion)
    return runs


def calls(names: Sequence[str], count: int, points: int, evaluations: int) -> list[Call]:
    """List the calls of the study: the cases and random problems that have an acceleration limit.

    Without one no motion is the fastest, so that there is nothing to compare.

    Parameters
    ----------
    names : sequence of str
        Keys of PACKAGES.
    count : int
        Random problems.
    points : int
        Control points per segment for Drake.
    evaluations : int
        Splines that Drake may try.

    Returns
    -------
    list of tuples
        Arguments of ``set_beside``.
    """
    return [
        (problem, tuple(names), points, evaluations)
        for problem in (*cases(), *random_problems(count, 0))
        if problem.limits.has_acceleration
    ]


def summarise(runs: list[RivalRun]) -> dict[str, Any]:
    """Take the median of the time over ours, by planner.

    Parameters
    ----------
    runs : list of RivalRun
        All rows.

    Returns
    -------
    dict
        By planner: problems, solved, and the median excess over the free-form motion [1].
    """
    found = {}
    for planner in dict.fromkeys(run.planner for run in runs):
        mine = [(run, excess) for run, excess in zip(runs, _excess(runs), strict=True)
                if run.planner == planner]  # fmt: skip
        solved = [excess for _, excess in mine if excess is not None]
        found[planner] = {
            "problems": len(mine),
            "solved": len(solved),
            "median_excess": float(np.median(solved)) if solved else None,
        }
    return found


def _excess(runs: list[RivalRun]) -> list[float | None]:
    """Time over that of the free-form motion, which comes first for each problem, minus 1."""
    found: list[float | None] = []
    reference: float | None = None
    for run in runs:
        reference = run.seconds if run.planner == "free form" else reference
        missing = run.seconds is None or reference is None
        found.append(None if missing else run.seconds / reference - 1.0)  # type: ignore[operator]
    return found


def as_text(runs: list[RivalRun], summary: dict[str, Any]) -> str:
    """Lay the runs out as a table.

    Parameters
    ----------
    runs : list of RivalRun
        All rows.
    summary : dict
        Of ``summarise``.

    Returns
    -------
    str
        A line per planner and problem.
    """
    rows = [
        [
            run.problem,
            run.planner,
            "-" if run.seconds is None else f"{run.seconds:.6f}",
            "-" if excess is None else f"{100.0 * excess:+.3f}",
            f"{run.runtime:.2f}",
            run.note,
        ]
        for run, excess in zip(runs, _excess(runs), strict=True)
    ]
    header = ["problem", "planner", "time [s]", "longer [%]", "wall [s]", "note"]
    return table(header, rows, right=(2, 3, 4))


STUDY = Study(
    name="rivals",
    row=RivalRun,
    compute=set_beside,
    summarise=summarise,
    text=as_text,
)
