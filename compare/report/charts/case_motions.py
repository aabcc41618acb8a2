"""The motions that the page shows beside each other: the published one, the best spline, the fastest of all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from compare.audit.motion.printed_motion import PrintedMotion
from compare.benchmark.known_times import paper_of_case
from compare.benchmark.ladders import LadderRecord, PiecesRecord
from compare.benchmark.records.rows import Row, durations_of
from compare.benchmark.summaries import best_claim
from compare.report.charts.motions import ShownMotion
from formulations import FAMILIES, Problem, Trajectory, check


def motions_of_case(
    problem: Problem, ladder: LadderRecord, rows: Sequence[Row] = ()
) -> list[ShownMotion]:
    """Return up to three motions of a problem.

    Parameters
    ----------
    problem : Problem
    ladder : LadderRecord
        Its bounds, with the pieces of the fastest motion.
    rows : sequence of Row
        Runs on it; the best claim stands in where no paper prints durations of the whole arm.

    Returns
    -------
    list of ShownMotion
        Those that there are: published or claimed, best of the family, fastest.
    """
    found = []
    claimed = published_motion(problem) or _claim(problem, rows)
    if claimed is not None:
        name, motion = claimed
        found.append(ShownMotion("published", f"{name}, {_judged(problem, motion)}", motion))
    durations = ladder["durations"].get("family")
    if durations is not None:
        motion = FAMILIES[problem.family].trajectory(problem, np.array(durations))
        title = f"best {problem.family} spline, {_judged(problem, motion)}"
        found.append(ShownMotion("family", title, motion))
    pieces = ladder.get("fastest")
    if pieces is not None:
        motion = from_pieces(pieces)
        found.append(ShownMotion("fastest", f"fastest motion, {_judged(problem, motion)}", motion))
    return found


def published_motion(problem: Problem) -> tuple[str, Trajectory] | None:
    """Return the shortest motion of the whole arm that the paper of a case prints.

    Parameters
    ----------
    problem : Problem
        The problem of the case.

    Returns
    -------
    tuple of str and Trajectory, or None
        What it is; None where no paper belongs to the problem or it prints no durations.
    """
    paper = paper_of_case(problem.name)
    wholes = [] if paper is None else [row for row in paper.rows if row.joint is None]
    if paper is None or not wholes:
        return None
    printed = min((PrintedMotion.of(paper, row) for row in wholes), key=lambda one: one.total)
    motion = FAMILIES[problem.family].trajectory(problem, printed.times)
    return f"published ({printed.row.by})", motion


def from_pieces(pieces: PiecesRecord) -> Trajectory:
    """Return a stored motion.

    Parameters
    ----------
    pieces : PiecesRecord

    Returns
    -------
    Trajectory
    """
    return Trajectory(
        np.array(pieces["durations"]), np.array(pieces["coefficients"]), np.array(pieces["passages"])
    )


def _claim(problem: Problem, rows: Sequence[Row]) -> tuple[str, Trajectory] | None:
    """The shortest claim in the papers' coding: the verified motion, faster by one factor."""
    row = best_claim(rows)
    if row is None or row.claimed is None or row.seconds is None:
        return None
    durations = durations_of(row) * (row.claimed / row.seconds)
    return f"best claim ({row.swarm})", FAMILIES[problem.family].trajectory(problem, durations)


def _judged(problem: Problem, motion: Trajectory) -> str:
    """Its time, and what the check says."""
    verdict = check(problem, motion)
    kept = "keeps its limits" if verdict.feasible else f"breaks limits: {verdict.worst}"
    return f"{motion.seconds:.4f} s, {kept}"
