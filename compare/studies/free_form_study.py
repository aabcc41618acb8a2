"""The fastest motion on cases, extremes and random problems: behind ``timebound free_form_study``.

Every answer is judged by the independent check. Beside it stand Ruckig with a full stop at each
waypoint, and the certified bound on every motion there is. The random problems have the limits of two
arms: Franka Panda, whose jerk limits are very high (Franka Control Interface documentation, "Robot and
interface specifications"), and UFACTORY xArm6, whose jerk limit is low (UFACTORY docs, "Guide to run
robotic arm at the maximum speed": 180 deg/s, 1146 deg/s^2, 28647 deg/s^3 for every joint).
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.screen import table
from compare.studies.study import Call, Study, median_and_largest
from formulations import (
    CASES,
    REFERENCES,
    Limits,
    Problem,
    check,
    free_form,
    free_form_bound,
    load,
)
from formulations.problem.arrays import Array

REACH = 2.5  # rad, of the random waypoints to either side
ARMS = {
    "panda": Limits.of(
        [2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61],
        [15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0],
        [7500.0, 3750.0, 5000.0, 6250.0, 7500.0, 10000.0, 10000.0],
        dof=7,
    ),
    "xarm6": Limits.of(np.radians(180.0), np.radians(1146.0), np.radians(28647.0), dof=6),
}


@dataclass(frozen=True)
class FreeFormAnswer:
    """One problem: times [s] of the motion, of stop and go and of the bound, and what they took.

    series: cases, extremes or random. stop_and_go: None where Ruckig has no answer. runtime: on the
    wall, cpu: of this process; both in s, and the same on an idle machine. proof: time on the wall for
    the bound [s].
    """

    series: str
    name: str
    dof: int
    segments: int
    seconds: float
    stop_and_go: float | None
    bound: float
    feasible: bool
    status: str
    method: str
    runtime: float
    cpu: float
    proof: float

    @property
    def gap(self) -> float:
        """Seconds over the bound, minus 1; below 0 only if one of the two is wrong."""
        return self.seconds / self.bound - 1.0


def cases() -> Iterator[Problem]:
    """Load the shipped cases, and ``sr4c`` with a jerk limit of five times the acceleration per second."""
    for name in CASES:
        problem = load(name)
        yield problem
        if name == "sr4c":
            known = problem.limits
            jerk = 5.0 * known.acceleration
            limits = Limits.of(
                known.velocity, known.acceleration, jerk, known.position, dof=problem.dof
            )
            yield replace(problem, name="sr4c, jerk", limits=limits)


def random_problems(count: int, seed: int) -> Iterator[Problem]:
    """Draw problems of two to ten waypoints, uniform within the reach, the arms in turn.

    Parameters
    ----------
    count : int
        How many.
    seed : int
        Seed of the random numbers.

    Yields
    ------
    Problem
        The same for the same seed.
    """
    rng = np.random.default_rng(seed)
    for index in range(count):
        arm = list(ARMS)[index % len(ARMS)]
        limits = ARMS[arm]
        waypoints = rng.uniform(-REACH, REACH, (int(rng.integers(2, 11)), len(limits.velocity)))
        yield Problem.of(waypoints, limits, name=f"{arm} {index + 1}")


def extremes() -> Iterator[Problem]:
    """State problems with few and many joints and waypoints, very short and very long displacements,
    limits far apart, and joints at rest.
    """
    rng = np.random.default_rng(0)

    def drawn(waypoints: int, dof: int) -> Array:
        return rng.uniform(-REACH, REACH, (waypoints, dof))

    def decades(low: float, high: float, segments: int, dof: int) -> Array:
        steps = 10.0 ** rng.uniform(low, high, (segments, dof)) * rng.choice(
            [-1.0, 1.0], (segments, dof)
        )
        return np.cumsum(np.vstack([np.zeros(dof), steps]), axis=0)

    usual = (2.0, 5.0, 20.0)
    apart = Limits.of([1e-2, 1.0, 1e2], [1e2, 1.0, 1e-2], [1e4, 1.0, 1e2], dof=3)
    rest = [[0, 1], [0, 1], [1, 1], [1, 1], [1, 1], [-1, 1], [-1, 1]]
    kinds: dict[str, tuple[ArrayLike, Limits]] = {
        "30 waypoints, 1 joint": (drawn(30, 1), Limits.of(*usual, dof=1)),
        "30 waypoints, 6 joints": (drawn(30, 6), Limits.of(*usual, dof=6)),
        "30 waypoints, 12 joints": (drawn(30, 12), Limits.of(*usual, dof=12)),
        "4 waypoints, 12 joints": (drawn(4, 12), Limits.of(*usual, dof=12)),
        "displacements of 1e-6 rad": (decades(-6, -6, 5, 6), Limits.of(*usual, dof=6)),
        "displacements of 1e3 rad": (decades(3, 3, 5, 6), Limits.of(*usual, dof=6)),
        "displacements from 1e-6 to 1e3 rad": (decades(-6, 3, 5, 6), Limits.of(*usual, dof=6)),
        "limits 1e4 apart": (drawn(5, 3), apart),
        "joints and waypoints at rest": (rest, Limits.of(1, 2, 5, dof=2)),
        "two equal waypoints, 6 joints": (np.repeat(drawn(4, 6), 2, axis=0), Limits.of(*usual, dof=6)),
        "two waypoints": (drawn(2, 6), Limits.of(*usual, dof=6)),
        "no jerk limit": (drawn(10, 6), Limits.of(2, 5, dof=6)),
        "some limits missing": (drawn(5, 3), Limits.of(1, [2, np.inf, 3], [9, np.inf, np.inf], dof=3)),
        "displacements of 1e-4 rad": (decades(-4, -4, 5, 6), Limits.of(*usual, dof=6)),
        "displacements of 0.01 rad": (decades(-2, -2, 5, 6), Limits.of(*usual, dof=6)),
    }
    for name, (waypoints, limits) in kinds.items():
        yield Problem.of(waypoints, limits, name=name)


def answered(
    series: str, problem: Problem, tolerance: float, solver: str, gap: float
) -> list[FreeFormAnswer]:
    """Solve one problem, judge its motion, and bound it.

    Parameters
    ----------
    series : str
        Where the problem comes from.
    problem : Problem
        The problem.
    tolerance : float
        Relative tolerance of the motion.
    solver : str
        ``ipopt`` or ``highs``.
    gap : float
        Relative gap at which the bound is good enough.

    Returns
    -------
    list of FreeFormAnswer
        One row.
    """
    started, burnt = time.perf_counter(), time.process_time()
    found = free_form(problem, tolerance=tolerance, solver="highs" if solver == "highs" else "ipopt")
    runtime, cpu = time.perf_counter() - started, time.process_time() - burnt
    assert found.trajectory is not None  # every problem here moves
    verdict = check(problem, found.trajectory)
    bound = free_form_bound(problem, gap=gap, upper=found.seconds if verdict.feasible else None)
    answer = FreeFormAnswer(
        series=series,
        name=problem.name,
        dof=problem.dof,
        segments=problem.n_segments,
        seconds=found.seconds,
        stop_and_go=REFERENCES["ruckig_stop_and_go"](problem).seconds,
        bound=bound.seconds,
        feasible=verdict.feasible,
        status=found.ending,
        method=found.method,
        runtime=runtime,
        cpu=cpu,
        proof=bound.runtime,
    )
    return [answer]


def calls(count: int, seed: int, tolerance: float, solver: str, gap: float) -> list[Call]:
    """List the calls of the study: the cases, the extremes, then random problems.

    Parameters
    ----------
    count : int
        Random problems.
    seed : int
        Seed of the random problems.
    tolerance : float
        Relative tolerance of the motion.
    solver : str
        ``ipopt`` or ``highs``.
    gap : float
        Relative gap at which the bound is good enough.

    Returns
    -------
    list of tuples
        Arguments of ``answered``.
    """
    drawn = {"cases": cases(), "extremes": extremes(), "random": random_problems(count, seed)}
    return [
        (series, problem, tolerance, solver, gap)
        for series, problems in drawn.items()
        for problem in problems
    ]


@dataclass(frozen=True)
class FreeFormSummary:
    """What matters of many answers; quantities in pairs are the median and the largest one.

    over_stop_and_go: time over that of stop and go [1]; wall, cpu and proof in s.
    """

    problems: int
    verified: int
    above_stop_and_go: int
    below_bound: int
    not_converged: int
    over_stop_and_go: tuple[float, float] | None
    gap: tuple[float, float]
    wall: tuple[float, float]
    cpu: tuple[float, float]
    proof: tuple[float, float]


def summarise(answers: list[FreeFormAnswer]) -> dict[str, Any]:
    """Sum the random problems up.

    Parameters
    ----------
    answers : list of FreeFormAnswer
        All rows.

    Returns
    -------
    dict
        A ``FreeFormSummary``.
    """
    drawn = [answer for answer in answers if answer.series == "random"]
    ratios = [a.seconds / a.stop_and_go for a in drawn if a.stop_and_go is not None]
    gaps = [a.gap for a in drawn]
    return asdict(
        FreeFormSummary(
            problems=len(drawn),
            verified=sum(a.feasible for a in drawn),
            above_stop_and_go=sum(ratio > 1.0 for ratio in ratios),
            below_bound=sum(gap < -1e-9 for gap in gaps),
            not_converged=sum(a.status != "ok" for a in drawn),
            over_stop_and_go=median_and_largest(ratios) if ratios else None,
            gap=median_and_largest(gaps),
            wall=median_and_largest([a.runtime for a in drawn]),
            cpu=median_and_largest([a.cpu for a in drawn]),
            proof=median_and_largest([a.proof for a in drawn]),
        )
    )


def as_table(answers: list[FreeFormAnswer]) -> str:
    """Lay answers out as a table.

    Parameters
    ----------
    answers : list of FreeFormAnswer
        The rows.

    Returns
    -------
    str
        A line per problem.
    """
    rows = [
        [
            a.name, str(a.dof), str(a.segments), f"{a.seconds:.9f}",
            "-" if a.stop_and_go is None else f"{a.stop_and_go:.6f}", f"{a.gap:.1e}",
            "yes" if a.feasible else "NO", str(a.method), str(a.status), f"{a.runtime:.2f}",
            f"{a.cpu:.2f}", f"{a.proof:.2f}",
        ]
        for a in answers
    ]  # fmt: skip
    header = ["problem", "joints", "segments", "free form [s]", "stop and go [s]", "gap", "verified"]
    header += ["found by", "status", "wall [s]", "CPU [s]", "proof [s]"]
    return table(header, rows, right=(1, 2, 3, 4, 5, 9, 10, 11))


def as_text(answers: list[FreeFormAnswer], summary: dict[str, Any]) -> str:
    """Show the cases and extremes as a table, and the random problems in a few lines.

    Parameters
    ----------
    answers : list of FreeFormAnswer
        All rows.
    summary : dict
        Of ``summarise``.

    Returns
    -------
    str
        The table and the lines.
    """
    s = FreeFormSummary(**summary)
    stated = [answer for answer in answers if answer.series != "random"]
    lines = [
        f"{s.problems} random problems: {s.verified} verified, {s.above_stop_and_go} above stop and go, "
        f"{s.below_bound} below their bound, {s.not_converged} not converged"
    ]
    if s.over_stop_and_go is not None:
        middle, largest = s.over_stop_and_go
        lines.append(f"  time over stop and go: median {middle:.4f}, largest {largest:.9f}")
    lines.append(f"  certified gap: median {s.gap[0]:.1e}, largest {s.gap[1]:.1e}")
    for name, (middle, largest) in (("wall", s.wall), ("CPU", s.cpu), ("proof, wall", s.proof)):
        lines.append(f"  {name}: median {middle:.3f} s, largest {largest:.3f} s")
    return "\n".join([*([as_table(stated), ""] if stated else []), *lines])


STUDY = Study(
    name="free_form_study",
    row=FreeFormAnswer,
    compute=answered,
    summarise=summarise,
    text=as_text,
)
