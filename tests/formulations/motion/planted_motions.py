"""Motions that the tests of the check start from, and the faults that they plant in them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from conftest import Array

from formulations import FAMILIES, InputError, Limits, Problem, Trajectory, check

SAMPLES = np.linspace(0.0, 1.0, 20_001)
HERMITE = np.array([0.0, 0.0, 0.0, 10.0, -15.0, 6.0])  # 0 to 1, rest to rest, in 1 s
HERMITE_PEAKS = (15.0 / 8.0, 10.0 / math.sqrt(3.0), 60.0)
THIRD = 0.5 - math.sqrt(3.0) / 6.0  # where its acceleration peaks


def one_piece(*coefficients: float, duration: float = 1.0) -> Trajectory:
    """One joint, one polynomial in local time."""
    return Trajectory(np.array([duration]), np.array([[coefficients]], dtype=np.float64))


def rest_to_rest(waypoints: Array, times: Array) -> Trajectory:
    """Quintics that rest at every waypoint."""
    steps = np.diff(waypoints, axis=0)
    powers = times[:, None, None] ** np.arange(6)
    coefficients = steps[:, :, None] * HERMITE / powers
    coefficients[:, :, 0] = waypoints[:-1]
    return Trajectory(times, coefficients)


def at(c: Array, order: int) -> Array:
    """Samples (..., SAMPLES) of a derivative of ascending coefficients on [0, 1]."""
    for _ in range(order):
        c = c[..., 1:] * np.arange(1, c.shape[-1]) if c.shape[-1] > 1 else np.zeros_like(c)
    return np.asarray(np.polynomial.polynomial.polyval(SAMPLES, np.moveaxis(c, -1, 0)))


WAYPOINTS = np.array([[0.0, 0.2], [0.5, -0.3], [0.9, 0.4], [2.0, 0.1]])
TIMES = np.array([1.0, 1.5, 1.2])
WIDE = {"velocity": 50.0, "acceleration": 500.0}


def problem_of(jerk: float = np.inf, waypoints: Array = WAYPOINTS) -> Problem:
    return Problem.of(waypoints, Limits.of(**WIDE, jerk=jerk, dof=2))


def spline() -> Trajectory:
    return FAMILIES["3-5-3"].trajectory(problem_of(), TIMES)


def bumped(motion: Trajectory, piece: int, joint: int, bump: np.polynomial.Polynomial) -> Trajectory:
    """A motion plus a polynomial of local time on one piece of one joint."""
    c = motion.coefficients.copy()
    c[piece, joint, : len(bump.coef)] += bump.coef
    return replace(motion, coefficients=c)


def kick(order: int, size: float, duration: float) -> np.polynomial.Polynomial:
    """A bump whose derivative of one order is ``size`` at its start; all else is zero at both ends."""
    t = np.polynomial.Polynomial([0.0, 1.0])
    rest = 1.0 - t / duration
    if order == 0:
        s = t / duration
        return size * rest**3 * (1.0 + 3.0 * s + 6.0 * s**2)
    if order == 1:
        return size * t * rest**3 * (1.0 + 3.0 * t / duration)
    return 0.5 * size * t**2 * rest**3


def judged_infeasible(problem: Problem, motion: Trajectory) -> bool:
    """Refused as input, or found wanting; anything but accepted."""
    try:
        verdict = check(problem, motion)
    except InputError:
        return True
    return not verdict.feasible
