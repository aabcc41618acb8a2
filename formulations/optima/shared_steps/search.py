"""The search for the fastest motion under limits on the tool, torque limits, or both.

First comes the fastest motion without them. Where it keeps them, it is the answer. Else it is slowed down as
little as possible, and the program on shared steps starts from there. Between its nodes a torque or the tool's
speed may exceed its limit by a little: margins are raised where they do, and the program is solved again. Every
motion is judged by the check, and the fastest one that passes is the answer.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from formulations.deadlines import Deadline
from formulations.dynamics import ArmDynamics, dynamics_of
from formulations.motion.tool_speed import tool_speed
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.free_form.stage import Stage
from formulations.optima.shared_steps.program import StepProgram
from formulations.optima.shared_steps.steps import Steps, sampled
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.problem.errors import InputError, UnsupportedProblem

_LIMITS = ("tool", "segment_tool", "torque")
_ROUNDS = {True: 1, False: 6}  # of raising margins on even and on uneven steps
_SAMPLES = 8  # per step, where torques between nodes are looked at
_STRETCHES = 20
_SLOWEST = 20.0  # more than that a motion is not slowed down before the program starts
_MORE = 1.2  # of the excess: by so much margins are raised
_KEPT = 1e-6  # of the limit: excess that no sample shows
_WORTH = 3e-5  # of the time: a last stretch that costs less is not worth another round


class StepSearch:
    """All that was tried for one problem, and the best of it.

    Attributes
    ----------
    demands : Demands
    dynamics : ArmDynamics or None
        None without torque limits.
    limits : str
        Names of the conditions that the program is about.
    best : tuple of (str, Trajectory, Verdict) or None
        Stage, motion and its judgement.
    stages : list of Stage
    """

    def __init__(
        self, demands: Demands, deadline: Deadline, progress: Callable[[str, float], None] | None
    ) -> None:
        """Begin a search.

        Parameters
        ----------
        demands : Demands
            With limits on the tool or torque limits among their conditions.
        deadline : Deadline
        progress : callable or None
            Called as ``progress(stage, seconds)``.

        Raises
        ------
        InputError
            A motor cannot hold the arm where it has to stand still.
        UnsupportedProblem
            The tool is limited, and a joint has no acceleration limit.
        """
        asked = demands.conditions
        self.demands, self.deadline, self.progress = demands, deadline, progress
        self.dynamics = None if asked.torque is None else dynamics_of(asked.torque)
        names = [name for name in asked.asked if name.startswith(_LIMITS)]
        self.limits = f"conditions.{', conditions.'.join(names)}"
        self.best: tuple[str, Trajectory, Verdict] | None = None
        self.stages: list[Stage] = []
        self.converged = False
        self.clock = time.perf_counter()
        if self.dynamics is not None:
            require_holdable(demands, self.dynamics)
        if asked.on_tool:
            _require_accelerations(demands)

    def offer(self, name: str, motion: Trajectory, steps: Steps, status: str = "") -> Verdict:
        """Judge a motion, slowed down as little as its limits ask for, and keep it if it is the best.

        Parameters
        ----------
        name : str
            Of the stage.
        motion : Trajectory
        steps : Steps
            The same motion, or nearly: it is slowed down between waits that stay as they are.
        status : str
            How the solver ended.

        Returns
        -------
        Verdict
            Of the motion as it came.
        """
        asked, problem = self.demands.conditions, self.demands.problem
        first = verdict = check(problem, motion, conditions=asked)
        given, factor = motion, 1.0
        for attempt in range(_STRETCHES):
            mended = 1.0 < verdict.stretch < np.inf and verdict.position_kept
            if verdict.feasible or not mended:
                break
            factor *= verdict.stretch * (1.0 + 10.0 ** (attempt / 2.0 - 14.0))
            waits = self.demands.waits.any()
            motion = (
                steps.stretched(factor).assembled(self.demands) if waits else given.stretched(factor)
            )
            verdict = check(problem, motion, conditions=asked)
        seconds = motion.seconds if verdict.feasible else np.inf
        if verdict.feasible and (self.best is None or seconds < self.best[2].seconds):
            self.best = (name, motion, verdict)
        now = time.perf_counter()
        self.stages.append(
            Stage(name, seconds, status if verdict.feasible else verdict.faults[0], now - self.clock)
        )
        self.clock = now
        if self.progress is not None:
            self.progress(name, seconds)
        return first

    def run(self, start: Trajectory, meshes: tuple[int, ...]) -> None:
        """Search from a motion without limits on tool and motors.

        Parameters
        ----------
        start : Trajectory
        meshes : tuple of int
            Steps per segment, coarse to fine.
        """
        steps = sampled(start, self.demands, meshes[0])
        verdict = self.offer("without limits on tool and torques, slowed down", start, steps)
        if verdict.feasible:
            self.converged = True
            return
        factor = float(np.clip(verdict.stretch, 1.0, _SLOWEST))
        if self.best is not None:
            still = float(self.demands.waits.sum())
            factor = (self.best[1].seconds - still) / (start.seconds - still)
        steps = steps.stretched(factor)
        for mesh in (*meshes, 2 * meshes[-1]):
            if self.deadline.over or (mesh > meshes[-1] and self.best is not None):
                return  # still finer steps are for problems without a motion so far
            if steps.durations.shape[1] != mesh:
                steps = sampled(steps.assembled(self.demands), self.demands, mesh)
            steps = self._round(steps, mesh)

    def _round(self, steps: Steps, mesh: int) -> Steps:
        """Solve on even steps, then on uneven ones, raising margins where limits are exceeded."""
        program = StepProgram(self.demands, self.dynamics, steps)
        for even, rounds in _ROUNDS.items():
            for attempt in range(rounds):
                if self.deadline.over:
                    return steps
                found, converged, status = program.solve(steps, even=even, deadline=self.deadline)
                if not np.isfinite(found.states).all():
                    break
                name = f"program on {mesh} {'even' if even else 'uneven'} steps, round {attempt + 1}"
                motion = found.assembled(self.demands)
                verdict = self.offer(name, motion, found, status)
                if not converged:
                    break
                self.converged, steps = True, found
                if self.stages[-1].seconds <= (1.0 + _WORTH) * motion.seconds:
                    break
                self.tighten(program, found, verdict)
        return steps

    def tighten(self, program: StepProgram, found: Steps, verdict: Verdict) -> None:
        """Raise margins and lower speeds of a program where its motion exceeds limits between nodes.

        Parameters
        ----------
        program : StepProgram
        found : Steps
            Its solution.
        verdict : Verdict
            On its motion.
        """
        excess = self._excess(found)
        if excess.max() <= _KEPT:  # the check has found more than the samples
            for peak in verdict.peaks:
                if peak.quantity == "torque":
                    excess[peak.joint] += max(peak.factor - 1.0, 0.0)
        program.margins += _MORE * excess
        program.lower(self._faster(found))

    def _excess(self, steps: Steps) -> Array:
        """By what share torques exceed their limits next to each node, (dof, S M + 1)."""
        if self.dynamics is None:
            return np.zeros((steps.states.shape[2], steps.states.shape[1]))
        h = steps.durations.ravel()[:, None, None]
        t = h * (np.arange(1, _SAMPLES) / _SAMPLES)[:, None]
        q, v, a = (state[:-1, None] for state in steps.states)
        j = (steps.states[2, 1:, None] - a) / h
        moved = (q + t * (v + t * (a / 2.0 + t * j / 6.0)), v + t * (a + t * j / 2.0), a + t * j)
        shares = np.abs(self.dynamics.torques(*moved)) / self.dynamics.available
        over = np.maximum(shares.max(axis=1) - 1.0, 0.0)
        edge = np.zeros((1, over.shape[1]))
        return np.asarray(np.maximum(np.concatenate([over, edge]), np.concatenate([edge, over])).T)

    def _faster(self, steps: Steps) -> Array:
        """By what factor the tool is faster than its limit on each step, (S M,)."""
        asked = np.repeat(self.demands.tool_speed, steps.durations.shape[1])
        chain = self.demands.problem.tool
        if chain is None or not np.isfinite(asked).any():
            return np.ones(len(asked))
        still = np.zeros_like(self.demands.waits)
        motion = steps.assembled(replace(self.demands, waits=still))
        found = tool_speed(chain, motion, np.arange(len(asked)), asked).speed
        return np.asarray(np.where(np.isfinite(asked), found / asked, 1.0))


def require_holdable(demands: Demands, dynamics: ArmDynamics) -> None:
    """Refuse waypoints at which the arm has to stand still and a motor is too weak for its weight.

    Parameters
    ----------
    demands : Demands
    dynamics : ArmDynamics

    Raises
    ------
    InputError
        Names the waypoint, the joint, what holding takes, and the limit.
    """
    problem = demands.problem
    fixed = demands.stops & ~np.ptp(demands.waypoints, axis=2).any(axis=1)
    held = np.abs(dynamics.holding(problem.waypoints))
    over = held / dynamics.available - 1.0
    for k in np.flatnonzero(fixed):
        joint = int(over[k].argmax())
        if over[k, joint] > 0.0:
            unit = "N" if problem.units[joint] == "m" else "N m"
            raise InputError(
                f"conditions.torque: waypoint {k + 1}, {problem.joint_name(joint)}: holding the arm "
                f"takes {held[k, joint]:.6g} {unit}, {dynamics.available[joint]:.6g} {unit} are available"
            )


def _require_accelerations(demands: Demands) -> None:
    """Refuse joints whose acceleration nothing limits: the tool's limits alone would let it jump."""
    limited = np.isfinite(demands.jerk).all(axis=0) | np.isfinite(demands.acceleration).all(axis=(0, 2))
    if not limited.all():
        joint = demands.problem.joint_name(int((~limited).argmax()))
        raise UnsupportedProblem(
            f"conditions on the tool: {joint} has no acceleration limit, which this search needs"
        )
