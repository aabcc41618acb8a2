"""``python -m compare.speed``: candidate checks a second, beside the papers' way, in one run.

A benchmark command, not a test: each rival checks the same candidates of the same arm, in turn, and
the best of several rounds counts. Add a rival to RIVALS.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from compare.benchmark.run import machine, versions_text
from compare.commands import shared as commands
from compare.studies import speed_swarms
from formulations import FAMILIES, InputError, Problem, check, load
from formulations.problem.arrays import Array

SAMPLES = 100  # per segment, as the papers' scripts do


def compiled(problem: Problem, durations: Array) -> Array:
    """Least feasible stretch by the compiled exact peaks, (n,)."""
    return FAMILIES[problem.family].stretch(problem, durations)


def matrix_and_samples(problem: Problem, durations: Array) -> Array:
    """Least feasible stretch the papers' way, (n,): 14x14 solve, peaks among 100 samples a segment.

    Whole blocks of candidates at once, which no paper does: the rival at its best in NumPy.
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
    """The same for one candidate at a time: a loop over the swarm, as the papers' scripts do."""
    return np.concatenate([matrix_and_samples(problem, row[None]) for row in durations])


def independent_check(problem: Problem, durations: Array) -> Array:
    """The check that judges reported numbers: exact, thorough, one motion at a time."""
    family = FAMILIES[problem.family]
    return np.array([check(problem, family.trajectory(problem, row)).stretch for row in durations])


@dataclass(frozen=True)
class Rival:
    """A way to check candidates, and how many of them it gets per round."""

    title: str
    function: Callable[[Problem, Array], Array]
    candidates: int


RIVALS = {
    "compiled": Rival("compiled exact peaks", compiled, 100_000),
    "matrix": Rival("14x14 solve, 100 samples a segment, in blocks", matrix_and_samples, 2_000),
    "one-by-one": Rival("the same, one candidate at a time", one_by_one, 200),
    "check": Rival("the independent check (judges, does not search)", independent_check, 50),
}


def main() -> int:
    """Time every rival on one case."""
    parser = commands.parser(
        "speed",
        "Candidate checks a second, beside the papers' way.",
        "python -m compare.speed --case ur5",
    )
    parser.add_argument("--case", default="sr4c", help="a 3-5-3 case or problem file")
    parser.add_argument(
        "--swarms",
        action="store_true",
        help="what each swarm costs beside its objective, and beside the same in mealpy",
    )
    parser.add_argument("--rounds", type=int, default=5, help="rounds; the best one counts")
    options = parser.parse_args()
    rounds = commands.positive("--rounds", options.rounds)
    problem = load(options.case)
    if options.swarms:
        print(speed_swarms.as_text(problem, rounds))
        print(f"{machine()}. {versions_text()}")
        return commands.DONE
    if problem.family != "3-5-3":
        raise InputError(
            f"--case: the papers' 14x14 matrix is 3-5-3's, {options.case} is {problem.family}"
        )

    rng = np.random.default_rng(0)
    durations = rng.uniform(0.2, 3.0, (max(r.candidates for r in RIVALS.values()), 3))
    exact = compiled(problem, durations)
    best = dict.fromkeys(RIVALS, np.inf)
    error = dict.fromkeys(RIVALS, 0.0)
    for _ in range(rounds):  # in turn, so that a slow moment of the machine meets all of them
        for name, rival in RIVALS.items():
            mine = durations[: rival.candidates]
            started = time.perf_counter()
            factor = rival.function(problem, mine)
            best[name] = min(best[name], (time.perf_counter() - started) / len(mine))
            error[name] = float(np.abs(factor / exact[: len(mine)] - 1.0).max())
    rows = [
        [
            rival.title,
            f"{1.0 / best[name]:,.0f}",
            f"{best[name] / best['compiled']:,.0f}",
            f"{error[name]:.1e}",
        ]
        for name, rival in RIVALS.items()
    ]
    header = ["candidate check", "a second", "times slower", "largest error of the stretch"]
    print(f"{problem.name}: {problem.dof} joints, 3-5-3, one core, best of {rounds} rounds")
    print(commands.table(header, rows, right=(1, 2, 3)))
    print(f"{machine()}. {versions_text()}")
    return commands.DONE


def _matrix(durations: Array) -> Array:
    """The papers' matrix (000 eq. 5; 002 eq. 5; 004 eq. 9): (n, 3) -> (n, 14, 14)."""
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
    """The papers' right side (000 eq. 7), one column per joint: (14, dof)."""
    x = problem.waypoints
    side = np.zeros((14, problem.dof))
    side[6], side[9], side[12], side[13] = x[3], x[0], x[2], x[1]
    return side


if __name__ == "__main__":
    commands.run(main)
