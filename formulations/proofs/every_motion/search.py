"""The bound, step by step: closed forms, the relaxation, a motion that meets it, narrower boxes.

The boxes hold all motions of at most H seconds, whatever H is: so min(optimum of the relaxation, H) is
a lower bound, and H need not be the time of a motion. It is that of the fastest one known, unless the
bound is far below: then a little above the bound, and the boxes are the narrower for it.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import check
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.displacement import displacement_bound
from formulations.proofs.every_motion.closed_forms import least_durations, stop_and_go
from formulations.proofs.every_motion.descent import descended
from formulations.proofs.every_motion.motion import motion_through
from formulations.proofs.every_motion.prices import savings
from formulations.proofs.every_motion.record import recorded
from formulations.proofs.every_motion.relaxation.cuts import TANGENT, Cuts
from formulations.proofs.every_motion.relaxation.program import Program, Solution
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.task import Task
from formulations.proofs.every_motion.relaxation.tightening import Boxes, tightened
from formulations.proofs.every_motion.states import states_at
from formulations.proofs.rest_to_rest import end_to_end_bound

_TIGHT = "tight as it gets"
_BEYOND = 1e-6  # slower than the known motion by this is looked at too, lest the program be empty
_AHEAD = 0.1  # of the bound: how far above it the horizon is at most
_ROUNDS = 100  # of cuts
_TANGENTS = 4  # for each duration to start with
_LOOSER = 1e-2  # durations to start with: the rows, not the box, are to carry the bound and its prices
_STRETCHES = (2e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)  # of durations, tried for a motion
_NEAR = 1e-2  # of the bound: how far above it the horizon of its certificate is at most
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
        self.typical = self.stop_and_go.copy()
        self.cuts = Cuts.of(TANGENT, np.arange(0), np.empty(0))
        self.looking = upper is None  # whether a motion by stretching is worth its time
        self.attained = np.inf  # by a motion that may leave the position limits [s]
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
        if not self.seconds > 0.0:
            return "simple bounds only: the displacements are too small for floats"
        if not len(Task.of(self.problem, self.known).joints):
            return "simple bounds only: with a velocity limit alone, displacement is the infimum itself"
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            return self._approach(gap, deadline)

    def _approach(self, gap: float, deadline: float) -> str:
        """Horizon after horizon: a longer one once none of its motions is left, else a shorter one."""
        ahead, boxes = np.inf, None
        while True:
            horizon = min(self.known * (1.0 + _BEYOND), self.seconds * (1.0 + ahead))
            status, boxes = self._within(horizon, boxes, gap, deadline)
            if status:
                return status
            if horizon > self.seconds * (1.0 + _AHEAD):
                ahead = _AHEAD
                continue
            if self.seconds >= horizon:
                boxes = None
                if horizon >= self.known:
                    return _TIGHT
                continue
            ahead = min(ahead, horizon / self.seconds - 1.0) / 3.0
            if ahead < gap:
                return _TIGHT

    def _within(
        self, horizon: float, boxes: Boxes | None, gap: float, deadline: float
    ) -> tuple[str, Boxes]:
        """All motions of at most ``horizon`` seconds, in narrower and narrower boxes."""
        task = Task.of(self.problem, horizon)
        boxes = self._boxes(task, boxes)
        typical = self.typical[task.segments]
        tolerance = min(max(1e-3 * gap, 1e-9), 1e-7)
        stalled = False
        while not boxes.empty:
            frame = Frame(task, boxes.durations, boxes.accelerations, typical)
            program = Program(frame, Cuts.joined([_tangents(boxes.durations), self.cuts]))
            solution = program.solve(frame.cost, rounds=_ROUNDS, tolerance=tolerance, deadline=deadline)
            before = self.seconds
            if solution.empty:
                break
            self._record(program, solution)
            if solution.status != "Optimal":
                ended = solution.status.lower()
                return "time limit" if "time" in ended else f"HiGHS ended with {ended}", boxes
            typical = solution.x[frame.T] * typical
            self.typical[task.segments], self.cuts = typical, program.cuts
            self._look_for_motion(typical, program.cuts, gap, deadline)
            if self._met(gap):
                return "proved", boxes
            if self._tight(gap):
                return _TIGHT, boxes
            if time.perf_counter() > deadline:
                return "time limit", boxes
            if self.seconds >= horizon:
                break
            if horizon > self.seconds * (1.0 + _AHEAD):
                return "", boxes
            if stalled and self.seconds - before < _STALLED * (horizon - before):
                return "", boxes
            narrower = tightened(program, solution, deadline)
            self.cuts = program.cuts
            stalled = _width(narrower) > (1.0 - _STALLED) * _width(boxes)
            boxes = narrower
        self._improve(horizon)
        return "proved" if self._met(gap) else "", boxes

    def _boxes(self, task: Task, boxes: Boxes | None) -> Boxes:
        """The boxes to begin with, those of a longer horizon or none, for the task's."""
        most = task.acceleration[:, None]
        if boxes is None:
            at_most = (np.abs(task.displacements) / task.velocity).max(axis=1)
            least = np.maximum(least_durations(self.problem)[task.segments], at_most)
            least = np.maximum(least * (1.0 - _LOOSER), task.least)
            durations = np.stack([least, np.full_like(least, np.inf)], axis=1)
            accelerations = np.full((len(least) + 1, len(task.joints), 2), (-np.inf, np.inf))
        else:
            durations, accelerations = boxes.durations.copy(), boxes.accelerations
        # no duration can be longer than what the others leave
        others = durations[:, 0].sum() - durations[:, 0]
        durations[:, 1] = np.minimum(durations[:, 1], task.horizon * (1.0 + 1e-12) - others)
        empty = bool((durations[:, 0] > durations[:, 1]).any())
        return Boxes(durations, np.clip(accelerations, -most, most), empty)

    def recorded(self, deadline: float) -> tuple[float, float, list[list[Any]]]:
        """A bound near the best one [s], the horizon of its proof [s] and its events."""
        least = self.bounds["displacement"] * (1.0 - 1e-12)
        horizon = min(self.known * (1.0 + _BEYOND), self.seconds * (1.0 + _NEAR))
        if not len(Task.of(self.problem, horizon).joints) or not self.seconds > least * (1.0 + 1e-9):
            return least, least, []
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            bound, events = recorded(
                self.problem, horizon, self.seconds * (1.0 - 1e-8), self.cuts, self.typical, deadline
            )
        if not bound > least:
            return least, least, []
        self._improve(bound)  # what a near horizon gains
        return bound, horizon, events

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
            self.savings[:, task.segments[:, None], task.joints] = savings(problem, program, solution)
        self._improve(bound)

    def _look_for_motion(self, durations: Array, cuts: Cuts, gap: float, deadline: float) -> None:
        """Try the relaxation's durations, hardly stretched; if no motion has them, those nearby."""
        for local in (False, True):
            if local:
                if not self.looking:
                    return
                durations, cuts = descended(self.problem, durations, cuts, deadline)
            for stretch in _STRETCHES[: 4 if self.looking and not local else None]:
                if self._met(gap) or self._tight(gap):
                    return
                if self._try(durations * (1.0 + stretch), cuts, deadline):
                    self.looking = False
                    return

    def _try(self, durations: Array, cuts: Cuts, deadline: float) -> bool:
        """Whether these durations make a motion; kept if it passes the check and is the fastest."""
        total = float(durations.sum())
        if self.upper is not None and total >= self.upper:
            return True
        states = states_at(self.problem, durations, cuts, deadline)
        if states is None:
            return False
        self.attained = min(self.attained, total)
        motion = motion_through(self.problem, durations, states)
        if motion is None:
            return False
        verdict = check(self.problem, motion)
        if verdict.feasible:
            self.motion, self.upper = motion, verdict.seconds
        return verdict.feasible or not verdict.position_kept  # which no stretch mends

    def _tight(self, gap: float) -> bool:
        """Whether the relaxation's optimum is known to be no longer, whatever the boxes."""
        return self.attained <= self.seconds * (1.0 + gap)


def _width(boxes: Boxes) -> float:
    """Relative widths of the durations' boxes, together."""
    return float((boxes.durations[:, 1] / boxes.durations[:, 0] - 1.0).sum())


def _tangents(durations: Array) -> Cuts:
    """Tangents of 1 / T, even in the logarithm of T."""
    at = np.geomspace(durations[:, 0], durations[:, 1], _TANGENTS)
    return Cuts.of(TANGENT, np.tile(np.arange(len(durations)), _TANGENTS), at.ravel())
