"""Peaks of one joint's spline at the printed digits, and their range over all readings of the digits.

low is a rigorous lower bound: at the place where a piece has its extreme at the printed digits, the
derivative is enclosed over the whole box of half units (``ranged``), and a peak is at least the value at
any place. high is an upper bound, rigorous except for the rounding of the peak at the printed digits:
|v(s; e)| <= |v(s; 0)| + sum_i max over the Bernstein coefficients of |dv/de_i|.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Any

import numpy as np

from compare.audit.motion.ranged import Ranged
from formulations import FAMILIES, Problem
from formulations.motion.extremes import Extremes
from formulations.problem.arrays import Array

_DUST = 1e-11  # relative: rounding of the exact extremes and of the Bernstein weights


@dataclass(frozen=True)
class Peaks:
    """Peaks of |velocity|, |acceleration| and |jerk| of one joint, each (3,) [rad/s^k].

    Attributes
    ----------
    printed : Array
        At the printed digits.
    low, high : Array
        Over every reading of the digits.
    range_low, range_high : Array, shape (2,) [rad]
        Least and greatest position, each as an outer and an inner bound.
    """

    printed: Array
    low: Array
    high: Array
    range_low: Array
    range_high: Array


def peaks(problem: Problem, joint: int, halves: Array, times: Array, time_halves: Array) -> Peaks:
    """Enclose the peaks of one joint's spline.

    Parameters
    ----------
    problem : Problem
        The task.
    joint : int
        From 0.
    halves : Array, shape (n_waypoints, dof) [rad]
        Half units of the waypoints' last digits.
    times : Array, shape (n_segments,) [s]
        Durations as printed.
    time_halves : Array, shape (n_segments,) [s]
        Half units of their last digits.

    Returns
    -------
    Peaks

    Raises
    ------
    Undecided
        If the digits leave open which formula of the family holds.
    """
    family = FAMILIES[problem.family]
    one = problem.joint(joint)
    extremes = [family.trajectory(one, times).extremes(order) for order in range(4)]
    lengths, pieces = _on_ranges(one, halves[:, joint], times, time_halves)
    degrees = family.degrees(problem.n_segments)
    printed, low, high = np.zeros(3), np.zeros(3), np.zeros(3)
    bounds = np.zeros((2, 2))
    starts = np.concatenate([[0.0], np.cumsum([float(np.mean(t.value)) for t in lengths])])
    for order in range(4):
        found = _derivatives(pieces, degrees, lengths, order)
        reach = np.array([_reach(polynomial) for polynomial in found])
        bottom, top = extremes[order].low[:, 0], extremes[order].high[:, 0]
        # each piece's own extremes, enclosed where they are at the printed digits
        places = _places(extremes[order], starts)
        least = [_horner(c, s) for c, s in zip(found, places[0], strict=True)]
        most = [_horner(c, s) for c, s in zip(found, places[1], strict=True)]
        if order == 0:
            bounds[0] = (bottom - reach).min(), min(v.hi for v in least)
            bounds[1] = max(v.lo for v in most), (top + reach).max()
            continue
        size = np.maximum(-bottom, top)
        printed[order - 1] = size.max()
        low[order - 1] = max(0.0, *(-v.hi for v in least), *(v.lo for v in most))
        high[order - 1] = (size + reach).max() * (1.0 + _DUST)
    return Peaks(printed, low, high, bounds[0], bounds[1])


def _on_ranges(
    one: Problem, halves: Array, times: Array, time_halves: Array
) -> tuple[list[Any], list[Any]]:
    """Lengths of the pieces and their coefficients (degree 5) as functions of the printed numbers."""
    n, count = one.n_segments, 2 * one.n_segments + 1
    x = np.empty((n + 1, 1), dtype=object)
    for i in range(n + 1):
        x[i, 0] = Ranged.printed(float(one.waypoints[i, 0]), float(halves[i]), i, count)
    t = [Ranged.printed(float(times[k]), float(time_halves[k]), n + 1 + k, count) for k in range(n)]
    lengths, joints = FAMILIES[one.family].symbols(x, t, times)
    return lengths, joints[0]


def _derivatives(
    pieces: list[Any], degrees: tuple[int, ...], lengths: list[Any], order: int
) -> list[list[Any]]:
    """Derivative of each piece as a polynomial of s in [0, 1], ascending, in rad/s^order."""
    found = []
    for c, degree, length in zip(pieces, degrees, lengths, strict=True):
        rate = 1.0
        for _ in range(order):
            rate = rate / length
        polynomial = list(c[: degree + 1])
        for _ in range(order):
            polynomial = [i * polynomial[i] for i in range(1, len(polynomial))]
        found.append([rate * value for value in polynomial] or [0.0 * length])
    return found


def _reach(polynomial: list[Any]) -> float:
    """Greatest distance on [0, 1] between the polynomial and itself at the printed digits."""
    terms = [value for value in polynomial if isinstance(value, Ranged)]
    if not terms:
        return 0.0
    blank = np.zeros_like(terms[0].slope)
    slopes = np.stack([v.slope if isinstance(v, Ranged) else blank for v in polynomial])
    n = len(polynomial) - 1
    weights = np.array([[comb(i, m) / comb(n, m) for m in range(n + 1)] for i in range(n + 1)])
    bernstein = np.abs(np.einsum("im,mpj->ipj", weights, slopes)).max(axis=(0, 1))
    return float(bernstein.sum()) * (1.0 + _DUST)


def _horner(polynomial: list[Any], s: float) -> Ranged:
    total = polynomial[-1]
    for value in polynomial[-2::-1]:
        total = total * s + value
    return total if isinstance(total, Ranged) else Ranged((total, total), np.zeros((2, 1)))


def _places(extremes: Extremes, starts: Array) -> Array:
    """Normalised times of each piece's least and greatest value, (2, n_pieces)."""
    at = np.stack([extremes.time_low[:, 0], extremes.time_high[:, 0]])
    return np.clip((at - starts[:-1]) / np.diff(starts), 0.0, 1.0)
