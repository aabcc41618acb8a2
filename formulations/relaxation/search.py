"""The bound, step by step: closed forms, the relaxation, a motion that meets it, narrower boxes.

The boxes hold all motions of at most H seconds, whatever H is: so min(optimum of the relaxation, H) is a
lower bound, and H need not be the time of a motion. It is that of the fastest one known, unless the bound
is far below: then a little above the bound, and the boxes are the narrower for it.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from formulations.problem import Array, Problem
from formulations.relaxation.closed_forms import (
    displacement_bound,
    end_to_end_bound,
    least_durations,
    stop_and_go,
)
from formulations.relaxation.cuts import TANGENT, Cuts
from formulations.relaxation.motion import motion_through
from formulations.relaxation.prices import savings
from formulations.relaxation.program import Program, Solution
from formulations.relaxation.rows import Frame
from formulations.relaxation.task import Task
from formulations.relaxation.tightening import Boxes, tightened
from formulations.trajectory import Trajectory, check

_BEYOND = 1e-6  # slower than the known motion by this is looked at too, lest the program be empty
_AHEAD = 0.1  # of the bound: how far above it the horizon is at most
_ROUNDS = 100  # of cuts
_TANGENTS = 4  # for each duration to start with
_LOOSER = 1e-2  # durations to start with: the rows, not the box, are to carry the bound and its prices
_STRETCHES = (2e-8, 1e-6, 1e-4)  # of the relaxation's durations, tried for a motion
_HALVINGS = 5  # of the stretch where none of these makes one
_STALLED = 0.05  # of the way to the horizon: less than that in one step is no progress


class Search:
    """``bounds`` by method [s], ``upper`` of the fastest motion known [s], ``motion`` if found here."""

    def __init__(
        self,
        problem: Problem,
        upper: float | None,
        progress: Callable[[float, float | None], None] | None,
    ) -> None:
        self.problem, self.upper, self.progress = problem, upper, progress
        self.bounds = {
            "displacement": displacement_bound(problem),
            "ruckig_end_to_end": end_to_end_bound(problem),
            "segment": float(least_durations(problem).sum()) * (1.0 - 1e-15 * problem.n_segments),
        }
        self.stop_and_go = stop_and_go(problem)
        self.looking = upper is None  # whether a motion by stretching is worth its time
        self.motion: Trajectory | None = None
        self.durations: Array | None = None
        self.savings: Array | None = None
        self.rows = 0

    @property
    def seconds(self) -> float:
        """The best bound so far."""
        return max(self.bounds.values())

    @property
    def known(self) -> float:
        """The fastest motion known, stop and go at least [s]."""
        slowest = float(self.stop_and_go.sum())
        return slowest if self.upper is None else min(self.upper, slowest)

    def run(self, gap: float, deadline: float) -> str:
        """Until the gap is reached, the time is over or nothing helps; returns which it was."""
        if not self.problem.moving_joints:
            self.upper = 0.0
            return "proved"
        horizon = self.known * (1.0 + _BEYOND)
        if not len(Task.of(self.problem, horizon).joints):
            return "simple bounds only: with a velocity limit alone, displacement is the infimum itself"
        status = ""
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            while not status:
                status = self._within(horizon, gap, deadline)
                horizon = min(self.known * (1.0 + _BEYOND), self.seconds * (1.0 + _AHEAD))
        return status

    def _within(self, horizon: float, gap: float, deadline: float) -> str:
        """All motions of at most ``horizon`` seconds; empty if a longer one is worth a look."""
        task = Task.of(self.problem, horizon)
        boxes = self._first_boxes(task)
        typical = self.stop_and_go[task.segments]
        cuts = Cuts.of(TANGENT, np.arange(0), np.empty(0))
        tolerance = min(max(1e-3 * gap, 1e-9), 1e-7)
        while not boxes.empty:
            frame = Frame(task, boxes.durations, boxes.accelerations, typical)
            program = Program(frame, Cuts.joined([_tangents(boxes.durations), cuts]))
            solution = program.solve(frame.cost, rounds=_ROUNDS, tolerance=tolerance, deadline=deadline)
            before = self.seconds
            if solution.empty:
                break
            if not np.isfinite(solution.bound):
                return f"simple bounds only: HiGHS ended with {solution.status}"
            self._record(program, solution)
            typical, cuts = solution.x[frame.T] * typical, program.cuts
            self._look_for_motion(typical, cuts, gap, deadline)
            if self._met(gap):
                return "proved"
            if time.perf_counter() > deadline:
                return "time limit"
            if self.seconds >= horizon:
                break
            nearer = min(self.known * (1.0 + _BEYOND), self.seconds * (1.0 + _AHEAD))
            if nearer < 0.99 * horizon:
                return ""
            if self.seconds - before < _STALLED * (horizon - before):
                return "tight as it gets"
            boxes = tightened(program, solution, deadline)
            cuts = program.cuts
        self._improve(horizon)
        return "proved" if self._met(gap) else "" if horizon < self.known else "tight as it gets"

    def _first_boxes(self, task: Task) -> Boxes:
        least = least_durations(self.problem)[task.segments] * (1.0 - _LOOSER)
        durations = np.stack([least, task.horizon - (least.sum() - least)], axis=1)
        limit = np.broadcast_to(task.acceleration, (len(least) + 1, len(task.joints)))
        empty = bool((durations[:, 0] > durations[:, 1]).any())
        return Boxes(durations, np.stack([-limit, limit], axis=-1), empty)

    def _met(self, gap: float) -> bool:
        return self.upper is not None and self.upper <= self.seconds * (1.0 + gap)

    def _improve(self, bound: float) -> None:
        self.bounds["relaxation"] = max(self.bounds.get("relaxation", 0.0), bound)
        if self.progress is not None:
            self.progress(self.seconds, self.upper)

    def _record(self, program: Program, solution: Solution) -> None:
        """Keep what a solve proved, and where it says the time goes."""
        task, problem = program.frame.task, self.problem
        bound = min(solution.bound, task.horizon)
        self.rows = len(program.rows)
        if bound > self.bounds.get("relaxation", 0.0):
            self.durations = np.zeros(problem.n_segments)
            self.durations[task.segments] = solution.x[program.frame.T] * program.frame.typical
            self.savings = np.zeros((3, problem.n_segments, problem.dof))
            self.savings[:, task.segments[:, None], task.joints] = savings(program, solution)
        self._improve(bound)

    def _look_for_motion(self, durations: Array, cuts: Cuts, gap: float, deadline: float) -> None:
        """Try the relaxation's durations, hardly stretched, then stretched until they make a motion."""
        for stretch in _STRETCHES:
            if self._met(gap) or self._try(durations * (1.0 + stretch), cuts, deadline):
                return
        low, high = 1.0, self.known / float(durations.sum())
        for _ in range(_HALVINGS if self.looking else 0):
            middle = (low * high) ** 0.5
            if self._try(durations * middle, cuts, deadline):
                high = middle
            else:
                low = middle

    def _try(self, durations: Array, cuts: Cuts, deadline: float) -> bool:
        """Whether these durations make a motion that passes the check; kept if it is the fastest."""
        if self.upper is not None and durations.sum() >= self.upper:
            return True
        motion = motion_through(self.problem, durations, cuts, deadline)
        if motion is None:
            return False
        verdict = check(self.problem, motion)
        if verdict.feasible:
            self.motion, self.upper = motion, verdict.seconds
        elif not verdict.position_kept:
            self.looking = False  # no stretch mends that
        return verdict.feasible


def _tangents(durations: Array) -> Cuts:
    """Tangents of 1 / T, even in the logarithm of T."""
    at = np.geomspace(durations[:, 0], durations[:, 1], _TANGENTS)
    return Cuts.of(TANGENT, np.tile(np.arange(len(durations)), _TANGENTS), at.ravel())
