"""The search for the fastest motion: even steps, waypoint states, arcs, finer meshes; the best is kept.

Each round solves the program on even steps, takes the waypoint states of its solution, computes the
segment times between them (``retiming``), and solves the program on free arcs from there. Whatever a
solver returns is assembled to a motion that passes the waypoints exactly, slowed down by the least factor
that keeps its limits, and judged by the independent check. The first one is stop and go.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np

from formulations.deadlines import NEVER, Deadline
from formulations.optima.free_form.ending import SearchEnded, SearchStatus
from formulations.optima.free_form.faults import missed, outside
from formulations.optima.free_form.nlp import ipopt, slp
from formulations.optima.free_form.nlp.arcs import ArcMotion
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.optima.free_form.nlp.program import FreeFormNLP, NLPSolution
from formulations.optima.free_form.retiming import Refusal, retime
from formulations.optima.free_form.sensitivity import Sensitivity, read_sensitivity
from formulations.optima.free_form.stage import Stage, VerifiedMotion, judged
from formulations.optima.free_form.stop_and_go import stop_and_go_motion

ROUNDS = 4  # of meshes, each with half as many arcs again as the one before
_GUARDS = 6  # solutions on one mesh that may leave the position limits, each in further places
_MISSED = 1e-6  # of the longest fixed time: more is not met
_LOOSE, _TIGHT = 1e-6, 1e-9


class MeshRefinement:
    """All that was tried for one problem, and the best of it.

    Attributes
    ----------
    best : VerifiedMotion or None
    stages : list of Stage
    sensitivity : Sensitivity or None
    reason : str
        How the solver ended on the last free arcs.
    """

    def __init__(
        self,
        task: ConditionedProblem,
        solver: str,
        progress: Callable[[str, float], None] | None,
        deadline: Deadline = NEVER,
    ) -> None:
        """Begin a search.

        Parameters
        ----------
        task : ConditionedProblem
        solver : {"ipopt", "highs"}
        progress : callable or None
            Called as ``progress(stage, seconds)``.
        deadline : Deadline
            No stage is begun after it, except the first one, which needs no solver.
        """
        self.deadline, self.ended, self.task, self.progress = deadline, False, task, progress
        self._use(solver)
        self.best: VerifiedMotion | None = None
        self.stages: list[Stage] = []
        self.sensitivity: Sensitivity | None = None
        self.solved: tuple[FreeFormNLP, NLPSolution, float] | None = None
        self.guarded: frozenset[tuple[int, int]] = frozenset()
        self.second = 1.0
        self.converged, self.reason = np.inf, ""
        self.nearest: ArcMotion | None = None  # to the times asked for, and by how much it misses them
        self.missed = 0.0
        self.last: ArcMotion | None = None  # that a program on free arcs found, kept or not
        self.clock = time.perf_counter()

    def _use(self, solver: str) -> None:
        solve = ipopt.solve if solver == "ipopt" else slp.solve
        self.solver, self.solve = solver, partial(solve, deadline=self.deadline)

    def status(self, tolerance: float) -> SearchStatus:
        """Say how the search ended, of the best motion.

        Parameters
        ----------
        tolerance : float
            A solve whose motion takes longer by this share converged to the same time.

        Returns
        -------
        SearchStatus
        """
        if self.ended:
            return SearchStatus.INTERRUPTED if self.deadline.interrupted else SearchStatus.TIME_LIMIT
        if self.best is not None and self.converged <= self.best.verdict.seconds * (1.0 + tolerance):
            return SearchStatus.OK
        return SearchStatus.NOT_CONVERGED

    def offer(self, name: str, motion: ArcMotion | Refusal, status: str = "") -> VerifiedMotion | None:
        """Judge a motion, and keep it if it is the best.

        Parameters
        ----------
        name : str
            Of the stage.
        motion : ArcMotion or Refusal
        status : str
            How the solver ended.

        Returns
        -------
        VerifiedMotion or None
            None if the check refuses the motion.
        """
        found, refusal = None, motion.reason if isinstance(motion, Refusal) else ""
        if not isinstance(motion, Refusal):
            found, refusal = judged(self.task, name, motion)
        seconds = np.inf if found is None else found.verdict.seconds
        now = time.perf_counter()
        self.stages.append(Stage(name, seconds, refusal or status, now - self.clock))
        self.clock = now
        if found is not None and (self.best is None or seconds < self.best.verdict.seconds):
            self.best = found
        if self.progress is not None:
            self.progress(name, seconds)
        return found

    def run(self, mesh: int, tolerance: float) -> None:
        """Search until a finer mesh gains less than a tenth of the tolerance.

        Parameters
        ----------
        mesh : int
            Arcs per segment and joint to begin with.
        tolerance : float
            Relative, of the total time; one mesh only from 1e-3 on.
        """
        try:
            self._run(mesh, tolerance)
        except SearchEnded:
            self.ended = True
        if self.solved is not None and self.best is not None:
            program, solution, seconds = self.solved
            if seconds <= self.best.verdict.seconds * (1.0 + 1e-3):
                self.sensitivity = read_sensitivity(program, solution)

    def _run(self, mesh: int, tolerance: float) -> None:
        begin = start = stop_and_go_motion(self.task)
        found = self.offer("stop and go", start)
        self.second = float(start.times.mean())
        if not self.task.is_open:
            self.converged = np.inf if found is None else found.verdict.seconds
            return
        if self.task.hurried:
            start = self._nearest(start, mesh)
            if self.missed > _MISSED:
                start = self._nearest_from_the_fastest(start, mesh)
            if self.missed > _MISSED:
                return
        elif not self.task.stretchable:  # the closed form starts and ends at rest
            self._states("stop and go, by Ruckig", start)
        arcs, before = mesh, np.inf
        for _ in range(ROUNDS):
            self._round(start, arcs)
            now = np.inf if self.best is None else self.best.verdict.seconds
            if tolerance >= 1e-3 or before - now <= 0.1 * tolerance * now:
                break
            arcs, before = (3 * arcs) // 2, now
        if self.task.hurried and not np.isfinite(self.converged):
            self._round(begin, mesh)
        if self.solved is None and self.solver == "ipopt" and self.task.stretchable:
            self._use("highs")
            self._round(start, mesh)
        self._finish(tolerance)

    def run_timed(self, mesh: int) -> list[str]:
        """Search for the smoothest motion that takes the given time, or else for any.

        Parameters
        ----------
        mesh : int
            Arcs per segment and joint.

        Returns
        -------
        list of str
            Notes, where the motion is not the smoothest.
        """
        try:
            return self._run_timed(mesh)
        except SearchEnded:
            self.ended = True
            return ["not the smoothest motion: the search for it was not finished"]

    def _run_timed(self, mesh: int) -> list[str]:
        start = stop_and_go_motion(self.task)
        self.second = float(start.times.mean())
        if not self.task.group(2) and not self.task.group(3):
            found = self.offer("steady", start)
            self.converged = np.inf if found is None else found.verdict.seconds
            return []
        if self.solver == "ipopt":
            self._solved("smoothest", start, 3 * mesh, free=False, tolerance=_TIGHT, smooth=True)
            if self.best is not None:
                return []
        self._fastest_slowed(mesh)
        self._go_on()
        if self.best is None and self.nearest is None:
            self._run(mesh, 1e-3)
        return ["not the smoothest motion: no solution of that program was found"]

    def _nearest(self, start: ArcMotion, arcs: int) -> ArcMotion:
        """Look for a motion that meets the times asked for: the one that misses them least."""
        name, n = "nearest to the given times", arcs + arcs // 2
        near = self._solved(name, start, n, free=False, tolerance=1e-6, elastic=True)
        if missed(self.task, near) > 1e-6 or self.best is None:
            finer = self._solved(f"{name}, arcs", near, arcs, free=True, tolerance=_TIGHT, elastic=True)
            if missed(self.task, finer) < missed(self.task, near):
                near = finer
        self.missed, self.nearest = missed(self.task, near), near
        return near

    def _nearest_from_the_fastest(self, near: ArcMotion, arcs: int) -> ArcMotion:
        """Look once more, from the fastest motion and with arcs: even steps miss times just possible."""
        inner = self._without_times(arcs)
        if inner.best is None:
            return near
        name, fastest = "nearest to the given times, from the fastest", inner.best.motion
        found = self._solved(name, fastest, arcs, free=True, tolerance=_TIGHT, elastic=True)
        if (off := missed(self.task, found)) >= self.missed:
            return near
        self.missed, self.nearest = off, found
        if self.missed <= _MISSED:
            self._solved("arcs", found, arcs, free=True, tolerance=_TIGHT)
        return found

    def _without_times(self, mesh: int) -> MeshRefinement:
        """The search for the fastest motion that need not meet the times asked for."""
        inner = MeshRefinement(self.task.unhurried(), self.solver, None, self.deadline)
        inner.run(mesh, 1e-3)
        return inner

    def _fastest_slowed(self, mesh: int) -> None:
        """Slow the fastest motion down to the given time; it may violate other conditions."""
        task, inner = self.task, self._without_times(mesh)
        if inner.best is not None:
            motion = inner.best.motion
            factor = task.windows[task.n_segments][0] / float(motion.times.sum())
            if factor < 1.0 and len(task.windows) == 1 and not inner.ended:
                self.nearest, self.missed = motion, missed(task, motion)
            found = self.offer("fastest, slowed down", motion.stretched(factor))
            if found is not None and inner.status(1e-3) is SearchStatus.OK:
                self.converged = found.verdict.seconds

    def _round(self, start: ArcMotion, arcs: int) -> None:
        """One round: even steps, waypoint states, free arcs."""
        coarse = self._solved("even steps", start, arcs + arcs // 2, free=False, tolerance=1e-4)
        self._between_states(coarse, arcs)

    def _between_states(self, start: ArcMotion, arcs: int, where: str = "") -> None:
        """Waypoint states of a motion, and free arcs from there."""
        digits = _LOOSE if self.task.stretchable else _TIGHT  # slowing down corrects loose solutions
        states = self._states(f"waypoint states{where}", start)
        # where Ruckig refuses, or its motion is a bad start, the arcs start from the motion itself
        starts = [] if isinstance(states, Refusal) else [(states, arcs)]
        for first, n in [*starts, (start, arcs + arcs // 2)]:
            self._solved(f"arcs{where}", first, n, free=True, tolerance=digits)
            best = np.inf if self.best is None else self.best.verdict.seconds
            if not self.reason and self.stages[-1].seconds <= best * (1.0 + 1e-4):
                break

    def _states(self, name: str, motion: ArcMotion) -> ArcMotion | Refusal:
        """Retime a motion between its waypoint states."""
        self._go_on()
        states = retime(self.task, motion)
        if self.offer(name, states) is None and not self.task.hurried:
            other = retime(self.task, motion, by_speed=True)
            if self.offer(name, other) is not None or isinstance(states, Refusal):
                return other
        return states

    def _solved(
        self,
        name: str,
        start: ArcMotion,
        arcs: int,
        *,
        free: bool,
        tolerance: float,
        smooth: bool = False,
        elastic: bool = False,
    ) -> ArcMotion:
        """Solve on one mesh; where the motion leaves the position limits, pose rows (6) and solve again."""
        self._go_on()
        for _ in range(_GUARDS):
            program = FreeFormNLP(
                self.task,
                (min(arcs, 4) if free else arcs, arcs),
                free=free,
                second=self.second,
                guarded=self.guarded,
                smooth=smooth,
                elastic=elastic,
            )
            solution = self.solve(
                program, program.point(start), tolerance=tolerance, near=1e-4 if free else None
            )
            motion = program.motion(solution.x)
            leaving = outside(self.task, motion) - self.guarded
            if not leaving or self.deadline.over:
                break
            self.guarded |= leaving
            start = motion
        self.last = motion if free else self.last
        found = self.offer(name, motion, solution.status)
        if (free or smooth) and not elastic:
            self.reason = "" if solution.converged else solution.status
            if solution.converged and found is not None:
                self.converged = min(self.converged, found.verdict.seconds)
        if free and found is not None and not elastic:
            self._remember(program, solution, found.verdict.seconds)
        return motion

    def _go_on(self) -> None:
        if self.deadline.over:
            raise SearchEnded

    def _remember(self, program: FreeFormNLP, solution: NLPSolution, seconds: float) -> None:
        if self.deadline.over and not solution.converged:
            return  # multipliers of a point on the way mean nothing
        if self.solved is None or seconds < self.solved[2]:
            self.solved = (program, solution, seconds)

    def _finish(self, tolerance: float) -> None:
        """Solve the best arcs to full accuracy, and retime them."""
        if self.solved is None:
            return
        program, solution, _ = self.solved
        if tolerance < 1e-4:
            self._go_on()
            solution = self.solve(program, solution.x, tolerance=_TIGHT, near=1e-7, warm=solution)
            motion = program.motion(solution.x)
            found = self.offer("arcs, to the last digits", motion, solution.status)
            if found is not None:
                self._remember(program, solution, found.verdict.seconds)
        program, solution, _ = self.solved
        if not self.task.hurried:
            self._states("waypoint states of the arcs", program.motion(solution.x))
