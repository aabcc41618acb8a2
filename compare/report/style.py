"""How every picture looks: one style, and colours that colour-blind people can tell apart."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec

import matplotlib as mpl
from matplotlib.figure import Figure

# Okabe & Ito (2008): eight colours that colour-blind people can tell apart
BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, VERMILION, PURPLE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7",
)  # fmt: skip
GREY = "#888888"

STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "figure.constrained_layout.use": True,
    "svg.hashsalt": "timebound",
    "savefig.dpi": 110,
}
CODING_STYLE: dict[Any, Any] = {
    "published": (VERMILION, "s"),
    "shared": (SKY, "o"),
    "stretched": (BLUE, "D"),
}
"""Colour and marker of each coding."""
_UNUSUAL: dict[str, tuple[str, str]] = {"published (paper)": (ORANGE, "^")}
SMALLEST_GAP = 1e-12
"""Smaller gaps are rounding; on a logarithmic axis they are drawn at this value."""

P = ParamSpec("P")


def variant_style(variant: str) -> tuple[str, str]:
    """Return colour and marker of a variant of a coding.

    Parameters
    ----------
    variant : str
        As `compare.benchmark.protocol.variant` names it.

    Returns
    -------
    tuple of str
    """
    return CODING_STYLE.get(variant) or _UNUSUAL.get(variant, (PURPLE, "v"))


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Make a function draw in the report's style, whoever calls it.

    Parameters
    ----------
    draw : callable
        Any function that returns a figure.

    Returns
    -------
    callable
        The same function; it draws in this style.
    """

    @wraps(draw)
    def draw_styled(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with mpl.rc_context(STYLE):
            return draw(*args, **kwargs)

    return draw_styled
