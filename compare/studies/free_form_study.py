"""``python -m compare.free_form_study``: the fastest motion on shipped cases, extremes and random problems.

A benchmark command, not a test: every answer is judged by the independent check and set beside Ruckig
with a full stop at each waypoint and beside the certified bound on every motion there is. Limits of
the random problems: Franka Panda, whose jerk limits are very high (Franka Control Interface
documentation, "Robot and interface specifications"), and UFACTORY xArm6, whose jerk limit is low
(UFACTORY docs, "Guide to run robotic arm at the maximum speed": 180 deg/s, 1146 deg/s^2,
28647 deg/s^3 for every joint).
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from tqdm import tqdm

from compare.benchmark.run import machine
from compare.commands import shared as commands
from formulations import (
    CASES,
    REFERENCES,
    InputError,
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
class Answer:
    """One problem: times [s] of the motion, of stop and go and of the bound, and what they took.

    runtime: on the wall, cpu: of this process; both in s, and the same on a machine that is idle.
    proof: s on the wall for the bound, which is asked for ``gap`` at most.
    """

    name: str
    dof: int
    segments: int
    seconds: float
    stop_and_go: float
    bound: float
    feasible: bool
    status: str
    method: str
    runtime: float
    cpu: float
    proof: float

    @property
    def gap(self) -> float:
        """Seconds over the bound, less one; below 0 only if one of the two is wrong."""
        return self.seconds / self.bound - 1.0


def cases() -> Iterator[Problem]:
    """The shipped cases, and ``sr4c`` with a jerk limit of five times the acceleration per second."""
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
    """Two to ten waypoints, uniform within the reach, the arms in turn."""
    rng = np.random.default_rng(seed)
    for index in range(count):
        arm = list(ARMS)[index % len(ARMS)]
        limits = ARMS[arm]
        waypoints = rng.uniform(-REACH, REACH, (int(rng.integers(2, 11)), len(limits.velocity)))
        yield Problem.of(waypoints, limits, name=f"{arm} {index + 1}")


def extremes() -> Iterator[Problem]:
    """Few and many joints and waypoints, very short and very long ways, limits far apart, joints at rest."""
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
        "ways of 1e-6 rad": (decades(-6, -6, 5, 6), Limits.of(*usual, dof=6)),
        "ways of 1e3 rad": (decades(3, 3, 5, 6), Limits.of(*usual, dof=6)),
        "ways from 1e-6 to 1e3 rad": (decades(-6, 3, 5, 6), Limits.of(*usual, dof=6)),
        "limits 1e4 apart": (drawn(5, 3), apart),
        "joints and waypoints at rest": (rest, Limits.of(1, 2, 5, dof=2)),
        "two equal waypoints, 6 joints": (np.repeat(drawn(4, 6), 2, axis=0), Limits.of(*usual, dof=6)),
        "two waypoints": (drawn(2, 6), Limits.of(*usual, dof=6)),
        "no jerk limit": (drawn(10, 6), Limits.of(2, 5, dof=6)),
        "some limits missing": (drawn(5, 3), Limits.of(1, [2, np.inf, 3], [9, np.inf, np.inf], dof=3)),
    }
    for name, (waypoints, limits) in kinds.items():
        yield Problem.of(waypoints, limits, name=name)


def answered(problem: Problem, tolerance: float, solver: str, gap: float) -> Answer:
    """Solve and judge one problem, and bound it."""
    started, burnt = time.perf_counter(), time.process_time()
    found = free_form(problem, tolerance=tolerance, solver="highs" if solver == "highs" else "ipopt")
    runtime, cpu = time.perf_counter() - started, time.process_time() - burnt
    rest = REFERENCES["ruckig_stop_and_go"](problem).seconds
    assert found.trajectory is not None  # every problem here moves
    verdict = check(problem, found.trajectory)
    upper = found.seconds if verdict.feasible else None
    bound = free_form_bound(problem, gap=gap, upper=upper)
    return Answer(
        problem.name,
        problem.dof,
        problem.n_segments,
        found.seconds,
        np.nan if rest is None else rest,
        bound.seconds,
        verdict.feasible,
        found.status,
        found.method,
        runtime,
        cpu,
        bound.runtime,
    )


def as_text(answers: list[Answer]) -> str:
    """A line per problem."""
    rows = [
        [
            a.name,
            str(a.dof),
            str(a.segments),
            f"{a.seconds:.9f}",
            "-" if np.isnan(a.stop_and_go) else f"{a.stop_and_go:.6f}",
            f"{a.gap:.1e}",
            "yes" if a.feasible else "NO",
            a.method,
            a.status,
            f"{a.runtime:.2f}",
            f"{a.cpu:.2f}",
            f"{a.proof:.2f}",
        ]
        for a in answers
    ]
    header = ["problem", "joints", "segments", "free form [s]", "stop and go [s]", "gap", "verified"]
    return commands.table(
        [*header, "found by", "status", "wall [s]", "CPU [s]", "proof [s]"],
        rows,
        right=(1, 2, 3, 4, 5, 9, 10, 11),
    )


def summary(answers: list[Answer]) -> str:
    """What matters of many answers, in a line."""
    runtime, cpu = np.array([a.runtime for a in answers]), np.array([a.cpu for a in answers])
    ratio = np.array([a.seconds / a.stop_and_go for a in answers])
    gap, proof = np.array([a.gap for a in answers]), np.array([a.proof for a in answers])
    return (
        f"{len(answers)} problems: {sum(a.feasible for a in answers)} verified, "
        f"{int((ratio > 1.0).sum())} above stop and go, {int((gap < -1e-9).sum())} below their bound; "
        f"time over stop and go {np.median(ratio):.4f} "
        f"(largest {ratio.max():.9f}), not converged {sum(a.status != 'ok' for a in answers)}; "
        f"certified gap median {np.median(gap):.1e}, largest {gap.max():.1e}; "
        f"wall median {np.median(runtime):.3f} s, largest {runtime.max():.3f} s; "
        f"CPU median {np.median(cpu):.3f} s, largest {cpu.max():.3f} s; "
        f"proof wall median {np.median(proof):.3f} s, largest {proof.max():.3f} s"
    )


def main() -> int:
    """Solve the shipped cases and random problems."""
    parser = commands.parser(
        "free_form_study",
        "The fastest motion on the shipped cases, on extremes and on random problems of two arms.",
        "python -m compare.free_form_study --count 200",
    )
    parser.add_argument("--count", type=int, default=200, help="random problems (default 200)")
    parser.add_argument("--seed", type=int, default=0, help="of the random problems")
    parser.add_argument("--tolerance", type=float, default=1e-3, help="as of free_form (default 1e-3)")
    parser.add_argument("--solver", default="ipopt", help="ipopt (default) or highs")
    parser.add_argument(
        "--gap", type=float, default=1e-3, help="certified gap to be content with (default 1e-3)"
    )
    parser.add_argument("--each", action="store_true", help="show a line per random problem too")
    parser.add_argument("--json", metavar="FILE", help="write every answer to FILE")
    options = parser.parse_args()
    commands.positive("--count", options.count)
    if options.solver not in ("ipopt", "highs"):
        raise InputError(f"--solver: {options.solver!r} is not known (known: highs, ipopt)")

    drawing = random_problems(options.count, options.seed)
    shipped, extreme, drawn = (
        [
            answered(problem, options.tolerance, options.solver, options.gap)
            for problem in tqdm(list(problems), name, disable=None, leave=False)
        ]
        for name, problems in (("cases", cases()), ("extremes", extremes()), ("random", drawing))
    )
    print(as_text([*shipped, *extreme]))
    print()
    if options.each:
        print(as_text(drawn))
    print(summary(drawn))
    print(machine())
    if options.json:
        data = [
            {**vars(a), "stop_and_go": None if np.isnan(a.stop_and_go) else a.stop_and_go}
            for a in [*shipped, *extreme, *drawn]
        ]
        commands.write_json(Path(options.json), data)
    return commands.DONE


if __name__ == "__main__":
    commands.run(main)
