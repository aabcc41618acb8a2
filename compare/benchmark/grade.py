"""Run a swarm once and judge its motion: the claim, whether it keeps its limits, its verified time."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from compare.benchmark.coordinates import as_printed, seen_in
from compare.benchmark.objective import CODINGS, Objective, search_box
from compare.benchmark.protocol import Coordinates, Track, shares
from compare.benchmark.records.provenance import machine, parameters_of, provenance_of
from compare.benchmark.records.rows import (
    BoundProof,
    Row,
    RowStatus,
    RunKey,
    durations_of,
    relative_gap,
)
from formulations import FAMILIES, Problem, check, longest_segment
from formulations.problem.arrays import Array
from metaheuristics import Result, algorithm, minimise

REACHED = 1e-3  # gap below which a swarm in the stretched coding has found its optimum


@dataclass(frozen=True)
class Run:
    """What to run.

    Attributes
    ----------
    budget : int
        Evaluations over the whole motion. In the published coding the joints that move share them.
    time_limit : float or None [s]
        Limit on the swarm's own work per search. A swarm with a limit runs in a process of its own.
        A plug-in always does, for at most `metaheuristics.entry.TIME_LIMIT` if none is given.
    track : Track
        Which rules it follows; the plan has counted the budget by them.
    coordinates : Coordinates
        In which the swarm sees the durations.
    constants : tuple of (str, number)
        Constants of the swarm in place of the published ones, in the track ``tuned``.
    """

    case: str
    coding: str
    swarm: str
    seed: int
    budget: int
    population: int
    time_limit: float | None = None
    track: Track = Track.equal
    coordinates: Coordinates = Coordinates.printed
    constants: tuple[tuple[str, float | int], ...] = ()

    @property
    def key(self) -> RunKey:
        """What tells one run from another."""
        return RunKey(
            self.case,
            self.coding,
            self.swarm,
            self.seed,
            self.budget,
            self.population,
            self.track,
            self.coordinates,
        )


@dataclass(frozen=True)
class Trace:
    """Best fitness [s] against evaluations of one search.

    Attributes
    ----------
    joint : int
        Joint that was searched alone, from 0; -1: all joints at once.
    evaluations : list of int
        Numbers of evaluations at which the best fitness fell, and the last.
    best : list of float [s]
        Best fitness after each of them.
    """

    joint: int
    evaluations: list[int]
    best: list[float]


@dataclass(frozen=True)
class Graded:
    """A finished run: its row, and one trace for each search."""

    run: Run
    row: Row
    traces: list[Trace]


def grade(
    run: Run,
    problem: Problem,
    bound: float | None,
    proof: str = BoundProof.local_optimum,
    box: tuple[float, float] | None = None,
    start: ArrayLike | None = None,
) -> Graded:
    """Run a swarm and judge its best vector by the independent check.

    Parameters
    ----------
    run : Run
    problem : Problem
        The problem of ``run.case``.
    bound : float or None [s]
        What the gap is measured against; None: the row has no gap.
    proof : BoundProof or its text
        What stands behind the bound.
    box : tuple of float, optional [s]
        Least and greatest duration that the swarm may try, where a paper is read so (``search_box``).
    start : array_like, shape (m, n_segments), optional
        Vectors to start from, as `metaheuristics.minimise` takes them, in the box and in coordinates as
        printed. The note of the row tells it from a run without them.

    Returns
    -------
    Graded
        A misbehaving swarm is a status in its row, never an exception.
    """
    if run.coding == "published":
        joints = problem.moving_joints
        objectives = [Objective(problem.joint(j), stretch=False) for j in joints]
    else:
        joints = [-1]
        objectives = [Objective(problem, stretch=run.coding == "stretched")]
    lo, hi = search_box(problem, box)
    swarm = algorithm(run.swarm)
    made_by = provenance_of(run.swarm, problem, run.population, run.time_limit, run.constants)
    search = swarm.search(made_by.time_limit)
    results = [
        minimise(
            search,
            *seen_in(run.coordinates, objective, lo, hi),
            budget=budget,
            seed=_seed(run, joint),
            start=start,
            **parameters_of(swarm, run.population, run.constants),
        )
        for joint, objective, budget in zip(
            joints, objectives, shares(run.budget, len(joints)), strict=True
        )
    ]
    traces = [
        Trace(joint, result.trace_evaluations.tolist(), result.trace_best.tolist())
        for joint, result in zip(joints, results, strict=True)
    ]
    found = [
        None if result.x is None else as_printed(run.coordinates, result.x, lo, hi)
        for result in results
    ]
    motion = _judged(run.coding, problem, objectives, results, found)
    gap = relative_gap(motion.seconds, bound)
    note = motion.note
    missed = motion.status is RowStatus.ok and run.coding == "stretched" and (gap or 0.0) > REACHED
    if missed and swarm.shortfall:
        note = swarm.shortfall
    if start is not None:
        note = "; ".join(filter(None, [f"started from {len(np.asarray(start))} given vectors", note]))
    row = Row(
        case=run.case,
        family=problem.family,
        coding=run.coding,
        swarm=run.swarm,
        library=made_by.library,
        parameters=made_by.parameters,
        code=made_by.code,
        seed=run.seed,
        status=motion.status,
        claimed=motion.claimed,
        keeps_limits=motion.keeps_limits,
        stretch=motion.stretch,
        seconds=motion.seconds,
        bound=bound,
        proof=BoundProof(proof),
        gap=gap,
        claimed_gap=relative_gap(motion.claimed, bound),
        budget=run.budget,
        population=run.population,
        track=run.track,
        coordinates=run.coordinates,
        evaluations=sum(result.evaluations for result in results),
        durations=motion.durations,
        worst=motion.worst,
        note=note,
        isolated=made_by.isolated,
        time_limit=made_by.time_limit,
        seconds_algorithm=float(sum(result.seconds_algorithm for result in results)),
        seconds_objective=float(sum(result.seconds_objective for result in results)),
        problem=made_by.problem,
        versions=made_by.versions,
        machine=machine(),
    )
    return Graded(run, row, traces)


@dataclass(frozen=True)
class _Motion:
    """What a run found, judged; the fields are those of `Row`."""

    status: RowStatus
    note: str
    claimed: float | None = None
    keeps_limits: bool | None = None
    stretch: float | None = None
    worst: str = ""
    seconds: float | None = None
    durations: tuple[float, ...] = ()


def _judged(
    coding: str,
    problem: Problem,
    objectives: list[Objective],
    results: list[Result],
    vectors: list[Array | None],
) -> _Motion:
    """Judge the motion that the searches found: as claimed, and once it keeps the limits."""
    faults = [r for r in results if r.status != "ok"]
    status = RowStatus(faults[0].status.value) if faults else RowStatus.ok
    note = faults[0].note if faults else ""
    found = [
        objective.durations(x)
        for objective, x in zip(objectives, vectors, strict=True)
        if x is not None
    ]
    if len(found) < len(vectors) or not found:
        missing = f"{len(vectors) - len(found)} of {len(vectors)} searches found nothing feasible"
        return _Motion(status if faults else RowStatus.nothing_moves, note or missing)

    if coding == "published":
        rule = longest_segment(problem, found)
        claimed, feasible = rule.claimed, rule.durations
    else:
        claimed = feasible = found[0]
    family = FAMILIES[problem.family]
    as_claimed = check(problem, family.trajectory(problem, claimed))
    verdict = check(problem, family.trajectory(problem, feasible))
    if not verdict.feasible:
        kept = verdict.position_kept
        status = RowStatus.check_failed if kept else RowStatus.breaks_position_limits
        note = verdict.faults[0]
    worst = as_claimed.worst
    return _Motion(
        status=status,
        note=note,
        claimed=as_claimed.seconds,
        keeps_limits=as_claimed.feasible,
        stretch=as_claimed.stretch,
        worst="" if worst is None or as_claimed.feasible else str(worst),
        seconds=verdict.seconds if verdict.feasible else None,
        durations=tuple(float(t) for t in feasible),
    )


def _seed(run: Run, joint: int) -> np.random.SeedSequence:
    """Random numbers of a search depend on what is run, not on when or by which worker."""
    swarm = algorithm(run.swarm).seeded_as or run.swarm
    names = f"{run.case}/{run.coding}/{swarm}".encode()
    return np.random.SeedSequence([run.seed, zlib.crc32(names), joint + 1])


__all__ = ["CODINGS", "REACHED", "Graded", "Run", "Trace", "durations_of", "grade"]
