"""Where the local solver starts: plain durations, the best shapes of a random sample, random ratios.

The compiled kernels of a family rank thousands of shapes in milliseconds, so the sample also finds
narrow basins that a few random starts would miss.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

import numpy as np

from formulations.families import Family
from formulations.optima.family.program import duration_scales
from formulations.problem.arrays import Array
from formulations.problem.problem import Problem

_SAMPLE = 8192  # shapes in the random sample
_NICHES, _APART = 4, 0.7  # starts taken from it, and how far apart they are in log T


def starting_durations(problem: Problem, family: Family, seed: int) -> Iterator[Array]:
    """Yield starts of the local solver, the most promising first, without end.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    family : Family
        The spline family.
    seed : int
        Seed of all random numbers.

    Yields
    ------
    Array, shape (n_segments,) [s]
        The best shape of the sample, the duration scales, the geometric mean of the scales and the
        longest of them, the other good shapes, then random ratios.
    """
    scales = duration_scales(problem)
    first = np.maximum(scales, 1e-2 * scales.max())
    rng = np.random.default_rng(seed)
    sampled = _good_shapes(problem, family, first, rng)
    yield from islice(sampled, 1)
    yield first
    yield np.sqrt(first * first.max())
    yield from sampled
    while True:
        yield first * np.exp(rng.uniform(np.log(0.1), np.log(10.0), len(first)))


def _good_shapes(
    problem: Problem, family: Family, first: Array, rng: np.random.Generator
) -> Iterator[Array]:
    """Yield the best shapes of a random sample, at most ``_NICHES``, each in a neighbourhood of its own."""
    upper = float(first.sum() * family.stretch(problem, first[None])[0])
    lower = np.maximum(duration_scales(problem), 1e-7 * upper)
    span = np.log(upper / np.minimum(lower, 0.5 * upper))
    shapes = upper * np.exp(-span * rng.random((_SAMPLE, problem.n_segments)))
    seconds = _seconds(problem, family, shapes)
    # three rounds sample ever closer to the best shapes known so far
    for radius in (1.0, 0.3, 0.1):
        best = shapes[np.argsort(seconds, kind="stable")[: 2 * _NICHES]]
        best = best[: np.isfinite(seconds).sum()]
        if not len(best):
            return
        near = best[rng.integers(len(best), size=_SAMPLE // 4)]
        near = near * np.exp(radius * rng.normal(size=near.shape))
        shapes = np.concatenate([shapes, near])
        seconds = np.concatenate([seconds, _seconds(problem, family, near)])
    order = np.argsort(seconds, kind="stable")[: np.isfinite(seconds).sum()]
    shapes = shapes[order]
    ratios = np.log(shapes / shapes.sum(axis=1, keepdims=True))
    for _ in range(_NICHES):
        if not len(shapes):
            return
        yield shapes[0]
        apart = np.abs(ratios - ratios[0]).max(axis=1) > _APART
        shapes, ratios = shapes[apart], ratios[apart]


def _seconds(problem: Problem, family: Family, shapes: Array) -> Array:
    """Total times of stretched shapes [s]; infinite for those that leave the position limits."""
    seconds = shapes.sum(axis=1) * family.stretch(problem, shapes)
    kept = family.position_excess(problem, shapes) <= 0.0
    return np.where(kept & np.isfinite(seconds), seconds, np.inf)
