"""``python -m compare.rivals``: the free-form motion beside other planners through the same waypoints.

Drake's KinematicTrajectoryOptimization: one B-spline of cubic pieces whose total time is free, but not
the shares of it at which the waypoints are passed. These are found outside, by Nelder and Mead's method
from the shares of stop and go, and in a line of their own handed to it from the free-form motion.
pyroboplan's CubicTrajectoryOptimization: one cubic per segment, velocity limits at samples, free
accelerations at the ends. Every answer is turned into exact pieces, slowed down by the least factor
that keeps its limits, and judged by the check that judges ours; its faults stand in the note.

Neither is needed by anything else: ``pip install drake``, ``pip install pyroboplan``.
"""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import minimize
from tqdm import tqdm

from compare.benchmark.run import machine
from compare.commands import shared as commands
from compare.studies.free_form_study import cases, random_problems
from formulations import REFERENCES, Problem, Trajectory, check, free_form
from formulations.motion.verdict import TOLERANCE
from formulations.problem.arrays import Array

_DEGREE = 3  # of Drake's splines: their jerk is constant on each piece, as that of the optimum is


@dataclass(frozen=True)
class Line:
    """One planner on one problem: judged time [s], or why there is none, and the time it took [s]."""

    problem: str
    planner: str
    seconds: float
    note: str
    runtime: float


def judged(problem: Problem, planner: str, motion: Trajectory | None, runtime: float) -> Line:
    """The line of a motion, slowed down where its limits are broken; other faults stand in the note."""
    if motion is None:
        return Line(problem.name, planner, np.nan, "no solution", runtime)
    verdict, note = check(problem, motion), ""
    if not verdict.feasible and 1.0 < verdict.stretch < 2.0:
        note = f"slowed down by {verdict.stretch - 1.0:.1e}"
        motion = motion.stretched(verdict.stretch * (1.0 + TOLERANCE))
        verdict = check(problem, motion)
    if not verdict.feasible:
        note = f"refused: {verdict.faults[0]}"
    return Line(problem.name, planner, verdict.seconds, note, runtime)


def ours(problem: Problem) -> tuple[Line, Trajectory]:
    """The free-form motion."""
    started = time.perf_counter()
    motion = free_form(problem).trajectory
    assert motion is not None  # every problem here moves
    return judged(problem, "free form", motion, time.perf_counter() - started), motion


def drake(problem: Problem, per_segment: int, evaluations: int, motion: Trajectory) -> list[Line]:
    """Drake with control points per segment: shares of the time found outside, and handed to it."""
    points = per_segment * problem.n_segments
    given = motion.passage_times / motion.seconds
    started = time.perf_counter()
    with_ours = drake_spline(problem, points, given)
    lines = [judged(problem, f"Drake {points}, our shares", with_ours, time.perf_counter() - started)]
    if problem.n_segments == 1:
        return lines
    stopping = REFERENCES["ruckig_stop_and_go"](problem).durations
    assert stopping is not None  # every problem here has an acceleration limit
    best: list[Trajectory] = []

    def seconds(logs: Array) -> float:
        ends = np.cumsum(np.exp(np.append(0.0, logs)))
        found = drake_spline(problem, points, np.append(0.0, ends / ends[-1]))
        if found is None:
            return 1e3 * motion.seconds
        if not best or found.seconds < best[0].seconds:
            best[:] = [found]
        return found.seconds

    started = time.perf_counter()
    first = np.log(stopping[1:] / stopping[0])
    minimize(seconds, first, method="Nelder-Mead", options={"maxfev": evaluations, "xatol": 1e-4})
    runtime = time.perf_counter() - started
    lines.append(judged(problem, f"Drake {points}", best[0] if best else None, runtime))
    return lines


def drake_spline(problem: Problem, points: int, shares: Array) -> Trajectory | None:
    """The fastest B-spline that passes the waypoints at the given shares of its time, by SNOPT."""
    from pydrake.planning import KinematicTrajectoryOptimization
    from pydrake.solvers import SnoptSolver
    from pydrake.trajectories import BsplineTrajectory

    limits, still = problem.limits, np.zeros(problem.dof)
    scale = float((np.abs(problem.displacements) / limits.velocity).max(axis=1).sum())
    program = KinematicTrajectoryOptimization(problem.dof, points, _DEGREE + 1, 2.0 * scale)
    program.AddVelocityBounds(-limits.velocity, limits.velocity)
    if limits.has_acceleration:
        program.AddAccelerationBounds(-limits.acceleration, limits.acceleration)
    if limits.has_jerk:
        program.AddJerkBounds(-limits.jerk, limits.jerk)
    if limits.has_position:
        low, high = problem.position_bounds.T
        program.AddPositionBounds(low, high)
    for share, waypoint in zip(shares, problem.waypoints, strict=True):
        program.AddPathPositionConstraint(waypoint, waypoint, float(share))
    for end in (0.0, 1.0):
        program.AddPathVelocityConstraint(still, still, end)
        if limits.has_jerk:
            program.AddPathAccelerationConstraint(still, still, end)
    program.AddDurationCost(1.0)
    program.AddDurationConstraint(0.5 * scale, 100.0 * scale)
    at = np.linspace(0.0, 1.0, points)
    guess = np.stack([np.interp(at, shares, row) for row in problem.waypoints.T], axis=1)
    program.SetInitialGuess(BsplineTrajectory(program.basis(), [row[:, None] for row in guess]))
    result = SnoptSolver().Solve(program.prog())
    if not result.is_success():
        return None
    return _pieces(program.ReconstructTrajectory(result), shares)


def _pieces(spline: Any, shares: Array) -> Trajectory:
    """A Drake B-spline as exact pieces."""
    knots = np.unique(np.asarray(spline.basis().knots()))
    middles = 0.5 * (knots[:-1] + knots[1:])
    durations = np.diff(knots)
    # Taylor's series about the middle of each piece, then moved to its start
    derivatives = [spline.MakeDerivative(k) if k else spline for k in range(_DEGREE + 1)]
    values = np.stack([np.stack([d.value(t).ravel() for t in middles]) for d in derivatives], axis=-1)
    back = -0.5 * durations[:, None]
    x, v, a, j = np.moveaxis(values, -1, 0)
    coefficients = np.stack(
        [
            x + back * (v + back * (a / 2.0 + back * j / 6.0)),
            v + back * (a + back * j / 2.0),
            (a + back * j) / 2.0,
            j / 6.0,
        ],
        axis=-1,
    )
    return Trajectory(durations, coefficients, shares * float(durations.sum()))


def pyroboplan(problem: Problem, motion: Trajectory) -> list[Line]:
    """Pyroboplan's cubics between the waypoints."""
    import pinocchio
    from pyroboplan.trajectory.trajectory_optimization import (
        CubicTrajectoryOptimization,
        CubicTrajectoryOptimizationOptions,
    )

    limits = problem.limits
    model = pinocchio.Model()
    parent = 0
    for j in range(problem.dof):
        parent = model.addJoint(
            parent, pinocchio.JointModelRZ(), pinocchio.SE3.Identity(), f"joint{j + 1}"
        )
    low, high = problem.position_bounds.T
    model.lowerPositionLimit, model.upperPositionLimit = np.maximum(low, -1e3), np.minimum(high, 1e3)
    longest = 4.0 * float(motion.seconds)
    options = CubicTrajectoryOptimizationOptions(
        num_waypoints=len(problem.waypoints),
        min_segment_time=1e-3,
        max_segment_time=longest,
        min_vel=-limits.velocity,
        max_vel=limits.velocity,
        min_accel=-limits.acceleration,
        max_accel=limits.acceleration,
        min_jerk=-limits.jerk,
        max_jerk=limits.jerk,
    )
    started = time.perf_counter()
    planner = CubicTrajectoryOptimization(model, pinocchio.GeometryModel(), options)
    found = planner.plan(list(problem.waypoints))
    runtime = time.perf_counter() - started
    if found is None:
        return [judged(problem, "pyroboplan", None, runtime)]
    durations = np.array([end - start for start, end in found.segment_times])
    # highest power first, a list per joint
    coefficients = np.moveaxis(np.array(found.coeffs), 0, 1)[..., ::-1]
    return [judged(problem, "pyroboplan", Trajectory(durations, coefficients.copy()), runtime)]


PACKAGES = {"drake": "pydrake", "pyroboplan": "pyroboplan"}


def as_text(lines: list[Line]) -> str:
    """A line per planner and problem, its time over ours."""
    rows, reference = [], np.nan
    for line in lines:
        reference = line.seconds if line.planner == "free form" else reference
        missing = np.isnan(line.seconds)
        rows.append(
            [
                line.problem,
                line.planner,
                "-" if missing else f"{line.seconds:.6f}",
                "-" if missing else f"{100.0 * (line.seconds / reference - 1.0):+.3f}",
                f"{line.runtime:.2f}",
                line.note,
            ]
        )
    header = ["problem", "planner", "time [s]", "longer [%]", "wall [s]", "note"]
    return commands.table(header, rows, right=(2, 3, 4))


def main() -> int:
    """Set the rivals beside the free-form motion."""
    parser = commands.parser(
        "rivals",
        "The free-form motion beside Drake's and pyroboplan's trajectory optimisation.",
        "python -m compare.rivals --rivals drake --points 20",
    )
    parser.add_argument("--rivals", help="drake,pyroboplan (default: those installed)")
    parser.add_argument("--count", type=int, default=4, help="random problems beside the cases")
    parser.add_argument("--points", type=int, default=14, help="control points a segment for Drake")
    parser.add_argument("--evaluations", type=int, default=60, help="splines Drake may try per problem")
    options = parser.parse_args()
    commands.positive("--count", options.count)
    commands.positive("--points", options.points)
    commands.positive("--evaluations", options.evaluations)
    wanted = commands.chosen("--rivals", options.rivals, PACKAGES)
    present = [name for name in wanted if importlib.util.find_spec(PACKAGES[name]) is not None]
    for name in wanted:
        if name not in present:
            print(f"{name}: not installed (pip install {name})")
    if not present:
        return commands.FAILED
    planners: dict[str, Callable[[Problem, Trajectory], list[Line]]] = {
        "drake": lambda problem, motion: drake(problem, options.points, options.evaluations, motion),
        "pyroboplan": partial(pyroboplan),
    }
    lines: list[Line] = []
    problems = [*cases(), *random_problems(options.count, 0)]
    for problem in tqdm(problems, "problems", disable=None, leave=False):
        if not problem.limits.has_acceleration:
            continue  # no motion attains the infimum: there is nothing to compare
        line, motion = ours(problem)
        lines.append(line)
        for name in present:
            lines += planners[name](problem, motion)
    print(as_text(lines))
    print(machine())
    return commands.DONE


if __name__ == "__main__":
    commands.run(main)
