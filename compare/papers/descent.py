"""Descents: best time found against iterations, quartiles over the runs; data first, then the picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from compare.benchmark.grade import Trace
from compare.benchmark.statistics import best_after

_POINTS = 80  # of a stored curve


def descent(traces: Sequence[Trace], population: int, iterations: int) -> dict[str, Any]:
    """Best value after each iteration (0: the first population), as quartiles over runs; plain JSON.

    None until a quarter, half, three quarters of the runs have found something feasible.
    """
    at = np.unique(np.linspace(0, iterations, min(iterations, _POINTS) + 1).round())
    best = np.array([best_after(trace, population * (at + 1)) for trace in traces])
    quartiles = np.quantile(best, [0.25, 0.5, 0.75], axis=0, method="nearest")
    return {
        "iterations": at.tolist(),
        "quartiles": [[float(v) if np.isfinite(v) else None for v in row] for row in quartiles],
    }


def draw_descent(
    axes: Axes, found: dict[str, Any], label: str, style: tuple[Any, Any], above: float | None = None
) -> None:
    """The median as a line, the quartiles as a band; as gaps to ``above`` if that is given."""
    at = np.array(found["iterations"])
    curves = np.array(found["quartiles"], dtype=float)  # None -> nan
    low, middle, high = curves if above is None else curves / above - 1.0
    colour, line = style
    axes.plot(at, middle, color=colour, ls=line, lw=1.4, label=label)
    axes.fill_between(at, low, high, color=colour, alpha=0.15, lw=0)
