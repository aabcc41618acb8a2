"""The search for the fastest motion within torque limits.

First comes the fastest motion without them. Where it keeps them, it is the answer. Else it is slowed down as
little as possible, and the program with the dynamics starts from there. Between its nodes a torque may exceed
the limit by a little: margins are raised where it does, and the program is solved again. Every motion is judged
by the check, and the fastest one that passes is the answer.
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
from formulations.optima.free_form.answer import FreeForm
from formulations.optima.free_form.ending import SearchStatus
from formulations.optima.free_form.stage import Stage
from formulations.optima.torque.program import TorqueProgram
from formulations.optima.torque.steps import Steps, sampled
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.problem.errors import InputError, NoFeasibleMotion, NotFoundInTime

_ROUNDS = {True: 1, False: 6}  # of raising margins on even and on uneven steps
_SAMPLES = 8  # per step, where torques between nodes are looked at
_STRETCHES = 20
_SLOWEST = 20.0  # more than that a motion is not slowed down before the program starts
_MORE = 1.2  # of the excess: by so much margins are raised
_KEPT = 1e-6  # of the limit: excess that no sample shows
_WORTH = 3e-5  # of the time: a last stretch that costs less is not worth another round

NOTE = "the lower bound is that of the limits without torques"


class TorqueSearch:
    """All that was tried for one problem, and the best of it.

    Attributes
    ----------
    demands : Demands
    dynamics : ArmDynamics
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
            With torque limits among their conditions.
        deadline : Deadline
        progress : callable or None
            Called as ``progress(stage, seconds)``.

        Raises
        ------
        InputError
            A motor cannot hold the arm where it has to stand still.
        """
        torque = demands.conditions.torque
        assert torque is not None
        self.demands, self.deadline, self.progress = demands, deadline, progress
        self.dynamics = dynamics_of(torque)
        self.best: tuple[str, Trajectory, Verdict] | None = None
        self.stages: list[Stage] = []
        self.converged = False
        self.clock = time.perf_counter()
        require_holdable(demands, self.dynamics)

    @property
    def stretchable(self) -> bool:
        """Whether a slowed-down motion still keeps the demands on times and states."""
        asked = self.demands
        timed = np.isfinite(asked.durations[:, 1]).any() or np.isfinite(asked.passages[1:, 1]).any()
        ends = asked.end_velocity.any() or asked.end_acceleration.any()
        return not (timed or (ends and not asked.cyclic) or asked.waits.any())

    def offer(self, name: str, motion: Trajectory, status: str = "") -> Verdict:
        """Judge a motion, slowed down as little as its limits ask for, and keep it if it is the best.

        Parameters
        ----------
        name : str
            Of the stage.
        motion : Trajectory
        status : str
            How the solver ended.

        Returns
        -------
        Verdict
            Of the motion as it came.
        """
        asked, problem = self.demands.conditions, self.demands.problem
        first = verdict = check(problem, motion, conditions=asked)
        for attempt in range(_STRETCHES):
            mended = self.stretchable and 1.0 < verdict.stretch < np.inf and verdict.position_kept
            if verdict.feasible or not mended:
                break
            motion = motion.stretched(verdict.stretch * (1.0 + 10.0 ** (attempt / 2.0 - 14.0)))
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
        """Search from a motion without torque limits.

        Parameters
        ----------
        start : Trajectory
        meshes : tuple of int
            Steps per segment, coarse to fine.
        """
        verdict = self.offer("without torque limits, slowed down", start)
        if verdict.feasible:
            self.converged = True
            return
        if self.best is not None:
            start = self.best[1]
        elif np.isfinite(verdict.stretch):
            start = start.stretched(float(np.clip(verdict.stretch, 1.0, _SLOWEST)))
        steps = sampled(start, self._of(start), meshes[0])
        for mesh in meshes:
            if self.deadline.over:
                return
            if steps.durations.shape[1] != mesh:
                motion = steps.assembled(self.demands)
                steps = sampled(motion, self.demands, mesh)
            steps = self._round(steps, mesh)

    def _of(self, motion: Trajectory) -> Demands:
        """The demands, with the waits as long as a slowed-down motion has them."""
        factor = motion.seconds / max(self._unslowed, 1e-300) if self.demands.waits.any() else 1.0
        return replace(self.demands, waits=self.demands.waits * factor)

    _unslowed = 0.0

    def _round(self, steps: Steps, mesh: int) -> Steps:
        """Solve on even steps, then on uneven ones, raising margins where torques exceed their limits."""
        program = TorqueProgram(self.demands, self.dynamics, steps)
        for even, rounds in _ROUNDS.items():
            for attempt in range(rounds):
                if self.deadline.over:
                    return steps
                found, converged, status = program.solve(steps, even=even, deadline=self.deadline)
                if not np.isfinite(found.states).all():
                    break
                name = f"program on {mesh} {'even' if even else 'uneven'} steps, round {attempt + 1}"
                motion = found.assembled(self.demands)
                verdict = self.offer(name, motion, status)
                if not converged:
                    break
                self.converged, steps = True, found
                if self.stages[-1].seconds <= (1.0 + _WORTH) * motion.seconds:
                    break
                excess = self._excess(found)
                if excess.max() <= _KEPT:  # the check has found more than the samples
                    torques = [peak for peak in verdict.peaks if peak.quantity == "torque"]
                    for peak in torques:
                        excess[peak.joint] += max(peak.factor - 1.0, 0.0)
                program.margins += _MORE * excess
                program.lower(self._faster(found))
        return steps

    def _excess(self, steps: Steps) -> Array:
        """By what share torques exceed their limits next to each node, (dof, S M + 1)."""
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


def torque_feasible(
    demands: Demands,
    kinematic: Callable[..., FreeForm],
    *,
    mesh: int = 7,
    tolerance: float = 1e-3,
    deadline: Deadline,
    progress: Callable[[str, float], None] | None = None,
) -> FreeForm:
    """Find the fastest motion within torque limits.

    Parameters
    ----------
    demands : Demands
        With torque limits among their conditions.
    kinematic : callable
        Finds the fastest motion without them; it is given ``time_limit``.
    mesh : int
        The program has twice as many steps per segment. With a ``tolerance`` below 1e-3 a second one has
        four times as many.
    tolerance : float
        Relative tolerance of the total time: an aim.
    deadline : Deadline
    progress : callable, optional
        Called as ``progress(stage, seconds)``.

    Returns
    -------
    FreeForm
        Verified by the check.

    Raises
    ------
    InputError
        A motor cannot hold the arm where it has to stand still.
    NoFeasibleMotion
        No motion was found. NotFoundInTime where the time was over.
    """
    begun = time.perf_counter()
    search = TorqueSearch(demands, deadline, progress)
    left = deadline.left
    first = kinematic(time_limit=left / 2.0 if np.isfinite(left) else None)
    if first.trajectory is None:
        return replace(first, problem=demands.problem, conditions=demands.conditions)
    search._unslowed = first.trajectory.seconds
    search.clock = time.perf_counter()
    meshes = (2 * mesh,) if tolerance >= 1e-3 else (2 * mesh, 4 * mesh)
    search.run(first.trajectory, meshes)
    if search.best is None:
        line = f"no motion found that keeps conditions.torque; {search.stages[-1].status}"
        raise NotFoundInTime(line) if deadline.over else NoFeasibleMotion(line)
    name, motion, verdict = search.best
    status, reason = SearchStatus.OK, ""
    if deadline.over:
        status = SearchStatus.INTERRUPTED if deadline.interrupted else SearchStatus.TIME_LIMIT
    elif not search.converged:
        status, reason = SearchStatus.NOT_CONVERGED, search.stages[-1].status
    unhindered = len(search.stages) == 1 and search.converged
    return replace(
        first,
        problem=demands.problem,
        conditions=demands.conditions,
        durations=np.diff(motion.passage_times) - demands.waits[:-1],
        trajectory=motion,
        verdict=verdict,
        method=first.method if unhindered else name,
        status=first.status if unhindered else status,
        reason=first.reason if unhindered else reason,
        notes=(*first.notes, NOTE),
        sensitivity=first.sensitivity if unhindered else None,
        stages=(*first.stages, *search.stages),
        runtime=time.perf_counter() - begun,
    )
