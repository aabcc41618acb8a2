"""The pictures of a grading: outcome per instance, share of targets reached, critical difference."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from compare.grading.contest import DuelOutcome
from compare.grading.grading import Grading
from compare.grading.standing import costs, printed
from compare.report.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, styled
from compare.statistics.equivalence import NEGLIGIBLE
from compare.statistics.instances import performance_profile
from compare.statistics.needed import needed
from compare.statistics.runtimes import fixed_target_ecdf

_OUTCOMES = {  # colour, marker: neither tells alone
    DuelOutcome.win: (BLUE, "^", "win"),
    DuelOutcome.tie: (GREY, "o", "tie"),
    DuelOutcome.loss: (VERMILION, "v", "loss"),
}
_LINES = [
    (BLUE, "-"), (VERMILION, "--"), (GREEN, "-."), (BLACK, ":"), (ORANGE, "-"), (PURPLE, "--"), (SKY, "-."),
]  # fmt: skip


@styled
def outcome_figure(found: Grading) -> Figure:
    """Draw A12 with its interval for each instance, the best at the top.

    Parameters
    ----------
    found : Grading

    Returns
    -------
    Figure
    """
    duels = sorted(found.contest.duels, key=lambda duel: -duel.pair.a12)
    figure, axes = plt.subplots(figsize=(8.0, 1.4 + 0.19 * len(duels)))
    axes.axvspan(0.5 - NEGLIGIBLE, 0.5 + NEGLIGIBLE, color=GREY, alpha=0.15, lw=0)
    for y, duel in enumerate(duels):
        colour, marker, _ = _OUTCOMES[duel.outcome]
        axes.plot([duel.pair.low, duel.pair.high], [y, y], color=colour, lw=1.2)
        axes.plot(duel.pair.a12, y, marker, color=colour, ms=5, clip_on=False)  # 1 is at the edge
    for colour, marker, word in _OUTCOMES.values():
        axes.plot([], [], marker, color=colour, label=word)
    effect = found.contest.effect
    axes.axvline(effect.mean, color=BLACK, lw=1.0, ls="--", label=f"mean {effect.mean:.2f}")
    axes.set_yticks(range(len(duels)), [duel.instance for duel in duels], fontsize=7)
    axes.set_ylim(len(duels) - 0.5, -0.5)
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel(
        f"A12 [1]: probability that a run of {found.called} beats one of {found.against}; 95 % intervals;"
        " grey: negligible"
    )
    axes.set_title("Where it wins and loses", loc="left")
    axes.legend(fontsize=7.5, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


@styled
def ecdf_figure(found: Grading) -> Figure:
    """Draw the share of all runs and targets that each swarm has reached, against evaluations.

    Parameters
    ----------
    found : Grading

    Returns
    -------
    Figure
    """
    figure, axes = plt.subplots(figsize=(8.0, 3.6))
    for (colour, line), place in zip(_LINES * 9, found.standing.places, strict=False):
        cells = printed(found.even, place.swarm).values()
        _steps(axes, np.concatenate([cell.hits.ravel() for cell in cells]), found.protocol.budget,
               colour, line, place.swarm)  # fmt: skip
    axes.set_xscale("log")
    axes.set_xlim(1, found.protocol.budget)
    axes.set_ylim(0.0, 1.0)
    axes.set_xlabel("evaluations of the objective [1]")
    axes.set_ylabel("share of runs and targets reached [1]")
    axes.grid(alpha=0.25, lw=0.5)
    axes.set_title(
        "How fast each reaches its targets: gaps from 1000 % down to 0.00001 %, or to what is proved",
        loc="left",
    )
    axes.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _steps(axes: Axes, hits: np.ndarray, budget: int, colour: str, line: str, label: str) -> None:
    found = fixed_target_ecdf(hits)
    last = found.share[-1] if len(found.share) else 0.0
    axes.step([1.0, *found.at, budget], [0.0, *found.share, last], line, where="post",
              color=colour, lw=1.5, label=label)  # fmt: skip


@styled
def ranks_figure(found: Grading) -> Figure:
    """Draw the critical-difference diagram: swarms that a bar ties are not told apart by their ranks.

    Parameters
    ----------
    found : Grading

    Returns
    -------
    Figure
    """
    import pandas as pd  # comes with scikit-posthocs

    order = found.standing
    names = list(order.swarms)
    figure, axes = plt.subplots(figsize=(8.0, 0.8 + 0.28 * len(names)))
    mean = pd.Series(order.ranks.mean, index=names)
    pairs = pd.DataFrame(order.ranks.pairs, index=names, columns=names)
    needed("scikit_posthocs").critical_difference_diagram(
        mean, pairs, ax=axes, color_palette=dict.fromkeys(names, BLACK),
        crossbar_props={"color": BLUE, "linewidth": 3.0}, label_props={"fontsize": 9},
    )  # fmt: skip
    axes.set_title(
        f"Mean rank over the instances [1], 1 is best; critical difference {order.ranks.difference:.2f}",
        loc="left",
    )
    return figure


@styled
def profile_figure(found: Grading) -> Figure:
    """Draw performance profiles: the share of instances on which a swarm needs at most r times the least.

    Parameters
    ----------
    found : Grading

    Returns
    -------
    Figure
    """
    swarms = [place.swarm for place in found.standing.places]
    profile = performance_profile(costs(found.even, swarms))
    figure, axes = plt.subplots(figsize=(8.0, 3.2))
    for (colour, line), swarm, share in zip(_LINES * 9, swarms, profile.share, strict=False):
        axes.step(profile.ratios, share, line, where="post", color=colour, lw=1.5, label=swarm)
    axes.set_xscale("log")
    axes.set_ylim(0.0, 1.02)
    axes.set_xlabel("expected evaluations until a gap of 0.1 %, over those of the fastest swarm [1]")
    axes.set_ylabel("share of instances [1]")
    axes.grid(alpha=0.25, lw=0.5)
    axes.set_title("On how many instances each is nearly as fast as the fastest", loc="left")
    axes.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


FIGURES = {
    "outcomes": outcome_figure,
    "targets": ecdf_figure,
    "ranks": ranks_figure,
    "profiles": profile_figure,
}
"""Every picture of the page by its name."""
