"""What is legal but was probably not meant: degrees read as radians, and dense waypoints that were rounded."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.joint_words import UNITS, factors

if TYPE_CHECKING:
    from formulations.problem.problem import Problem

_TURNS = 2.0  # turns of a joint from which on degrees may have been read as radians

_FEWEST = 8  # waypoints of a path that was sampled
_GRIDS = {"rad": range(3, 8), "deg": range(1, 7)}  # digits after the point, the coarsest grid first
_EXACT = 1e-6  # of a grid step: by how much a multiple of it may be missed
_COSTS = 1.1  # times as slow as without rounding: less is not worth a word


def hints_of(problem: Problem) -> tuple[str, ...]:
    """Say what looks odd about a problem, a line each.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    tuple of str
        Empty where nothing does.
    """
    return (*_turns(problem), *_rounded(problem))


def _turns(problem: Problem) -> Iterator[str]:
    """Joints that turn so far as if degrees were radians."""
    if problem.display_unit != "rad":
        return
    rotary = np.array(problem.units) == "rad"
    steps = np.diff(problem.waypoints, axis=0, prepend=problem.waypoints[:1])
    found = np.maximum(np.abs(problem.waypoints), np.abs(steps)) * rotary / (2.0 * np.pi)
    if (found > _TURNS).any():
        row, joint = np.unravel_index(int(found.argmax()), found.shape)
        yield (
            f"waypoints: row {row + 1}, {problem.joint_name(int(joint))}: "
            f"{problem.waypoints[row, joint]:.6g} rad takes {found[row, joint]:.3g} turns; are these degrees? "
            'then say unit="deg"'
        )


def _rounded(problem: Problem) -> Iterator[str]:
    """Dense waypoints whose directions jitter because their decimals were cut off."""
    if len(problem.waypoints) < _FEWEST:
        return
    for unit in (problem.display_unit, *(one for one in UNITS if one != problem.display_unit)):
        scales = factors(problem.units, unit)
        for digits in _GRIDS[unit]:
            in_steps = problem.waypoints / scales * 10.0**digits
            if np.abs(in_steps - in_steps.round()).max() <= _EXACT:
                yield from _jitter(problem, unit, digits, in_steps.round())
                return


def _jitter(problem: Problem, unit: str, digits: int, points: Array) -> Iterator[str]:
    """The hint on points that are whole numbers of grid steps, where rounding them costs time."""
    grid = 10.0**-digits
    second = np.abs(np.diff(points, 2, axis=0))
    nearly_straight = (second <= 2.0).all(axis=1)  # each of three points is off by half a step at most
    zones = [problem.conditions.tolerance.get(k) for k in range(1, problem.n_segments)]
    half = 0.5 * grid * factors(problem.units, unit)
    free = np.array([zone is not None and (np.asarray(zone) >= half).all() for zone in zones])
    turned = nearly_straight & second.any(axis=1) & ~free
    if not turned.any():
        return
    as_given, exact = _seconds(problem, points * grid * factors(problem.units, unit), 2.0 * half)
    if as_given < _COSTS * exact:
        return
    own = factors(problem.units, problem.display_unit)
    tolerance = float((half / own).max())
    yield (
        f"waypoints: all {len(points)} are multiples of {grid:g} {unit}, and {int(turned.sum())} of them lie "
        f"beside the line of their neighbours by such a step: if they were rounded, the jitter makes the "
        f"motion take about {as_given / exact:.2g} times as long, or more; [conditions] tolerance = "
        f"{tolerance:.3g} (half a step), or --tolerance {tolerance:.3g}, lets it pass between them"
    )


def _seconds(problem: Problem, points: Array, grid: Array) -> tuple[float, float]:
    """Estimate the time of a motion through points, and the time if they had not been rounded [s].

    Where points are passed every h seconds, second differences are at most A h^2, third ones J h^3. Rounding
    to a grid adds up to 2 and 4 grid steps to them.
    """
    velocity, acceleration, jerk = problem.limits.derivatives
    first, second, third = (np.abs(np.diff(points, order, axis=0)) for order in (1, 2, 3))
    steps = first.mean(axis=0)
    with np.errstate(divide="ignore"):
        rise, swing = (
            (acceleration / steps).min(),
            (jerk / steps).min(),
        )  # of the speed, in points per second
    n = len(points)
    away = np.abs(np.arange(n - 1)[:, None] + 0.5 - np.arange(n))  # of segments from points
    gain = np.minimum(np.sqrt(2.0 * rise * away), np.cbrt(4.5 * swing * away**2))

    def total(at_second: Array, at_third: Array) -> float:
        h = np.zeros(n)
        h[1:-1] = np.sqrt(at_second / acceleration).max(axis=1)
        swings = np.cbrt(at_third / jerk).max(axis=1)
        h[1:-2] = np.maximum(h[1:-2], swings)
        h[2:-1] = np.maximum(h[2:-1], swings)
        with np.errstate(divide="ignore"):
            speeds = 1.0 / h
        speeds[[0, -1]] = 0.0  # rest
        reached = (speeds + gain).min(axis=1)
        return float(np.maximum(1.0 / reached, (first / velocity).max(axis=1)).sum())

    smooth = total(np.maximum(second - 2.0 * grid, 0.0), np.maximum(third - 4.0 * grid, 0.0))
    return total(second, third), smooth
