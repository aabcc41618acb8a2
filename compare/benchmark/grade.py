"""One swarm run on one problem, judged: what it claims, whether that holds, what is left of it."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from compare.benchmark.objective import CODINGS, Objective, search_box
from formulations import FAMILIES, Problem, check, longest_segment
from formulations.problem.arrays import Array
from metaheuristics import Result, algorithm, minimise

REACHED = 1e-3  # gap below which a swarm in the stretched coding has found its optimum


@dataclass(frozen=True)
class Run:
    """What to run. budget: evaluations (of each joint, in the published coding).

    seconds: time limit of the swarm's own work per search, in a process of its own; None: in this one.
    """

    case: str
    coding: str
    swarm: str
    seed: int
    budget: int
    population: int
    seconds: float | None = None

    @property
    def key(self) -> tuple[str, str, str, int, int, int]:
        """What tells one run from another."""
        return self.case, self.coding, self.swarm, self.seed, self.budget, self.population


@dataclass(frozen=True)
class Trace:
    """Best fitness against evaluations of one ``minimise`` call; joint -1: all joints at once."""

    joint: int
    evaluations: list[int]
    best: list[float]


@dataclass(frozen=True)
class Graded:
    """A finished run. ``row`` is flat: text, numbers, None. ``traces``: one per minimise call."""

    run: Run
    row: dict[str, Any]
    traces: list[Trace]


def grade(run: Run, problem: Problem, bound: float | None, proof: str = "local optimum") -> Graded:
    """Run a swarm and judge its best vector by the independent check.

    bound: what the gap is measured against [s], None if there is nothing; proof: what stands behind it.
    """
    if run.coding == "published":
        joints = problem.moving_joints
        objectives = [Objective(problem.joint(j), stretch=False) for j in joints]
    else:
        joints = [-1]
        objectives = [Objective(problem, stretch=run.coding == "stretched")]
    lo, hi = search_box(problem)
    swarm = algorithm(run.swarm)
    search = swarm.search(run.seconds)
    parameters = dict(swarm.parameters)
    if "population" in parameters:
        parameters["population"] = run.population

    results = [
        minimise(
            search,
            objective,
            lo,
            hi,
            budget=run.budget,
            seed=_seed(run, joint),
            **parameters,
        )
        for joint, objective in zip(joints, objectives, strict=True)
    ]
    traces = [
        Trace(joint, result.trace_evaluations.tolist(), result.trace_best.tolist())
        for joint, result in zip(joints, results, strict=True)
    ]
    row: dict[str, Any] = {
        "case": run.case,
        "family": problem.family,
        "coding": run.coding,
        "swarm": run.swarm,
        "library": swarm.versions,
        "seed": run.seed,
        "budget": run.budget,
        "population": run.population,
        "evaluations": sum(result.evaluations for result in results),
        "seconds_algorithm": sum(result.seconds_algorithm for result in results),
        "seconds_objective": sum(result.seconds_objective for result in results),
        **_judged(run.coding, problem, objectives, results),
        "bound": bound,
        "proof": proof,
    }
    row["gap"] = _relative(row["seconds"], bound)
    row["claimed_gap"] = _relative(row["claimed"], bound)
    missed = row["status"] == "ok" and run.coding == "stretched" and (row["gap"] or 0.0) > REACHED
    if missed and swarm.shortfall:
        row["note"] = swarm.shortfall
    return Graded(run, row, traces)


def _judged(
    coding: str, problem: Problem, objectives: list[Objective], results: list[Result]
) -> dict[str, Any]:
    """Status, claimed time, stretch, verified time and durations of the motion that was found."""
    nothing = {"claimed": None, "keeps_limits": None, "stretch": None, "worst": "", "seconds": None}
    faults = [r for r in results if r.status != "ok"]
    status = faults[0].status.value if faults else "ok"
    note = faults[0].note if faults else ""
    vectors = [result.x for result in results]
    found = [
        objective.durations(x)
        for objective, x in zip(objectives, vectors, strict=True)
        if x is not None
    ]
    if len(found) < len(vectors) or not found:
        missing = f"{len(vectors) - len(found)} of {len(vectors)} searches found nothing feasible"
        status = status if faults else "nothing-moves"
        return {"status": status, "note": note or missing, **nothing, "durations": ""}

    if coding == "published":
        rule = longest_segment(problem, found)
        claimed, honest = rule.claimed, rule.durations
    else:
        claimed = honest = found[0]
    family = FAMILIES[problem.family]
    as_claimed = check(problem, family.trajectory(problem, claimed))
    verdict = check(problem, family.trajectory(problem, honest))
    if not verdict.feasible:
        status = "breaks-position-limits" if not verdict.position_kept else "check-failed"
        note = verdict.faults[0]
    worst = as_claimed.worst
    return {
        "status": status,
        "note": note,
        "claimed": as_claimed.seconds,
        "keeps_limits": as_claimed.feasible,
        "stretch": as_claimed.stretch,
        "worst": "" if worst is None or as_claimed.feasible else str(worst),
        "seconds": verdict.seconds if verdict.feasible else None,
        "durations": " ".join(repr(float(t)) for t in honest),
    }


def _seed(run: Run, joint: int) -> np.random.SeedSequence:
    """Random numbers of a search depend on what is run, not on when or by which worker."""
    swarm = algorithm(run.swarm).seeded_as or run.swarm
    names = f"{run.case}/{run.coding}/{swarm}".encode()
    return np.random.SeedSequence([run.seed, zlib.crc32(names), joint + 1])


def _relative(seconds: float | None, bound: float | None) -> float | None:
    if seconds is None or not bound:
        return None
    return seconds / bound - 1.0


def durations_of(row: dict[str, Any]) -> Array:
    """The durations of a row's verified motion, (n_segments,) [s]; empty if it has none."""
    return np.array([float(part) for part in str(row["durations"]).split()])


__all__ = ["CODINGS", "Graded", "Run", "Trace", "durations_of", "grade"]
