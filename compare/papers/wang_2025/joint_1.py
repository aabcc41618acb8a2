"""Joint 1 of the SR4C alone, as Wang 2025 runs it in sec. 4.2.2: its limits, runs and their statistics.

Table 8, Fig. 10, Table 10 and Figs 12-14 rest on this module. Table 6 limits the acceleration of joint 1
to 110 deg/s^2. But every time vector that Tables 9 and 10 print for joint 1 peaks at 60 deg/s^2 (59.98 to
60.00), so 60 deg/s^2 was in force. Both readings are run.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import stats

from compare.audit.paper import Paper, PrintedTimes, load_papers, settings
from compare.benchmark.grade import Run, grade
from formulations import FAMILIES, Problem, family_optimum, load
from formulations.problem.arrays import Array
from formulations.proofs.family import family_bound

TABLE_6, IN_FORCE = "as printed in table 6", "as tables 9 and 10 imply"
SWARMS = ["pso-1995", "pso-linear", "pso", "mipso", "mipso-printed"]
CONFIDENCE = 0.95


def _paper() -> Paper:
    return load_papers("wang_2025")[0]


def _table_6() -> tuple[float, float]:
    """Limits of joint 1 in Table 6 [deg/s, deg/s^2]."""
    velocity, acceleration, _ = np.degrees(_paper().stated["Table 6"].derivatives[:, 0])
    return round(float(velocity), 9), round(float(acceleration), 9)


LIMITS = {TABLE_6: _table_6(), IN_FORCE: (_table_6()[0], 60.0)}
"""Limits of joint 1 on velocity [deg/s] and acceleration [deg/s^2], by reading."""
PRINTED: dict[str, list[float]] = {
    by: [t.value.value for t in _paper().totals if (t.where, t.by) == ("Table 8", by)]
    for by in dict.fromkeys(t.by for t in _paper().totals if t.where == "Table 8")
}
"""The runs of Table 8 by method [s]."""
FEW = len(next(iter(PRINTED.values())))
"""Number of runs that Table 8 prints."""
POPULATION = int(settings("wang_2025")["swarm"]["population"])
ITERATIONS = int(settings("wang_2025")["swarm"]["iterations"])


@dataclass(frozen=True)
class JointOneRun:
    """One run: verified time of joint 1 [s], None if nothing feasible was found."""

    limit: str
    swarm: str
    seed: int
    seconds: float | None
    status: str


def under(velocity: float, acceleration: float) -> Problem:
    """Pose the task of joint 1 alone.

    Parameters
    ----------
    velocity : float [deg/s]
        Its limit.
    acceleration : float [deg/s^2]
        Its limit.

    Returns
    -------
    Problem
    """
    alone = load("sr4c").joint(0)
    speed, rate = np.radians([[velocity], [acceleration]])
    return replace(alone, limits=replace(alone.limits, velocity=speed, acceleration=rate))


def joint_1(limit: str) -> Problem:
    """Pose the task of joint 1 alone under one reading of its limits.

    Parameters
    ----------
    limit : str
        A key of ``LIMITS``.

    Returns
    -------
    Problem
    """
    return under(*LIMITS[limit])


def vectors() -> list[PrintedTimes]:
    """The time vectors that Tables 9 and 10 print for joint 1."""
    return [row for row in _paper().rows if row.joint == 0]


def accelerations() -> dict[str, float]:
    """Peak acceleration of joint 1 in each of ``vectors`` [deg/s^2], by table."""
    problem = load("sr4c").joint(0)
    family = FAMILIES[problem.family]
    found = {}
    for row in vectors():
        times = np.array([[time.value for time in row.times]])
        peak = float(np.degrees(family.peaks(problem, times)[0, 0, 1]))
        found[row.where.removesuffix(", joint 1").lower()] = peak
    return found


def repeat(
    limit: str, swarm: str, seeds: range, box: tuple[float, float] | None = None
) -> list[JointOneRun]:
    """Run one swarm under one reading of the limits, by the protocol of Table 8.

    A candidate that breaks a limit is out. The budget is the evaluations of 50 iterations and of the
    first population; mutants count.

    Parameters
    ----------
    limit : str
        A key of ``LIMITS``.
    swarm : str
        A name of ``ALGORITHMS``.
    seeds : range
        One run for each seed.
    box : tuple of float, optional [s]
        Another reading of the search box: least and greatest duration of each segment.

    Returns
    -------
    list of JointOneRun
    """
    problem = joint_1(limit)
    rows = []
    for seed in seeds:
        run = Run(f"sr4c joint 1 {limit}", "shared", swarm, seed,
                  POPULATION * (ITERATIONS + 1), POPULATION)  # fmt: skip
        row = grade(run, problem, None, "none", box).row
        rows.append(JointOneRun(limit, swarm, seed, row.seconds, row.status))
    return rows


def bounds(limit: str) -> tuple[float, float]:
    """Prove the least time of joint 1 alone.

    Parameters
    ----------
    limit : str
        A key of ``LIMITS``.

    Returns
    -------
    tuple of float [s]
        Certified lower bound and optimum.
    """
    problem = joint_1(limit)
    optimum = family_optimum(problem).seconds
    return family_bound(problem).seconds, optimum


def summarise(rows: list[JointOneRun]) -> dict[str, Any]:
    """Compute what Table 8 shows, of the first ten and of all runs.

    Parameters
    ----------
    rows : list of JointOneRun
        The runs of every swarm under both readings.

    Returns
    -------
    dict
        By reading of the limits: bound, optimum, ``statistics`` of each swarm and of the printed runs.
    """
    found: dict[str, Any] = {}
    for limit in LIMITS:
        lower, optimum = bounds(limit)
        swarms = {}
        for swarm in SWARMS:
            times = np.array(
                [r.seconds for r in rows if (r.limit, r.swarm) == (limit, swarm)], dtype=float
            )
            swarms[swarm] = {"few": statistics(times[:FEW]), "all": statistics(times)}
        printed = {name: statistics(np.array(times)) for name, times in PRINTED.items()}
        below = {name: int(sum(t < lower for t in times)) for name, times in PRINTED.items()}
        found[limit] = {
            "speed": LIMITS[limit][0], "acceleration": LIMITS[limit][1],
            "bound": lower, "optimum": optimum,
            "swarms": swarms, "printed": printed, "printed_below_bound": below,
        }  # fmt: skip
    return found


def statistics(times: Array) -> dict[str, Any]:
    """Describe the times of repeated runs.

    Parameters
    ----------
    times : Array, shape (n_runs,) [s]
        NaN for a run that found nothing feasible.

    Returns
    -------
    dict
        runs and unsolved (counts); mean, best, worst [s], None without a solved run; interval (95 %, of
        the mean, by Student's t) and deviation [s], None for fewer than two solved runs.
    """
    solved = times[np.isfinite(times)]
    n = len(solved)
    mean = float(solved.mean()) if n else None
    deviation = float(solved.std(ddof=1)) if n > 1 else None
    interval = None
    if mean is not None and deviation is not None:
        reach = float(stats.t.ppf(0.5 + 0.5 * CONFIDENCE, n - 1) * deviation / np.sqrt(n))
        interval = [mean - reach, mean + reach]
    return {
        "runs": len(times),
        "unsolved": len(times) - n,
        "mean": mean,
        "interval": interval,
        "deviation": deviation,
        "best": float(solved.min()) if n else None,
        "worst": float(solved.max()) if n else None,
    }
