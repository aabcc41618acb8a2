"""Where the local solver starts: plain durations, the best shapes of a random sample, random ratios.

The compiled kernels of a family rank thousands of shapes in milliseconds, so the sample also finds
narrow basins that a few random starts would miss.
"""

from __future__ import annotations

import numpy as np

from formulations.families import Family
from formulations.optima.family.program import duration_scales
from formulations.problem.arrays import Array, Indices
from formulations.problem.problem import Problem

_SAMPLE = 8192  # shapes in the random sample
_NICHES, _APART = 4, 0.7  # starts taken from it, and how far apart they are in log T


def starting_durations(problem: Problem, family: Family, random_starts: int, seed: int) -> list[Array]:
    """Choose the starts of the local solver.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits.
    family : Family
        The spline family.
    random_starts : int
        Number of starts with random ratios of the durations.
    seed : int
        Seed of all random numbers.

    Returns
    -------
    list of Array, shape (n_segments,) [s]
        The duration scales, the best shape of the sample, the geometric mean of the scales and the
        longest of them, the random ratios, and the other good shapes.
    """
    scales = duration_scales(problem)
    first = np.maximum(scales, 1e-2 * scales.max())
    rng = np.random.default_rng(seed)
    ratios = rng.uniform(np.log(0.1), np.log(10.0), (random_starts, len(first)))
    plain = [np.sqrt(first * first.max()), *(first * np.exp(row) for row in ratios)]
    sampled = _good_shapes(problem, family, first, rng)
    return [first, *sampled[:1], *plain, *sampled[1:]]


def _good_shapes(
    problem: Problem, family: Family, first: Array, rng: np.random.Generator
) -> list[Array]:
    """The best shapes of a random sample, at most ``_NICHES``, each in a neighbourhood of its own."""
    upper = float(first.sum() * family.stretch(problem, first[None])[0])
    lower = np.maximum(duration_scales(problem), 1e-7 * upper)
    span = np.log(upper / np.minimum(lower, 0.5 * upper))
    shapes = upper * np.exp(-span * rng.random((_SAMPLE, problem.n_segments)))
    # three rounds sample ever closer to the best shapes known so far
    for radius in (1.0, 0.3, 0.1):
        best = shapes[_ranked(problem, family, shapes)[: 2 * _NICHES]]
        if not len(best):
            return []
        near = best[rng.integers(len(best), size=_SAMPLE // 4)]
        steps = np.exp(radius * rng.normal(size=near.shape))
        shapes = np.concatenate([shapes, near * steps])
    niches: list[Array] = []
    for shape in shapes[_ranked(problem, family, shapes)]:
        ratios = np.log(shape / shape.sum())
        if all(np.abs(ratios - np.log(n / n.sum())).max() > _APART for n in niches):
            niches.append(shape)
            if len(niches) == _NICHES:
                break
    return niches


def _ranked(problem: Problem, family: Family, shapes: Array) -> Indices:
    """Indices of the shapes that keep the position limits, fastest first once stretched."""
    seconds = shapes.sum(axis=1) * family.stretch(problem, shapes)
    seconds[family.position_excess(problem, shapes) > 0.0] = np.inf
    order = np.argsort(seconds, kind="stable")
    return np.asarray(order[np.isfinite(seconds[order])])
