"""What a table or figure measures of a task: repeated runs, the certified optimum, given times judged."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.paper import Paper, PrintedTimes
from compare.benchmark.grade import Graded, Run, durations_of, grade
from compare.benchmark.protocol import Budget
from formulations import FAMILIES, Problem, Trajectory, Verdict, check, family_bound, ladder
from formulations.motion.verdict import QUANTITIES
from formulations.problem.arrays import Array


def trials(
    problem: Problem,
    swarm: str,
    budget: Budget,
    runs: int,
    box: tuple[float, float] | None = None,
    *,
    starts: Sequence[ArrayLike] | None = None,
    **reading: float,
) -> list[Graded]:
    """Run a swarm as the papers do: an infeasible candidate has the worst fitness.

    Parameters
    ----------
    problem : Problem
        The task.
    swarm : str
        A name of ``ALGORITHMS``.
    budget : Budget
        Population and iterations.
    runs : int
        Number of runs, with seeds 0, 1, ...
    box : tuple of float, optional [s]
        Another reading of the box that the swarm searches: least and greatest duration of each segment.
    starts : sequence of array_like, shapes (m, n_segments) [s], optional
        Vectors from which each run starts.
    **reading : number or bool
        Parameters of the swarm in place of its defaults.

    Returns
    -------
    list of Graded
        Each is judged by the independent check.
    """
    size, constants = (budget.evaluations, budget.population), tuple(reading.items())
    asked = [
        Run(problem.name, "shared", swarm, seed, *size, constants=constants) for seed in range(runs)
    ]
    return [
        grade(run, problem, None, "none", box, None if starts is None else starts[run.seed])
        for run in asked
    ]


def summary(found: Sequence[Graded]) -> dict[str, Any]:
    """Collect the times of repeated runs and the durations of the median run.

    Parameters
    ----------
    found : sequence of Graded
        Runs of one swarm.

    Returns
    -------
    dict
        runs (a count), by_seed (verified times in the order of the runs [s], None where there is none), seconds
        (the same, rising, without None), median [s] and durations of the median run (the lower one of two; None
        without a solved run).
    """
    solved = sorted((g.row.seconds, g.run.seed) for g in found if g.row.seconds is not None)
    vectors = {g.run.seed: durations_of(g.row).tolist() for g in found}
    median = solved[(len(solved) - 1) // 2] if solved else None
    return {
        "runs": len(found),
        "by_seed": [g.row.seconds for g in found],
        "seconds": [seconds for seconds, _ in solved],
        "median": None if median is None else median[0],
        "durations": None if median is None else vectors[median[1]],
    }


def least(problem: Problem) -> dict[str, Any]:
    """Prove the optimum of the problem's family.

    The proof goes on to a gap of 1e-6, however long it takes, so that it ends alike on every machine.

    Parameters
    ----------
    problem : Problem
        The task.

    Returns
    -------
    dict
        bound (certified) and optimum (best verified time) [s], durations [s].
    """
    found = family_bound(problem, gap=1e-6)
    durations = None if found.durations is None else found.durations.tolist()
    return {"bound": found.seconds, "optimum": found.upper, "durations": durations}


def every_motion(problem: Problem) -> float:
    """Prove that no motion at all is faster.

    It is the rung of the report's ladder, climbed in the same way, so that chapters and report say one number.

    Parameters
    ----------
    problem : Problem
        The task; its family does not matter.

    Returns
    -------
    float [s]
    """
    key = "free_form_lower"
    return ladder(problem, rungs=("free_form", key)).seconds(key) or 0.0


def spline(problem: Problem, durations: ArrayLike) -> Trajectory:
    """Make the motion of the problem's family.

    Parameters
    ----------
    problem : Problem
        The task.
    durations : array_like, shape (n_segments,) [s]
        Of the segments.

    Returns
    -------
    Trajectory
    """
    return FAMILIES[problem.family].trajectory(problem, np.asarray(durations, dtype=np.float64))


def peaks(trajectory: Trajectory) -> Array:
    """Greatest |velocity| and |acceleration| of each joint.

    Parameters
    ----------
    trajectory : Trajectory
        The motion.

    Returns
    -------
    Array, shape (2, dof) [rad/s, rad/s^2]
    """
    found = [trajectory.extremes(order) for order in (1, 2)]
    return np.array([np.maximum(-e.low, e.high).max(axis=0) for e in found])


def judged(problem: Problem, durations: ArrayLike) -> dict[str, Any]:
    """Judge the spline with given durations by the independent check.

    Parameters
    ----------
    problem : Problem
        The task.
    durations : array_like, shape (n_segments,) [s]
        Of the segments.

    Returns
    -------
    dict
        durations, seconds, keeps (the limits), stretch, most (``used_most``), faults.
    """
    times: Array = np.asarray(durations, dtype=np.float64)
    verdict = check(problem, spline(problem, times))
    return {
        "durations": times.tolist(),
        "seconds": verdict.seconds,
        "keeps": verdict.feasible,
        "stretch": verdict.stretch,
        "most": used_most(verdict),
        "faults": list(verdict.faults),
    }


def judged_row(paper: Paper, row: PrintedTimes) -> dict[str, Any]:
    """Judge a printed time vector under its stated limits, for every reading of the digits.

    Parameters
    ----------
    paper : Paper
        What the paper prints.
    row : PrintedTimes
        One of its time vectors.

    Returns
    -------
    dict
        where, times and total (as printed), seconds, keeps (yes, no, or within rounding), stretch, most
        (``used_most``).
    """
    motion = PrintedMotion.of(paper, row)
    return {
        "where": row.where,
        "times": [str(time) for time in row.times],
        "total": None if row.total is None else str(row.total),
        "seconds": motion.total,
        "keeps": motion.kept.value,
        "stretch": motion.verdict.stretch,
        "most": used_most(motion.verdict),
    }


def used_most(verdict: Verdict) -> str:
    """Say which limit a motion uses most, and how much of it.

    Parameters
    ----------
    verdict : Verdict
        What the independent check says of the motion.

    Returns
    -------
    str
    """
    found = [peak for peak in verdict.peaks if peak.quantity != QUANTITIES[0]]
    if not found:
        return "nothing limited"
    peak = max(found, key=lambda p: p.stretch)
    return f"{peak.quantity} of joint {peak.joint + 1}, {100 * peak.factor:.1f} % of its limit"
