"""Numbers and lists written for the papers' pages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from compare.papers.item import ItemVerdict
from compare.papers.verdicts import Reproduction


def listed(values: Sequence[object]) -> str:
    """Write a list in words: 1, 2 and 5.

    Parameters
    ----------
    values : sequence
        None of them gives "none".

    Returns
    -------
    str
    """
    words = [str(value) for value in values]
    if not words:
        return "none"
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def triple(numbers: Sequence[float], digits: int = 3) -> str:
    """Write numbers with commas between them: 1.000, 2.000, 5.000.

    Parameters
    ----------
    numbers : sequence of float
        How many there are does not matter.
    digits : int
        Decimals of each.

    Returns
    -------
    str
    """
    return ", ".join(f"{n:.{digits}f}" for n in numbers)


def percent(share: float, digits: int = 1) -> str:
    """Write a share as a percentage: 12.3 %.

    Parameters
    ----------
    share : float
        1 is the whole.
    digits : int
        Decimals.

    Returns
    -------
    str
    """
    return f"{100.0 * share:.{digits}f}\u00a0%"


def seconds(value: float | None) -> str:
    """Write a time with the papers' four decimals, or none.

    Parameters
    ----------
    value : float or None [s]
        None where there is no time.

    Returns
    -------
    str
    """
    return "none" if value is None else f"{value:.4f}"


def above(value: float | None, least: float) -> str:
    """Write by how much a time is above another one: +0.47 %.

    Parameters
    ----------
    value : float or None [s]
        None where there is no time.
    least : float [s]
        What it is compared with.

    Returns
    -------
    str
    """
    if value is None:
        return "none"
    return f"{round(100.0 * (value / least - 1.0), 2) + 0.0:+.2f} %"  # no -0.00


def result(verdicts: Mapping[str, Sequence[ItemVerdict]]) -> str:
    """Say what is left of a paper, or of several: 12 of 31 printed results are reproduced, ...

    Parameters
    ----------
    verdicts : dict
        By item, what is judged of it.

    Returns
    -------
    str
        Without a full stop at its end.
    """
    found = [one.outcome for several in verdicts.values() for one in several]
    if not found:
        return "No printed result is judged yet"
    count = {outcome: found.count(outcome) for outcome in Reproduction}
    parts = [
        f"{count[Reproduction.IN_KIND]} in kind" if count[Reproduction.IN_KIND] else "",
        f"{count[Reproduction.NOT]} not" if count[Reproduction.NOT] else "",
        f"{count[Reproduction.UNDECIDED]} not decided" if count[Reproduction.UNDECIDED] else "",
    ]
    first = f"{count[Reproduction.REPRODUCED]} of {len(found)} printed results are reproduced"
    return ", ".join([first, *filter(None, parts)])
