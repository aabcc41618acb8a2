"""Candidate checks per second, beside the papers' way: the study behind ``timebound speed``.

Each way checks the same candidates of the same arm, in turn, and the best of several rounds counts. Add
another way to WAYS.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.screen import table
from compare.studies.study import Study
from formulations import FAMILIES, Problem, check
from formulations.problem.arrays import Array

SAMPLES = 100  # per segment, as the papers' scripts do


def compiled(problem: Problem, durations: Array) -> Array:
    """Compute the least feasible stretch by the compiled exact peaks.

    Parameters
    ----------
    problem : Problem
        A 3-5-3 problem.
    durations : Array, shape (n, 3) [s]
        Candidates.

    Returns
    -------
    Array, shape (n,)
        Least feasible stretch [1].
    """
    return FAMILIES[problem.family].stretch(problem, durations)


def matrix_and_samples(problem: Problem, durations: Array) -> Array:
    """Compute it the papers' way: solve a 14x14 system, and find peaks among 100 samples per segment.

    It takes whole blocks of candidates at once, which no paper does: this is its best in NumPy.

    Parameters
    ----------
    problem : Problem
        A 3-5-3 problem.
    durations : Array, shape (n, 3) [s]
        Candidates.

    Returns
    -------
    Array, shape (n,)
        Least feasible stretch [1].
    """
    found = []
    for block in np.array_split(durations, max(len(durations) // 200, 1)):
        k = np.linalg.solve(_matrix(block), _right_side(problem)[None])  # (n, 14, dof)
        factor = np.zeros(len(block))
        for segment, (first, degree) in enumerate(((0, 3), (4, 5), (10, 3))):
            t = block[:, segment, None] * np.linspace(0.0, 1.0, SAMPLES)
            powers = np.arange(degree, -1, -1)  # highest first, as printed
            c = k[:, first : first + degree + 1]
            for order, limit in enumerate(problem.limits.derivatives, start=1):
                if not np.isfinite(limit).any():
                    continue
                slopes = np.ones(degree + 1)
                for i in range(order):
                    slopes = slopes * np.maximum(powers - i, 0)
                basis = slopes * t[..., None] ** np.maximum(powers - order, 0)
                peak = np.abs(np.einsum("nsp,npj->nsj", basis, c)).max(axis=1)
                factor = np.maximum(factor, (peak / limit).max(axis=1) ** (1.0 / order))
        found.append(factor)
    return np.concatenate(found)


def one_by_one(problem: Problem, durations: Array) -> Array:
    """Compute the same for one candidate at a time: a loop over the swarm, as in the papers' scripts.

    Parameters
    ----------
    problem : Problem
        A 3-5-3 problem.
    durations : Array, shape (n, 3) [s]
        Candidates.

    Returns
    -------
    Array, shape (n,)
        Least feasible stretch [1].
    """
    return np.concatenate([matrix_and_samples(problem, row[None]) for row in durations])


def independent_check(problem: Problem, durations: Array) -> Array:
    """Compute it by the check that judges reported numbers: exact, one motion at a time.

    Parameters
    ----------
    problem : Problem
        A 3-5-3 problem.
    durations : Array, shape (n, 3) [s]
        Candidates.

    Returns
    -------
    Array, shape (n,)
        Least feasible stretch [1].
    """
    family = FAMILIES[problem.family]
    return np.array([check(problem, family.trajectory(problem, row)).stretch for row in durations])


@dataclass(frozen=True)
class Way:
    """A way to check candidates, and how many of them it gets per round."""

    title: str
    function: Callable[[Problem, Array], Array]
    candidates: int


WAYS = {
    "compiled": Way("compiled exact peaks", compiled, 100_000),
    "matrix": Way("14x14 solve, 100 samples a segment, in blocks", matrix_and_samples, 2_000),
    "one-by-one": Way("the same, one candidate at a time", one_by_one, 200),
    "check": Way("the independent check (judges, does not search)", independent_check, 50),
}


@dataclass(frozen=True)
class CheckSpeed:
    """One way: time per candidate [s], and the largest relative error of the stretch [1]."""

    way: str
    title: str
    seconds: float
    error: float


def measure(problem: Problem, rounds: int) -> list[CheckSpeed]:
    """Time every way on the same candidates.

    Parameters
    ----------
    problem : Problem
        A 3-5-3 problem: the papers' 14x14 matrix is of that family.
    rounds : int
        Rounds; the best one counts. The ways take turns, so that a slow moment of the machine meets
        all of them.

    Returns
    -------
    list of CheckSpeed
        A row per way.
    """
    rng = np.random.default_rng(0)
    durations = rng.uniform(0.2, 3.0, (max(way.candidates for way in WAYS.values()), 3))
    exact = compiled(problem, durations)
    best = dict.fromkeys(WAYS, np.inf)
    error = dict.fromkeys(WAYS, 0.0)
    for _ in range(rounds):
        for name, way in WAYS.items():
            mine = durations[: way.candidates]
            started = time.perf_counter()
            factor = way.function(problem, mine)
            best[name] = min(best[name], (time.perf_counter() - started) / len(mine))
            error[name] = float(np.abs(factor / exact[: len(mine)] - 1.0).max())
    return [CheckSpeed(name, way.title, best[name], error[name]) for name, way in WAYS.items()]


def summarise(rows: list[CheckSpeed]) -> dict[str, Any]:
    """Take checks per second, and how many times slower each way is than the compiled one.

    Parameters
    ----------
    rows : list of CheckSpeed
        All ways.

    Returns
    -------
    dict
        By way.
    """
    fastest = next(row.seconds for row in rows if row.way == "compiled")
    return {
        row.way: {"per_second": 1.0 / row.seconds, "times_slower": row.seconds / fastest,
                  "error": row.error}
        for row in rows
    }  # fmt: skip


def as_text(rows: list[CheckSpeed], summary: dict[str, Any]) -> str:
    """Lay the ways out as a table.

    Parameters
    ----------
    rows : list of CheckSpeed
        All ways.
    summary : dict
        Of ``summarise``.

    Returns
    -------
    str
        A line per way.
    """
    lines = [
        [row.title, f"{s['per_second']:,.0f}", f"{s['times_slower']:,.0f}", f"{s['error']:.1e}"]
        for row, s in zip(rows, summary.values(), strict=True)
    ]
    header = ["candidate check", "per second", "times slower", "largest error of the stretch"]
    return table(header, lines, right=(1, 2, 3))


STUDY = Study(name="speed", row=CheckSpeed, compute=measure, summarise=summarise, text=as_text)


def _matrix(durations: Array) -> Array:
    """The papers' matrix (Wang 2025, eq. 5; Zhou 2025, eq. 5; Zhang 2025, eq. 9): (n, 3) -> (n, 14, 14)."""
    t1, t2, t3 = durations.T
    a = np.zeros((len(durations), 14, 14))
    one = np.ones_like(t1)
    zero = np.zeros_like(t1)
    for rows, t in ((0, t1), (6, t3)):
        columns = 0 if rows == 0 else 10
        a[:, rows, columns : columns + 4] = np.stack([t**3, t**2, t, one], axis=1)
        a[:, rows + 1, columns : columns + 3] = np.stack([3 * t**2, 2 * t, one], axis=1)
        a[:, rows + 2, columns : columns + 2] = np.stack([6 * t, 2 * one], axis=1)
    a[:, 3, 4:10] = np.stack([t2**5, t2**4, t2**3, t2**2, t2, one], axis=1)
    a[:, 4, 4:9] = np.stack([5 * t2**4, 4 * t2**3, 3 * t2**2, 2 * t2, one], axis=1)
    a[:, 5, 4:9] = np.stack([20 * t2**3, 12 * t2**2, 6 * t2, 2 * one, zero], axis=1)
    # the next piece's start: position, velocity, acceleration
    for row, column, value in (
        (0, 9, -1),
        (1, 8, -1),
        (2, 7, -2),
        (3, 13, -1),
        (4, 12, -1),
        (5, 11, -2),
    ):
        a[:, row, column] = value
    # start: position, velocity, acceleration; then the inner waypoints
    for row, column in ((9, 3), (10, 2), (11, 1), (12, 13), (13, 9)):
        a[:, row, column] = 1.0
    return a


def _right_side(problem: Problem) -> Array:
    """The papers' right side (Wang 2025, eq. 7), one column per joint: (14, dof)."""
    x = problem.waypoints
    side = np.zeros((14, problem.dof))
    side[6], side[9], side[12], side[13] = x[3], x[0], x[2], x[1]
    return side
