"""The search for the bound: closed forms, the relaxation, a motion that meets it, narrower boxes.

The boxes hold all motions of at most H seconds, for any horizon H. So min(optimum of the relaxation, H)
is a lower bound, and H need not be the time of a motion. The first horizon is the time of the fastest
motion known. If the bound is far below it, the next horizon lies a little above the bound: the boxes are
then narrower and the relaxation is tighter. Where narrowing stalls near a known motion, the boxes are split.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from formulations.deadlines import Deadline
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.demands import Demands
from formulations.proofs.every_motion.attaining_motion.hunt import MotionHunt
from formulations.proofs.every_motion.attaining_motion.relaxed_motion import RelaxedMotion
from formulations.proofs.every_motion.beginnings import (
    first_bounds,
    first_boxes,
    tangents,
)
from formulations.proofs.every_motion.ending import Ending, out_of_time, unsolved
from formulations.proofs.every_motion.parts import PartedProof
from formulations.proofs.every_motion.prices import price_limits
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.in_band import least_time, long_chain
from formulations.proofs.every_motion.relaxation.kept_waypoints import idle_waypoints
from formulations.proofs.every_motion.relaxation.linear_program import (
    LinearProgram,
    LPSolution,
    LPStatus,
)
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.tightening import FEW, MANY, tighten
from formulations.proofs.status import BoundStatus

_ENOUGH = 0.9  # of the gap asked for: that of the horizon of a long chain
BEYOND = 1e-6  # the horizon is longer than the known motion by this, so that the motion is inside
_FAR = 0.15  # of the bound: the known motion is no horizon while it is farther above
_AHEAD = 0.1  # of the bound: how far above it the horizon is then
ROUNDS = 100  # of cuts
_FARTHEST = 1e3  # displacements at top speed: where the search ends if no motion is left
_SHORTEST = 1e-6  # of the horizon: the least unit of a duration that may be 0
_BELOW = 1.0 - 2.0**-50  # more than the rounding of one sum
_STALLED = 0.05  # of the way to the horizon: a step that gains less is no progress


class HorizonSearch:
    """The search for one problem's bound, horizon after horizon.

    Attributes
    ----------
    bounds : dict of str to float [s]
        The bound by each method.
    hunt : MotionHunt
        The fastest motion known.
    durations : Array or None, shape (n_segments,) [s]
        Durations at the relaxation's optimum.
    savings : Array or None, shape (3, n_segments, dof) [s]
        See ``price_limits``.
    rows : int
        Number of rows of the last program.
    """

    def __init__(
        self,
        demands: Demands,
        hunt: MotionHunt,
        progress: Callable[[float, float | None], None] | None,
    ) -> None:
        """Compute the bounds in closed form.

        Parameters
        ----------
        demands : Demands
        hunt : MotionHunt
            With what is known of the fastest motion.
        progress : callable or None
            Called as ``progress(bound, upper)`` whenever the relaxation proved a bound.
        """
        self.demands, self.progress = demands, progress
        self.problem = demands.problem
        self.without = self.idle = idle_waypoints(demands)
        self.plain = demands.plain
        self.bounds, self.typical, self.slowest = first_bounds(demands)
        self.cuts = Cuts.none()
        self.hunt = hunt
        self.durations: Array | None = None
        self.savings: Array | None = None
        self.rows = 0
        self.long = False

    @property
    def upper(self) -> float | None:
        """Time of the fastest motion known [s]."""
        return self.hunt.upper

    @property
    def motion(self) -> Trajectory | None:
        """That motion, if it was found here."""
        return self.hunt.motion

    @property
    def seconds(self) -> float:
        """The best bound so far [s]."""
        return max(self.bounds.values())

    @property
    def known(self) -> float:
        """Time of the fastest motion known [s], at most that of stop and go; under conditions a guess."""
        if not self.plain:
            return self.slowest if self.upper is None else self.upper
        return self.slowest if self.upper is None else min(self.upper, self.slowest)

    def run(self, gap: float, deadline: Deadline) -> Ending:
        """Search until the gap is reached, the time is over, or nothing proves more.

        Parameters
        ----------
        gap : float
            Relative gap to the known motion.
        deadline : Deadline

        Returns
        -------
        Ending
        """
        if self.plain and not self.problem.moving_joints:
            self.hunt.upper = 0.0
            return Ending(BoundStatus.PROVED)
        if self.plain and not self.seconds > 0.0:
            return Ending(BoundStatus.SIMPLE, "the displacements are too small for floats")
        relaxed = self.relaxed(self.known)
        if relaxed.cyclic and len(relaxed.least) < 2:
            return Ending(BoundStatus.SIMPLE, "all waypoints of the cycle can coincide")
        if not len(relaxed.joints):
            return Ending(
                BoundStatus.SIMPLE, "with a velocity limit alone, displacement is the infimum itself"
            )
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            return self.approach(gap, deadline)

    def relaxed(self, horizon: float) -> RelaxedProblem:
        """Relax the problem, without the waypoints that are left out.

        Parameters
        ----------
        horizon : float [s]

        Returns
        -------
        RelaxedProblem
        """
        return RelaxedProblem.under(self.demands, horizon, without=self.without)

    def approach(self, gap: float, deadline: Deadline) -> Ending:
        """Try horizon after horizon: a longer one when none of its motions is left, else a shorter one.

        Parameters
        ----------
        gap : float
            Relative gap to the known motion.
        deadline : Deadline

        Returns
        -------
        Ending
        """
        ahead, boxes = np.inf, None
        while True:
            horizon = self.known * (1.0 + BEYOND)
            if ahead < _AHEAD or horizon > self.seconds * (1.0 + _FAR):
                horizon = min(horizon, self.seconds * (1.0 + ahead))
            horizon = min(horizon, self._aim(gap))
            ending, boxes = self._within(horizon, boxes, gap, deadline)
            if ending is not None:
                return ending
            if not self.seconds > 0.0:
                return Ending(BoundStatus.SIMPLE, "nothing forces it to take time")
            if horizon > self.seconds * (1.0 + _FAR):
                ahead = _AHEAD
                continue
            if horizon > self._aim(gap):
                continue
            if self.seconds >= horizon:
                boxes = None
                if horizon >= self.known and (self.plain or self.upper is not None):
                    return Ending(BoundStatus.TIGHT)
                if horizon >= self.known:  # the guess was too short
                    self.slowest *= 2.0
                    if self.slowest > _FARTHEST * self.bounds["displacement"]:
                        return Ending(BoundStatus.SIMPLE, f"no motion was left up to {horizon:.4g} s")
                    ahead = np.inf
                continue
            ahead = min(ahead, horizon / self.seconds - 1.0) / 3.0
            if ahead < gap:
                return Ending(BoundStatus.TIGHT)

    def _aim(self, gap: float) -> float:
        """The bound that would do [s], as the horizon of a long chain, where each box has all the time left.

        All segments together lose so much more than that time that no box becomes narrow if it is long.
        Infinite where it is no long chain, or no motion is known.
        """
        return self.upper / (1.0 + _ENOUGH * gap) if self.long and self.upper else np.inf

    def _within(
        self, horizon: float, boxes: Boxes | None, gap: float, deadline: Deadline
    ) -> tuple[Ending | None, Boxes]:
        """Bound all motions of at most ``horizon`` seconds, in narrower and narrower boxes."""
        relaxed = self.relaxed(horizon)
        boxes = first_boxes(self.demands, relaxed, boxes)
        typical = relaxed.units(self.typical)
        tolerance = min(max(1e-3 * gap, 1e-9), 1e-7)
        stalled, rounds = False, FEW
        while not boxes.empty:
            frame = Frame(relaxed, boxes, typical)
            program = LinearProgram(frame, Cuts.joined([tangents(boxes.durations), self.cuts]))
            solution = least_time(
                program, rounds=ROUNDS, tolerance=tolerance, deadline=deadline, ceiling=relaxed.horizon
            )
            self.long = long_chain(frame)
            before = self.seconds
            if solution.empty:
                break
            self._keep(program, solution)
            if self.met(gap):
                return Ending(BoundStatus.PROVED), boxes
            if solution.status == LPStatus.TIME_LIMIT:
                return out_of_time(deadline), boxes
            if solution.status != LPStatus.OPTIMAL:
                return unsolved(solution), boxes
            typical = (solution.x[frame.T] * frame.typical)[: relaxed.n_segments]
            short = frame.short[: relaxed.n_segments]
            typical[short] = np.maximum(typical[short], _SHORTEST * horizon)
            self.typical[relaxed.segments], self.cuts = typical, program.cuts
            if self.plain:
                of_bound = {"bound": self.seconds, "gap": gap}
                self.hunt.look(typical, program.cuts, **of_bound, deadline=deadline)
            self._note(frame, solution, gap)
            if self.met(gap):
                return Ending(BoundStatus.PROVED), boxes
            if self.hunt.attained <= self.seconds * (1.0 + gap):
                return Ending(BoundStatus.TIGHT), boxes
            if deadline.over:
                return out_of_time(deadline), boxes
            if self.seconds >= horizon:
                break
            if horizon > min(self.seconds * (1.0 + _FAR), self._aim(gap)):
                return None, boxes
            slow = self.seconds - before < _STALLED * (horizon - before)
            if slow and (stalled if self.long else rounds == MANY):
                return self._in_parts(relaxed, horizon, boxes, gap, deadline), boxes
            narrower, self.cuts = tighten(program, solution, deadline, rounds=rounds)
            stuck = narrower.width > (1.0 - _STALLED) * boxes.width
            stalled = stuck and rounds == MANY
            if stuck or (slow and not self.long):
                rounds = MANY
            boxes = narrower
        self.improve(horizon)
        return (Ending(BoundStatus.PROVED) if self.met(gap) else None), boxes

    def _in_parts(
        self, relaxed: RelaxedProblem, horizon: float, boxes: Boxes, gap: float, deadline: Deadline
    ) -> Ending | None:
        """Split boxes that cannot be narrowed, where a motion says how much there is to gain."""
        self.hunt.search_near()
        if self.met(gap):
            return Ending(BoundStatus.PROVED)
        if self.upper is None or not self.hunt.given or self.long:
            return None
        target = self.upper / (1.0 + gap)
        proof = PartedProof(relaxed, horizon, target, self.typical, deadline, for_checker=False)
        proof.prove(boxes, self.cuts, stuck_at=self.seconds)
        if proof.bound > self.seconds and not proof.least.empty:
            program = LinearProgram(proof.frame(proof.least.boxes), proof.least.cuts)
            solution = program.solve(program.frame.cost, rounds=FEW, tolerance=1e-7, deadline=deadline)
            if solution.status == LPStatus.OPTIMAL:
                self._describe(program, solution)
                self._note(program.frame, solution, gap)
        self.improve(proof.bound)
        if not self.met(gap):
            self.hunt.search_near()
        if self.met(gap):
            return Ending(BoundStatus.PROVED)
        return out_of_time(deadline) if deadline.over else None

    def met(self, gap: float) -> bool:
        """Say whether the known motion is as near to the bound as is asked for.

        Parameters
        ----------
        gap : float
            Relative.

        Returns
        -------
        bool
        """
        return self.upper is not None and self.upper <= self.seconds * (1.0 + gap)

    def improve(self, bound: float) -> None:
        """Keep a bound of the relaxation, if it is the best one.

        Parameters
        ----------
        bound : float [s]
        """
        self.bounds["relaxation"] = max(self.bounds.get("relaxation", 0.0), bound)
        if self.progress is not None:
            self.progress(self.seconds, self.upper)

    def _keep(self, program: LinearProgram, solution: LPSolution) -> None:
        """Keep the bound of a solve and, if it is the best one, its durations and savings."""
        relaxed = program.frame.relaxed
        self.rows = len(program.rows)
        bound = min(solution.bound, relaxed.horizon)
        if relaxed.waits:
            bound = (bound + relaxed.waits) * _BELOW
        if bound > self.bounds.get("relaxation", 0.0):
            self._describe(program, solution)
        self.improve(bound)

    def _note(self, frame: Frame, solution: LPSolution, gap: float) -> None:
        """Tell the hunt where the relaxation passes the waypoints, if no zone is left out that counts."""
        if not self.met(gap) and self.without == self.idle:
            self.hunt.point = RelaxedMotion.of(self.demands, frame, solution.x)

    def _describe(self, program: LinearProgram, solution: LPSolution) -> None:
        """Keep the durations and the savings of a solve."""
        relaxed, problem = program.frame.relaxed, self.problem
        self.durations = np.zeros(problem.n_segments)
        found = solution.x[program.frame.T] * program.frame.typical
        self.durations[relaxed.segments] = found[: relaxed.n_segments]
        self.savings = np.zeros((3, problem.n_segments, problem.dof))
        self.savings[:, relaxed.segments[:, None], relaxed.joints] = price_limits(
            self.demands, program, solution
        )
