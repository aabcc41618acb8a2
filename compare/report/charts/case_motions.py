"""The motions that the page shows beside each other: the published one, the best spline, the fastest of all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from compare.audit.motion.printed_motion import Kept, PrintedMotion
from compare.benchmark.known_times import paper_of_case
from compare.benchmark.ladders import LadderRecord, PiecesRecord
from compare.benchmark.records.rows import Row, durations_of
from compare.benchmark.summaries import best_claim
from compare.report.charts.motions import SLACK, ShownMotion
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
        found.append(claimed)
    durations = ladder["durations"].get("family")
    if durations is not None:
        motion = FAMILIES[problem.family].trajectory(problem, np.array(durations))
        title = f"best {problem.family} spline, {judged(problem, motion)}"
        found.append(ShownMotion("family", title, motion))
    pieces = ladder.get("fastest")
    if pieces is not None:
        motion = from_pieces(pieces)
        found.append(ShownMotion("fastest", f"fastest motion, {judged(problem, motion)}", motion))
    return found


def published_motion(problem: Problem) -> ShownMotion | None:
    """Return the shortest motion of the whole arm that the paper of a case prints.

    Parameters
    ----------
    problem : Problem
        The problem of the case.

    Returns
    -------
    ShownMotion or None
        None where no paper belongs to the problem or it prints no durations.
    """
    paper = paper_of_case(problem.name)
    wholes = [] if paper is None else [row for row in paper.rows if row.joint is None]
    if paper is None or not wholes:
        return None
    printed = min((PrintedMotion.of(paper, row) for row in wholes), key=lambda one: one.total)
    motion = FAMILIES[problem.family].trajectory(problem, printed.times)
    words, slack = judged(problem, motion), SLACK
    if printed.kept in (Kept.YES, Kept.WITHIN_ROUNDING):
        words = f"{motion.seconds:.4f} s, keeps its limits within the rounding of what is printed"
        slack = max(SLACK, printed.verdict.stretch**3 - 1.0)
    return ShownMotion("published", f"published ({printed.row.by}), {words}", motion, slack)


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


def _claim(problem: Problem, rows: Sequence[Row]) -> ShownMotion | None:
    """The shortest claim in the papers' coding: the verified motion, faster by one factor."""
    row = best_claim(rows)
    if row is None or row.claimed is None or row.seconds is None:
        return None
    durations = durations_of(row) * (row.claimed / row.seconds)
    motion = FAMILIES[problem.family].trajectory(problem, durations)
    title = f"best claim in the papers' coding ({row.swarm}), {judged(problem, motion)}"
    return ShownMotion("published", title, motion)


def judged(problem: Problem, motion: Trajectory) -> str:
    """Say how long a motion takes, and what the check finds.

    Parameters
    ----------
    problem : Problem
    motion : Trajectory

    Returns
    -------
    str
    """
    verdict = check(problem, motion)
    kept = "keeps its limits" if verdict.feasible else f"breaks limits: {verdict.worst}"
    return f"{motion.seconds:.4f} s, {kept}"
