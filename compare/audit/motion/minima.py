"""Least times that are proved: at the printed waypoints, and for all waypoints that print alike."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np

from formulations import FamilyBound, FamilyOptimum, Problem, family_bound
from formulations.optima.family.optimum import local_optimum
from formulations.optima.family.program import duration_scales
from formulations.problem.arrays import Array
from formulations.proofs.family import PROVERS
from formulations.proofs.proof import Proof

_GAP, _SECONDS = 1e-5, 4.0  # relative gap and time limit of a certified optimum
_PROOF_SECONDS, _SLICE = 2.0, 256  # time limit of one proof [s], boxes between two looks at the clock
_NARROWEST, _OF_BLUR = 1e-9, 0.01  # least width of a box: absolute, and relative to the rounding


@dataclass(frozen=True)
class _Posed:
    """A problem that compares and hashes by what its optimum depends on."""

    problem: Problem = field(compare=False)
    key: tuple[Any, ...]


def minimum(problem: Problem) -> FamilyBound:
    """Prove the least time of the problem's spline family, at the printed digits.

    Results are remembered.

    Parameters
    ----------
    problem : Problem
        The task.

    Returns
    -------
    FamilyBound
        ``seconds`` is the certified lower bound, ``upper`` the best verified time.
    """
    limits = problem.limits
    parts = (problem.waypoints, limits.derivatives, limits.position)
    return _minimum(_Posed(problem, (problem.family, *(part.tobytes() for part in parts))))


@cache
def _minimum(posed: _Posed) -> FamilyBound:
    problem = posed.problem
    return family_bound(problem, gap=_GAP, time_limit=_SECONDS, optimum=_start(problem))


def _start(problem: Problem) -> FamilyOptimum | None:
    """Optimise from one start. The proof finds a better basin if there is one."""
    scales = duration_scales(problem)
    local = local_optimum(problem, np.sqrt(scales * scales.max()))
    if not np.isfinite(local.seconds):
        return None
    return FamilyOptimum(problem, problem.family, local.durations, (local,))


def reached(problem: Problem) -> float:
    """Find the time of one locally optimal motion: an upper bound on the least time of the family.

    Parameters
    ----------
    problem : Problem
        The task.

    Returns
    -------
    float [s]
        Infinite if no motion was found.
    """
    start = _start(problem)
    return float("inf") if start is None else start.seconds


def impossible(problem: Problem, halves: Array, seconds: float) -> bool:
    """Try to prove that no spline of the family is as fast, whatever the rounding of the waypoints.

    Parameters
    ----------
    problem : Problem
        The limits hold as they stand; give ``StatedLimits.loosest`` if they are rounded, too.
    halves : Array, shape (n_waypoints, dof) [rad]
        Half units of the waypoints' last digits.
    seconds : float [s]
        The time that a spline through waypoints that print like these would have to undercut.

    Returns
    -------
    bool
        Whether it is proved. False if the family has no prover, if the proof takes longer than a few
        seconds, or if the digits leave open whether anything moves on a segment.
    """
    if problem.family not in PROVERS or not problem.moving_joints:
        return False
    blur = halves[1:] + halves[:-1]
    d = np.abs(problem.displacements)
    moves, rests = (d > 2.0 * blur).any(axis=1), ((d == 0.0) & (blur == 0.0)).all(axis=1)
    if not (moves | rests).all():
        return False
    # a box much narrower than the rounding cannot be decided either
    relative = float((blur / np.where(d > 2.0 * blur, d, np.inf)).max())
    narrow = max(_NARROWEST, _OF_BLUR * relative)
    proof = Proof(PROVERS[problem.family](problem, seconds, narrow=narrow, blur=blur), seconds)
    started = time.perf_counter()
    while not (proof.proved or proof.stuck) and time.perf_counter() - started < _PROOF_SECONDS:
        proof.run(_SLICE)
    return proof.proved


def crossing_times(problem: Problem, halves: Array) -> Array:
    """Least time by displacement over velocity limit: a bound for any motion.

    It holds for all waypoints that print like these.

    Parameters
    ----------
    problem : Problem
        The task.
    halves : Array, shape (n_waypoints, dof) [rad]
        Half units of the waypoints' last digits.

    Returns
    -------
    Array, shape (n_segments, dof) [s]
    """
    blur = halves[1:] + halves[:-1]
    d = np.maximum(np.abs(problem.displacements) - blur * (1.0 + 1e-12), 0.0)
    return np.asarray(d / problem.limits.velocity * (1.0 - 1e-14))
