"""The verdict in one sentence, with the numbers that it rests on."""

from __future__ import annotations

import math

from compare.grading.contest import Contest, SwarmVerdict
from compare.grading.standing import Ranking

BEST = "cma-es"
FEWEST = 6
"""Instances of which Wilcoxon's test can be significant: 2 / 2^6 is below 5 %."""


def verdict_sentence(
    swarm: str,
    against: str,
    found: Contest,
    order: Ranking,
    *,
    name: str,
    drawn: bool,
    failed: int,
    kind: str,
) -> str:
    """Return the verdict on a swarm as one sentence.

    Parameters
    ----------
    swarm, against : str
        As the user names them.
    found : Contest
    order : Ranking
    name : str
        Name of the swarm in the standing.
    drawn : bool
        Whether the swarm is drawn to zero.
    failed : int
        Number of its runs that failed.
    kind : str
        What the instances are called.

    Returns
    -------
    str
        It ends with a full stop.
    """
    wins, losses, _ = found.counts
    of, (mine, other) = len(found.duels), found.gaps
    verdict = found.verdict
    if verdict is SwarmVerdict.better:
        start = f"{swarm} is better than {against} on {wins} of {of} {kind}, worse on {losses}"
    elif verdict is SwarmVerdict.worse:
        start = f"{swarm} is worse than {against} on {losses} of {of} {kind}, better on {wins}"
    else:
        told = "is equal to" if verdict is SwarmVerdict.equal else "cannot be told from"
        start = f"{swarm} {told} {against}: better on {wins} of {of} {kind}, worse on {losses}"
    parts = [
        start,
        f"median gap {_number(mine)} against {_number(other)} %",
        f"p = {p_text(found.effect.p)}",
        _behind(order, name),
        "drawn to zero" if drawn else "",
        f"{failed} of its runs failed" if failed else "",
    ]
    if verdict is SwarmVerdict.undecided:
        parts.append(seeds_sentence(found))
    return "; ".join(part for part in parts if part) + "."


def seeds_sentence(found: Contest) -> str:
    """Say how many seeds it would take.

    Parameters
    ----------
    found : Contest

    Returns
    -------
    str
        Without a full stop.
    """
    needed, of = found.needed, len(found.duels)
    if not needed.possible:
        return (
            f"{needed.seeds} seeds cannot be significant on any of {of} instances (least p"
            f" {p_text(needed.least_p)} after Holm): {needed.least_seeds} can"
        )
    if of < FEWEST:
        return f"{of} instances cannot be significant together: {FEWEST} can"
    if needed.for_effect is None or needed.for_effect <= needed.seeds:
        return f"{needed.seeds} seeds are enough for the effect seen, but more instances are needed"
    return f"{needed.for_effect} seeds would show the effect seen on an instance (now {needed.seeds})"


def _behind(order: Ranking, name: str) -> str:
    """How far it is from CMA-ES, where both are in the standing and no median is a miss."""
    if name == BEST or BEST not in order.swarms:
        return ""
    mine, best = order.place(name).behind, order.place(BEST).behind
    if mine is None or best is None:
        return ""
    ratio = mine / best
    if ratio >= 1.1:
        return f"still {_factor(ratio)} times behind CMA-ES"
    return f"{_factor(1 / ratio)} times ahead of CMA-ES" if ratio <= 0.9 else "level with CMA-ES"


def _factor(ratio: float) -> str:
    """Two digits, never in powers of ten below a million."""
    if ratio >= 1e6:
        return f"{ratio:.0e}".replace("e+0", "e")
    digits = max(0, 1 - math.floor(math.log10(ratio)))
    return f"{round(ratio, 1 - math.floor(math.log10(ratio))):,.{digits}f}"


def _number(gap: float) -> str:
    """A gap in per cent without its sign, two digits; none for a miss."""
    if not math.isfinite(gap):
        return "none"
    percent = max(0.0, 100.0 * gap)
    return f"{percent:.2g}".replace("e-0", "e-")


def p_text(p: float) -> str:
    """Return a p-value for people: 0.31, 0.004, 3e-5.

    Parameters
    ----------
    p : float

    Returns
    -------
    str
    """
    if p >= 0.095:
        return f"{p:.2f}"
    return f"{p:.1g}".replace("e-0", "e-")
