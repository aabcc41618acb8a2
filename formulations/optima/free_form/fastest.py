"""``free_form``: the fastest motion through the waypoints, and what is known of it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import casadi
import numpy as np

from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.free_form.nlp.assembly import RAMP
from formulations.optima.free_form.nlp.task import Task
from formulations.optima.free_form.search import Found, Search, Stage
from formulations.optima.free_form.sensitivity import Sensitivity
from formulations.problem.arrays import Array
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError, NoFeasibleMotion
from formulations.problem.problem import Problem
from formulations.references.ruckig_ import ruckig_stop_and_go

Solver = Literal["ipopt", "highs"]
_LEAST_ARCS, _MOST_ARCS = 3, 100


@dataclass(frozen=True)
class FreeForm:
    """The best motion found, judged by the independent check.

    durations: (n_segments,) [s]. trajectory, verdict: None where nothing moves and nothing takes time.
    method: the stage that found it. status: ``ok``, or how the local solver ended otherwise; the motion
    keeps everything asked for in either case. sensitivity: None where no program was solved to within
    1e-3 of the motion, or where the time is fixed. stages: all that was tried, in order. runtime: [s].
    """

    problem: Problem
    conditions: Conditions
    durations: Array
    trajectory: Trajectory | None
    verdict: Verdict | None
    method: str
    status: str
    notes: tuple[str, ...]
    sensitivity: Sensitivity | None
    stages: tuple[Stage, ...]
    runtime: float

    @property
    def seconds(self) -> float:
        """Total time [s]."""
        return 0.0 if self.trajectory is None else self.trajectory.seconds


def free_form(
    problem: Problem,
    *,
    conditions: Conditions | None = None,
    mesh: int = 7,
    tolerance: float = 1e-3,
    solver: Solver = "ipopt",
    progress: Callable[[str, float], None] | None = None,
) -> FreeForm:
    """The fastest motion found among all with bounded velocity, acceleration and jerk.

    mesh: arcs per segment and joint to begin with; Ruckig's profiles have seven, and few optima need
    more. tolerance: of the total time, relative; below 1e-3 the mesh is refined until a finer one gains
    less than a tenth of it, and below 1e-4 the best is solved to the last digits. It is an aim, not a
    proof: see ``free_form_bound``. solver: ``ipopt``, or ``highs`` for sequential linear programs.
    progress: called with each stage and its time [s], infinite if the check refused its motion.

    With ``conditions.total`` the smoothest motion that takes this time: least integral over time of the
    sum over joints of (jerk / limit)^2 (without a jerk limit: acceleration), on even steps of constant
    jerk. With velocity limits alone no motion attains the infimum: the one given is within 3e-6 of it.

    Without conditions there is always an answer, never slower than stop and go. Raises InputError for
    conditions that do not fit the problem, NoFeasibleMotion where none was found that keeps them.
    """
    begun = time.perf_counter()
    asked = conditions or Conditions()
    asked.validate(problem)
    if not (_LEAST_ARCS <= mesh <= _MOST_ARCS):
        raise InputError(f"mesh: {mesh} arcs per segment, expected {_LEAST_ARCS} to {_MOST_ARCS}")
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise InputError(f"tolerance: {tolerance:g} is not positive")
    if solver not in ("ipopt", "highs"):
        raise InputError(f"solver: {solver!r} is not known (known: highs, ipopt)")
    notes = []
    if solver == "ipopt" and not casadi.has_nlpsol("ipopt"):
        solver = "highs"
        notes.append("this CasADi has no IPOPT: solved by sequential linear programs")
    task = Task(problem, asked)
    if not task.n_segments:
        return _nothing_moves(problem, asked, begun)
    search = Search(task, solver, progress)
    if task.timed:
        notes += search.run_timed(mesh)
    else:
        search.run(mesh, tolerance)
    best = search.best
    if best is None:
        raise NoFeasibleMotion(_why_not(problem, asked, search, mesh, solver))
    if asked.none and best.verdict.seconds > 0.999 * search.stages[0].seconds:
        best = _or_ruckig(problem, best)
    if task.group(1):
        notes.append(
            "joints without an acceleration limit have no fastest motion, only an infimum: they change "
            f"their velocity within {RAMP:g} of each segment"
        )
    return FreeForm(
        problem,
        asked,
        np.diff(best.trajectory.passage_times),
        best.trajectory,
        best.verdict,
        best.name,
        search.status,
        tuple(notes),
        search.sensitivity,
        tuple(search.stages),
        time.perf_counter() - begun,
    )


def _nothing_moves(problem: Problem, asked: Conditions, begun: float) -> FreeForm:
    return FreeForm(
        problem,
        asked,
        np.zeros(problem.n_segments),
        None,
        None,
        "nothing moves",
        "ok",
        (),
        None,
        (),
        time.perf_counter() - begun,
    )


def _or_ruckig(problem: Problem, best: Found) -> Found:
    """Ruckig's own stop and go, should rounding make it the faster one."""
    outcome = ruckig_stop_and_go(problem)
    if outcome.trajectory is None or outcome.trajectory.seconds >= best.verdict.seconds:
        return best
    verdict = check(problem, outcome.trajectory)
    name = "stop and go, by Ruckig"
    return replace(best, name=name, trajectory=outcome.trajectory, verdict=verdict)


def _why_not(problem: Problem, asked: Conditions, search: Search, mesh: int, solver: Solver) -> str:
    """One line that names the conditions and, where times are fixed, what is possible without."""
    named = [key for key in ("passage", "total", "stops", "segment_limits") if getattr(asked, key)]
    named += [key for key in ("start_velocity", "end_velocity") if getattr(asked, key) is not None]
    line = f"no motion found that keeps conditions.{', conditions.'.join(named)}"
    if asked.times(problem):
        freed = replace(asked, passage={}, total=None)
        try:
            fastest = free_form(problem, conditions=freed, mesh=mesh, solver=solver)
        except NoFeasibleMotion as none:
            return f"{line}; nor without fixed times: {none}"
        if fastest.trajectory is not None:
            passed = [
                f"waypoint {w} at {fastest.trajectory.passage_times[w]:.9g} s, {time:.9g} s asked for"
                for w, time in sorted(asked.times(problem).items())
            ]
            return f"{line}; the fastest one found passes {'; '.join(passed)}"
    last = next((stage.status for stage in reversed(search.stages) if stage.status), "")
    return f"{line}; the last one tried: {last}"
