"""The search for the fastest motion under limits on the tool.

It starts from the fastest motion without them, slowed down as a whole until its tool is slow enough. Where
the tool's speed is limited, it starts from its straight lines too (``lines``), as the program finds local
optima only. It solves the program on finer and finer steps. The program keeps the tool's speed at samples.
Where the check finds a larger speed on a step, the limit on that step is lowered by the factor found, and
the program is solved again from there: an exchange that ends after a few rounds. What is left is mended by
a last stretch. Every motion is judged by the independent check.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from formulations.deadlines import Deadline
from formulations.motion.tool_speed import tool_speed
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.free_form.stage import Stage
from formulations.optima.free_form.tool.lines import along_lines
from formulations.optima.free_form.tool.program import ToolProgram
from formulations.optima.free_form.tool.stepped import Stepped
from formulations.problem.arrays import Array, Truths
from formulations.problem.demands import Demands
from formulations.problem.errors import UnsupportedProblem

_MESHES = (8, 16, 32)  # steps per segment; the last one for tolerances below 1e-3
_WEIGHTS = (
    1e-2,
    1e-2,
    1e-3,
    1e-3,
    1e-4,
    1e-5,
    0.0,
    0.0,
)  # of changes of velocity, by rounds of the exchange
_FINER = 2  # rounds that are left out on finer meshes
_WORSE = 1.03  # times the best: a motion so slow swings between samples, and the exchange has ended
_STRETCHES = 8
_MOST_NODES = 4000  # joints times steps of a program


@dataclass(frozen=True)
class Judged:
    """A motion that has passed the check, and how."""

    name: str
    motion: Stepped
    trajectory: Trajectory
    verdict: Verdict


class ToolSearch:
    """All that was tried under limits on the tool, and the best of it.

    Attributes
    ----------
    best : Judged or None
    stages : list of Stage
    converged : bool
        Whether the last program that gave the best motion was solved to its tolerance.
    reason : str
        How the solver ended last, where it did not converge.
    """

    def __init__(
        self, demands: Demands, progress: Callable[[str, float], None] | None, deadline: Deadline
    ) -> None:
        """Begin a search.

        Parameters
        ----------
        demands : Demands
        progress : callable or None
            Called as ``progress(stage, seconds)``.
        deadline : Deadline

        Raises
        ------
        UnsupportedProblem
            A joint that moves has no acceleration limit.
        """
        self.demands, self.progress, self.deadline = demands, progress, deadline
        self.third: Truths = np.asarray(np.isfinite(demands.jerk).all(axis=0))
        limited = np.asarray(self.third | np.isfinite(demands.acceleration).all(axis=(0, 2)))
        if not limited.all():
            joint = demands.problem.joint_name(int((~limited).argmax()))
            raise UnsupportedProblem(
                f"conditions on the tool: {joint} has no acceleration limit, which this search needs"
            )
        self.best: Judged | None = None
        self.stages: list[Stage] = []
        self.converged, self.reason = False, ""
        self.clock = time.perf_counter()

    def run(self, start: Trajectory, tolerance: float) -> None:
        """Search from a motion that need not keep the limits on the tool.

        Parameters
        ----------
        start : Trajectory
            With a passage time for each waypoint.
        tolerance : float
            Relative, of the total time: finer steps are tried until they gain less than a tenth of it.
        """
        d = self.demands
        motion = Stepped.sampled(start, self.third, _MESHES[0], d.waits)
        verdict = self._offer("fastest without limits on the tool, slowed down", motion, start)
        if verdict.feasible:  # the limits on the tool cost nothing
            return
        motion = motion.stretched(float(np.clip(verdict.stretch, 1.0, 1e3)))
        before = np.inf
        limits = np.repeat(d.tool_speed, _MESHES[0])
        meshes = _MESHES[: 1 + (tolerance < 1e-2) + (tolerance < 1e-3)]
        for level, steps in enumerate(meshes):
            size = d.tool_speed.size * steps * d.problem.dof
            if self.deadline.over or (level and size > _MOST_NODES):
                break
            program = ToolProgram(d, steps, float(motion.h.sum() / d.tool_speed.size))
            if level:
                motion, limits = self._exchange(program, motion, limits, near=1e-4)
            else:
                motion, limits = self._from_both(program, motion, limits)
            now = np.inf if self.best is None else self.best.verdict.seconds
            if level and before - now <= 0.1 * tolerance * now:
                break
            before, motion, limits = now, motion.split(), np.repeat(limits, 2)

    def _from_both(self, program: ToolProgram, motion: Stepped, limits: Array) -> tuple[Stepped, Array]:
        """Solve on the first mesh, from a motion and from the tool's straight lines."""
        found = self._exchange(program, motion, limits, near=1e-2)
        if self.deadline.over or not np.isfinite(limits).any():
            return found
        before = self.best
        lines = along_lines(self.demands, self.third, program.steps)
        # in its own unit of time: in another one the solver finds worse motions
        own = ToolProgram(
            self.demands, program.steps, float(lines.h.sum() / len(self.demands.tool_speed))
        )
        other = self._exchange(own, lines, limits, near=1e-2, whence=" from straight lines")
        return found if self.best is before else other

    def _exchange(
        self, program: ToolProgram, motion: Stepped, limits: Array, near: float, whence: str = ""
    ) -> tuple[Stepped, Array]:
        """Solve on one mesh until the check finds no more than the program does.

        limits: (S steps,), those on the steps to begin with [m/s]. near: the first barrier parameter.
        whence: another start, for the names of stages.
        """
        steps, best = program.steps, np.inf
        if self.best is not None and not whence:
            best = self.best.verdict.seconds
        d, chain = self.demands, self.demands.problem.tool
        assert chain is not None
        N = d.tool_speed.size * steps
        asked = np.repeat(d.tool_speed, steps)
        for number, weight in enumerate(_WEIGHTS[_FINER * (steps > _MESHES[0]) :]):
            if self.deadline.over:
                break
            found, converged, status = program.solve(
                motion, limits, self.deadline, near=near, weight=weight
            )
            lowered = f", limits lowered {number}" if number else ""
            name = f"{steps} steps per segment{whence}{lowered}"
            before = self.best
            self._offer(name, found, found.assembled(d.waits, d.waypoints), status)
            if self.best is not before:
                self.converged, self.reason = converged, "" if converged else status
            best = min(best, self.stages[-1].seconds)
            if not converged or self.stages[-1].seconds > _WORSE * best:
                break
            motion = found
            if not np.isfinite(asked).any():
                break
            plain = found.assembled(np.zeros_like(d.waits), d.waypoints)
            speeds = tool_speed(chain, plain, np.arange(N), asked).speed
            factors = np.where(np.isfinite(asked), speeds / asked, 1.0)
            # a limit that was lowered too far is raised again
            better = np.where(
                np.isfinite(asked), np.minimum(asked, limits / np.maximum(factors, 0.9)), asked
            )
            near = 1e-5
            if not weight and np.allclose(better, limits, rtol=1e-6):
                break
            limits = better
        return motion, limits

    def _offer(self, name: str, motion: Stepped, whole: Trajectory, status: str = "") -> Verdict:
        """Judge a motion, stretched where that mends it, and keep the best; gives the first verdict."""
        d = self.demands
        first = verdict = check(d.problem, whole, conditions=d.conditions)
        factor = 1.0
        for attempt in range(_STRETCHES):
            if verdict.feasible or not (verdict.position_kept and 1.0 < verdict.stretch < 1e3):
                break
            factor *= verdict.stretch * (1.0 + 10.0 ** (attempt - 13))
            again = self._stretched(motion, whole, factor)
            verdict = check(d.problem, again, conditions=d.conditions)
            if verdict.feasible:
                whole = again
        seconds = verdict.seconds if verdict.feasible else np.inf
        now = time.perf_counter()
        refusal = "" if verdict.feasible else verdict.faults[0]
        self.stages.append(Stage(name, seconds, refusal or status, now - self.clock))
        self.clock = now
        if verdict.feasible and (self.best is None or seconds < self.best.verdict.seconds):
            self.best = Judged(name, motion, whole, verdict)
        if self.progress is not None:
            self.progress(name, seconds)
        return first

    def _stretched(self, motion: Stepped, whole: Trajectory, factor: float) -> Trajectory:
        """The motion slowed down; its waits are as long as before."""
        if not self.demands.waits.any():
            return whole.stretched(factor)
        return motion.stretched(factor).assembled(self.demands.waits, self.demands.waypoints)
