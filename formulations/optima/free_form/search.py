"""The search for the fastest motion: even steps, waypoint states, arcs, finer meshes; the best is kept.

Whatever a solver returns is assembled to a motion that passes the waypoints exactly, slowed down by
the least factor that keeps its limits, and judged by the independent check. The first motion offered is
stop and go, which needs no solver.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.free_form.nlp import ipopt, slp
from formulations.optima.free_form.nlp.arcs import Motion
from formulations.optima.free_form.nlp.assembly import trajectory
from formulations.optima.free_form.nlp.program import Program, Solution
from formulations.optima.free_form.nlp.task import Task
from formulations.optima.free_form.polish import polished
from formulations.optima.free_form.sensitivity import Sensitivity, sensitivity
from formulations.optima.free_form.stop_and_go import stop_and_go

ROUNDS = 4  # meshes, each half as fine again as the one before
_GUARDS = 6  # solutions that may leave the position limits elsewhere before a mesh is given up
_STRETCHES = 5
_LOOSE, _TIGHT = 1e-6, 1e-9


@dataclass(frozen=True)
class Stage:
    """One step of the search: its motion's time [s], infinite if the check refused it, and why."""

    name: str
    seconds: float
    status: str
    runtime: float


@dataclass(frozen=True)
class Found:
    """A motion the check has passed."""

    name: str
    motion: Motion
    trajectory: Trajectory
    verdict: Verdict


class Search:
    """All that was tried for one task, and the best of it."""

    def __init__(self, task: Task, solver: str, progress: Callable[[str, float], None] | None) -> None:
        self.task, self.solver, self.progress = task, solver, progress
        self.solve = ipopt.solve if solver == "ipopt" else slp.solve
        self.best: Found | None = None
        self.stages: list[Stage] = []
        self.sensitivity: Sensitivity | None = None
        self.solved: tuple[Program, Solution, float] | None = None
        self.guarded: frozenset[tuple[int, int]] = frozenset()
        self.second = 1.0
        self.status = "ok"
        self.clock = time.perf_counter()

    def offer(self, name: str, motion: Motion | str, status: str = "") -> Found | None:
        """Judge a motion; keep it if it is the best. None if the check refuses it."""
        found, refusal = None, motion if isinstance(motion, str) else ""
        if not isinstance(motion, str):
            found, refusal = self._judged(name, motion)
        seconds = np.inf if found is None else found.verdict.seconds
        now = time.perf_counter()
        self.stages.append(Stage(name, seconds, refusal or status, now - self.clock))
        self.clock = now
        if found is not None and (self.best is None or seconds < self.best.verdict.seconds):
            self.best = found
        if self.progress is not None:
            self.progress(name, seconds)
        return found

    def _judged(self, name: str, motion: Motion) -> tuple[Found | None, str]:
        for attempt in range(_STRETCHES):
            whole = trajectory(self.task, motion)
            verdict = check(self.task.problem, whole, conditions=self.task.conditions)
            if verdict.feasible:
                return Found(name, motion, whole, verdict), ""
            if not (self.task.stretchable and verdict.position_kept and 1.0 < verdict.stretch < 2.0):
                break
            # breaks are rounded again, so that a little more may be needed
            motion = motion.stretched(verdict.stretch * (1.0 + 10.0 ** (attempt - 14)))
        return None, verdict.faults[0]

    def run(self, mesh: int, tolerance: float) -> None:
        """Search until a finer mesh gains less than a tenth of the tolerance."""
        start = stop_and_go(self.task)
        self.offer("stop and go", start)
        self.second = float(start.times.mean())
        if not self.task.group(2) and not self.task.group(3):
            return
        if self.task.ends.any():  # the closed form starts and ends at rest
            self._states("stop and go, by Ruckig", start)
        arcs, before = mesh, np.inf
        for _ in range(ROUNDS):
            self._round(start, arcs, tolerance)
            now = np.inf if self.best is None else self.best.verdict.seconds
            if tolerance >= 1e-3 or before - now <= 0.1 * tolerance * now:
                break
            arcs, before = (3 * arcs) // 2, now
        if self.solved is None and self.solve is ipopt.solve and self.task.stretchable:
            self.solve = slp.solve
            self._round(start, mesh, tolerance)
        self._finish(tolerance)

    def run_timed(self, mesh: int) -> list[str]:
        """The smoothest motion of a fixed time, or any; then notes say so."""
        start = stop_and_go(self.task)
        self.second = float(start.times.mean())
        if not self.task.group(2) and not self.task.group(3):
            self.offer("steady", start)
            return []
        if self.solve is ipopt.solve:
            self._solved("smoothest", start, 3 * mesh, free=False, tolerance=_TIGHT, smooth=True)
            if self.best is not None:
                return []
        self._fastest_slowed(mesh)
        if self.best is None:
            self.run(mesh, 1e-3)
        return ["not the smoothest motion: no solution of that program was found"]

    def _fastest_slowed(self, mesh: int) -> None:
        """The fastest motion slowed down to the time asked for; other conditions may refuse it."""
        task = self.task
        asked = replace(task.conditions, total=None, passage={})
        inner = Search(Task(task.problem, asked), self.solver, None)
        inner.run(mesh, 1e-3)
        if inner.best is not None:
            motion = inner.best.motion
            factor = task.times[task.n_segments] / float(motion.times.sum())
            self.offer("fastest, slowed down", motion.stretched(factor))

    def _round(self, start: Motion, arcs: int, tolerance: float) -> None:
        """Coarse mesh -> states at the waypoints -> arcs."""
        # no stretch mends what a loose solution leaves where times or end velocities are given
        digits = _LOOSE if self.task.stretchable else _TIGHT
        coarse = self._solved("even steps", start, arcs + arcs // 2, free=False, tolerance=1e-4)
        states = self._states("waypoint states", coarse)
        # where Ruckig refuses, or its profiles are no good start, the even steps themselves
        starts = [] if isinstance(states, str) else [(states, arcs)]
        for first, n in [*starts, (coarse, arcs + arcs // 2)]:
            self._solved("arcs", first, n, free=True, tolerance=digits)
            best = np.inf if self.best is None else self.best.verdict.seconds
            if self.status == "ok" and self.stages[-1].seconds <= best * (1.0 + 1e-4):
                break

    def _states(self, name: str, motion: Motion) -> Motion | str:
        """Ruckig between the states of a motion at the waypoints."""
        states = polished(self.task, motion)
        if self.offer(name, states) is None and not self.task.times:
            other = polished(self.task, motion, by_speed=True)
            if self.offer(name, other) is not None or isinstance(states, str):
                return other
        return states

    def _solved(
        self, name: str, start: Motion, arcs: int, *, free: bool, tolerance: float, smooth: bool = False
    ) -> Motion:
        """Solve on one mesh; where the motion leaves the position limits, guard and solve again."""
        for _ in range(_GUARDS):
            program = Program(
                self.task,
                (min(arcs, 4) if free else arcs, arcs),
                free=free,
                second=self.second,
                guarded=self.guarded,
                smooth=smooth,
            )
            solution = self.solve(
                program, program.point(start), tolerance=tolerance, near=1e-4 if free else None
            )
            motion = program.motion(solution.x)
            outside = self._outside(motion) - self.guarded
            if not outside:
                break
            self.guarded |= outside
            start = motion
        found = self.offer(name, motion, solution.status)
        if free or smooth:
            self.status = "ok" if solution.converged else solution.status
        if free and found is not None:
            self._remember(program, solution, found.verdict.seconds)
        return motion

    def _remember(self, program: Program, solution: Solution, seconds: float) -> None:
        if self.solved is None or seconds < self.solved[2]:
            self.solved = (program, solution, seconds)

    def _outside(self, motion: Motion) -> frozenset[tuple[int, int]]:
        """Joints and segments where a motion leaves the position limits."""
        whole = trajectory(self.task, motion)
        bounds = self.task.position_bounds
        middles = whole.breaks[:-1] + 0.5 * whole.durations
        passages = np.unique(whole.passage_times)
        segment = np.searchsorted(passages, middles) - 1
        extremes, slack = whole.extremes(0), self.task.problem.position_slack
        low, high = bounds[segment, :, 0] - slack, bounds[segment, :, 1] + slack
        out = (extremes.low < low) | (extremes.high > high)
        return frozenset((int(j), int(segment[i])) for i, j in np.argwhere(out))

    def _finish(self, tolerance: float) -> None:
        """The best arcs to full accuracy, their waypoint states, and the multipliers."""
        if self.solved is None:
            return
        program, solution, _ = self.solved
        if tolerance < 1e-4:
            solution = self.solve(program, solution.x, tolerance=_TIGHT, near=1e-7, warm=solution)
            motion = program.motion(solution.x)
            found = self.offer("arcs, to the last digits", motion, solution.status)
            if found is not None:
                self._remember(program, solution, found.verdict.seconds)
        program, solution, _ = self.solved
        if not self.task.times:
            self._states("waypoint states of the arcs", program.motion(solution.x))
        if self.best is not None and self.solved[2] <= self.best.verdict.seconds * (1.0 + 1e-3):
            self.sensitivity = sensitivity(program, solution)
