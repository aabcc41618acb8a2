"""Random problems with the limits of a real arm, feasible by construction."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from compare.benchmark.suite.arms import DECIMALS, arm_sheets
from compare.benchmark.suite.draws import Draws
from formulations import FAMILIES, Problem

_GRID = 10**DECIMALS  # waypoints are whole multiples of 1e-4 rad or m
_MARGIN = 10  # per cent of a joint's range that waypoints keep from each end
_STEPS = (5, 45)  # least and greatest step between waypoints, per cent of the range
_HALF_TURN = round(
    math.pi * _GRID
)  # joints that turn further are used within half a turn of the middle
_FILLED = 0.99  # share of a joint's range that the spline with equal durations fills at most


@dataclass(frozen=True)
class Recipe:
    """What a random problem is to be: its arm, family, number of segments, and kinds of limits."""

    arm: str
    family: str
    segments: int
    jerk: bool
    position: bool


def drawn(name: str, recipe: Recipe) -> Problem:
    """Draw a problem.

    The spline with equal durations stays inside the position limits; slowed down, it keeps the others.
    A spline is linear in its waypoints, so those of a joint that would leave its limits are drawn
    together, towards the middle of its range.

    Parameters
    ----------
    name : str
        Also names the stream of random numbers.
    recipe : Recipe

    Returns
    -------
    Problem
    """
    arm, stream = arm_sheets()[recipe.arm], Draws(name)
    limits = {"velocity": list(arm.velocity), "acceleration": list(arm.acceleration)}
    if recipe.jerk:
        limits["jerk"] = list(arm.jerk)
    if recipe.position:
        limits["position"] = [list(pair) for pair in arm.position]  # type: ignore[misc]
    columns = []
    for low, high in arm.position:
        column = _column(low, high, recipe.segments + 1, stream)
        columns.append(_inside(column, low, high, recipe.family) if recipe.position else column)
    return Problem(
        [[value / _GRID for value in row] for row in zip(*columns, strict=True)],
        limits,
        name=name,
        family=recipe.family,
        title=f"{arm.title} through {recipe.segments + 1} drawn waypoints",
        source=f"Limits ({', '.join(limits)}): {arm.source} Assumed: {arm.assumed} Waypoints: drawn.",
        units=arm.units,
    )


def _column(low: float, high: float, count: int, stream: Draws) -> list[int]:
    """Waypoints of one joint, as whole numbers: a random walk between the margins of its range."""
    least, greatest = round(low * _GRID), round(high * _GRID)
    middle = (least + greatest) // 2
    least, greatest = max(least, middle - _HALF_TURN), min(greatest, middle + _HALF_TURN)
    width = greatest - least
    bottom, top = least + width * _MARGIN // 100, greatest - width * _MARGIN // 100
    walk = [stream.between(bottom, top)]
    while len(walk) < count:
        step = stream.between(width * _STEPS[0] // 100, width * _STEPS[1] // 100)
        there = walk[-1] + (step if stream.between(0, 1) else -step)
        if bottom <= there <= top:
            walk.append(there)
    return walk


def _inside(column: list[int], low: float, high: float, family: str) -> list[int]:
    """Waypoints of one joint whose spline with equal durations keeps its position limits."""
    waypoints = [[value / _GRID] for value in column]
    alone = Problem(waypoints, {"velocity": 1.0, "position": [low, high]}, family=family)
    excess = FAMILIES[family].position_excess(alone, np.ones((2, alone.n_segments)))[0]
    half = (high - low) / 2.0
    # a whole number: the last bits of the spline do not matter
    share = min(1000, math.floor(1000 * _FILLED * half / (half + float(excess))))
    middle = (round(low * _GRID) + round(high * _GRID)) // 2
    return [middle + (value - middle) * share // 1000 for value in column]
