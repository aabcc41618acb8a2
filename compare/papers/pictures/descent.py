"""Descents: best time found over the iterations, as quartiles over runs; first the data, then the picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from compare.benchmark.grade import Trace
from compare.benchmark.summaries import best_after

_POINTS = 80  # of a stored curve


def descent(traces: Sequence[Trace], population: int, iterations: int) -> dict[str, Any]:
    """Compute quartiles of the best value after each iteration.

    Parameters
    ----------
    traces : sequence of Trace
        One per run.
    population : int
        Evaluations per iteration.
    iterations : int
        After the first population, which is iteration 0.

    Returns
    -------
    dict
        iterations, and quartiles (three rows); None while so many runs have found nothing feasible.
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
    """Draw the median as a line and the quartiles as a band.

    Parameters
    ----------
    axes : Axes
        Where to draw.
    found : dict
        Of ``descent``.
    label : str
        In the legend.
    style : tuple
        Colour and line style.
    above : float, optional [s]
        If given, the curves are drawn as gaps to it.
    """
    at = np.array(found["iterations"])
    curves = np.array(found["quartiles"], dtype=float)  # None -> nan
    low, middle, high = curves if above is None else curves / above - 1.0
    colour, line = style
    axes.plot(at, middle, color=colour, ls=line, lw=1.4, label=label)
    axes.fill_between(at, low, high, color=colour, alpha=0.15, lw=0)
