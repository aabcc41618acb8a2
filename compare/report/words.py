"""Numbers as people read them, the same on every page."""

from __future__ import annotations


def percent(gap: float | None) -> str:
    """Return a gap for people: 8.2 %, 0.013 %, 3e-06 %; a gap that is rounding is 0 %.

    Parameters
    ----------
    gap : float or None

    Returns
    -------
    str
    """
    if gap is None:
        return "none"
    value = 100.0 * gap
    if abs(value) < 1e-8:
        return "0 %"
    if abs(value) < 1e-3:
        return f"{value:.0e} %".replace("e-0", "e-")
    return f"{value:.2g} %" if abs(value) < 10 else f"{value:.0f} %"


def seconds(value: float | None) -> str:
    """Return a time for people, to 0.1 ms; a dash where there is none.

    Parameters
    ----------
    value : float or None [s]

    Returns
    -------
    str
    """
    return "–" if value is None else f"{value:.4f}"
