"""Least times that are proved: at the printed waypoints, and for all that print alike."""

from __future__ import annotations

import time

import numpy as np

from formulations import FamilyBound, FamilyOptimum, Limits, Problem, family_bound
from formulations.optima.family.nlp import shortest_segments
from formulations.optima.family.optimum import polished
from formulations.problem.arrays import Array
from formulations.proofs.family import PROVERS
from formulations.proofs.proof import Proof

_GAP, _SECONDS = 1e-5, 4.0  # asked of a certified optimum
_PROOF_SECONDS, _SLICE = 2.0, 256  # s and boxes of one attempt at a proof
_NARROWEST, _OF_BLUR = 1e-9, 0.01  # widths at which it ends, absolute and of the blur

UNREACHED = 1e9  # rad/s: a velocity limit, which a problem must have, that nothing reaches

_known: dict[tuple[object, ...], FamilyBound] = {}


def minimum(problem: Problem) -> FamilyBound:
    """The certified optimum of the problem's family, remembered: nothing of it is faster."""
    limits = problem.limits
    key = (
        problem.family,
        *(part.tobytes() for part in (problem.waypoints, limits.derivatives, limits.position)),
    )
    if key not in _known:
        _known[key] = family_bound(problem, gap=_GAP, time_limit=_SECONDS, optimum=_start(problem))
    return _known[key]


def _start(problem: Problem) -> FamilyOptimum | None:
    """A motion to begin with. One start will do: where there is a better basin, the proof finds it."""
    shortest = shortest_segments(problem)
    local = polished(problem, np.sqrt(shortest * shortest.max()))
    if not np.isfinite(local.seconds):
        return None
    return FamilyOptimum(problem, problem.family, local.durations, (local,))


def impossible(problem: Problem, halves: Array, seconds: float) -> bool:
    """Whether it is proved that no spline of the family takes ``seconds`` or less within the limits,
    through whatever waypoints print like these.

    halves: (n_waypoints, dof) [rad], half units of the print. False where there is no prover, no proof
    within a few seconds, or where the digits leave open whether anything moves on a segment.
    """
    if problem.family not in PROVERS or not problem.moving_joints:
        return False
    blur = halves[1:] + halves[:-1]
    d = np.abs(problem.displacements)
    moves, rests = (d > 2.0 * blur).any(axis=1), ((d == 0.0) & (blur == 0.0)).all(axis=1)
    if not (moves | rests).all():
        return False
    # boxes much narrower than the blur will not be decided either
    relative = float((blur / np.where(d > 2.0 * blur, d, np.inf)).max())
    narrow = max(_NARROWEST, _OF_BLUR * relative)
    proof = Proof(PROVERS[problem.family](problem, seconds, narrow=narrow, blur=blur), seconds)
    started = time.perf_counter()
    while not (proof.proved or proof.stuck) and time.perf_counter() - started < _PROOF_SECONDS:
        proof.run(_SLICE)
    return proof.proved


def crossing_times(problem: Problem, halves: Array) -> Array:
    """Least time per segment and joint by displacement over top speed, (n_segments, dof) [s].

    For whatever waypoints print like these: the physical bound, of any motion.
    """
    blur = halves[1:] + halves[:-1]
    d = np.maximum(np.abs(problem.displacements) - blur * (1.0 + 1e-12), 0.0)
    return np.asarray(d / problem.limits.velocity * (1.0 - 1e-14))


def with_limits(problem: Problem, derivatives: Array, position: Array | None = None) -> Problem:
    """The same task under other limits (3, dof), inf where there is none.

    position: (dof, 2); the problem's own limits of position if it is left out.
    """
    velocity, acceleration, jerk = derivatives
    velocity = np.where(np.isfinite(velocity), velocity, UNREACHED)
    bounds = problem.limits.position if position is None else position
    limits = Limits.of(velocity, acceleration, jerk, bounds, dof=problem.dof)
    return Problem.of(
        problem.waypoints, limits, name=problem.name, family=problem.family,
        title=problem.title, display_unit=problem.display_unit,
    )  # fmt: skip
