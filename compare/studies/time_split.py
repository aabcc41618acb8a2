"""Where the time goes between a swarm's motion and the fastest one.

From the verified time of one motion down to the certified bound on every motion there is, each step
with its cause. The steps add up to the whole, as each starts where the one before ended.

    optimiser        the swarm's motion -> the optimum of what its coding can reach
    synchronisation  (published coding) the longest-segment rule -> the optimum of shared durations
    timing           the optimum of the family -> the fastest timing of that same path
    path             the fastest timing of that path -> the fastest motion known
    proof            the fastest motion known -> the certified bound: what is not known

The fastest timing of the path is that of TOPP-RA where there is no jerk limit, else that of COPP
(``copp-py``). Both are discretised, so a share may be off by their stated grid error. Without either,
timing and path are one share, "family".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from compare.benchmark.grade import Run, grade
from compare.benchmark.ladders import RungRecord, ladder_record
from compare.benchmark.summaries import bound_of
from compare.report.style import BLUE, GREEN, GREY, ORANGE, SKY, VERMILION, styled
from compare.screen import table
from formulations import InputError, Problem, ladder

COLOURS = {
    "proof": GREY,
    "path": BLUE,
    "timing": SKY,
    "family": BLUE,
    "synchronisation": ORANGE,
    "optimiser": VERMILION,
}
MEANINGS = {
    "proof": "between the fastest motion known and the certified bound: not known",
    "path": "the spline's path through the waypoints, timed as fast as it can be",
    "timing": "the spline's own timing of its path",
    "family": "the spline: its path and its timing",
    "synchronisation": "the longest time per segment over the joints, each planned alone",
    "optimiser": "what the search did not find",
}


@dataclass(frozen=True)
class Share:
    """One cause of lost time, between two levels of the ladder [s]."""

    name: str
    low: float
    high: float

    @property
    def seconds(self) -> float:
        """What this costs [s]; a discretised reference can make it a little negative."""
        return self.high - self.low


def split(
    problem: Problem, rungs: Mapping[str, RungRecord], seconds: float, coding: str
) -> list[Share]:
    """Split a verified time into its shares above the certified bound, from the bound up.

    Parameters
    ----------
    problem : Problem
        The task.
    rungs : dict
        Its ladder, ``Ladder.to_json()["ladder"]``.
    seconds : float
        The verified time [s].
    coding : str
        The coding of the motion, a key of ``CODINGS``.

    Returns
    -------
    list of Share
        They add up to ``seconds`` minus the bound, ``free_form_lower``.

    Raises
    ------
    InputError
        The ladder lacks the bound, a free-form motion, or the optimum of the family.
    """
    known = {key: rung["seconds"] for key, rung in rungs.items() if rung["seconds"] is not None}
    for key in ("free_form_lower", "free_form", "family"):
        if key not in known:
            raise InputError(f"split: the ladder has no {key} ({rungs[key]['note']})")
    levels = [("", known["free_form_lower"]), ("proof", known["free_form"])]
    timed = path_timing(problem, rungs)
    if timed is None:
        levels.append(("family", known["family"]))
    else:
        levels += [("path", known[timed]), ("timing", known["family"])]
    if coding == "published" and "family_longest_segment" in known:
        levels.append(("synchronisation", known["family_longest_segment"]))
    levels.append(("optimiser", seconds))
    return [Share(name, low, high) for (_, low), (name, high) in pairwise(levels)]


def path_timing(problem: Problem, rungs: Mapping[str, RungRecord]) -> str | None:
    """Find the rung that is the optimum on the family's own path under all limits.

    Parameters
    ----------
    problem : Problem
        The task: TOPP-RA respects all of its limits only if none of them is a jerk limit.
    rungs : dict
        Its ladder, ``Ladder.to_json()["ladder"]``.

    Returns
    -------
    str or None
        The key of the rung; None if there is none.
    """
    key = "copp_family_path" if problem.limits.has_jerk else "toppra_family_path"
    return key if rungs[key]["seconds"] is not None else None


def run_and_split(
    problem: Problem,
    swarm: str,
    codings: Sequence[str],
    *,
    seed: int,
    budget: int,
    population: int,
    progress: Callable[[str], None] | None = None,
) -> tuple[dict[str, list[Share]], dict[str, str]]:
    """Run a swarm in each coding, and split the time of what it found.

    Parameters
    ----------
    problem : Problem
        The task; all of its bounds are computed.
    swarm : str
        An algorithm, by name.
    codings : sequence of str
        Keys of ``CODINGS``.
    seed : int
        Seed of the swarm.
    budget : int
        Evaluations per run.
    population : int
        Vectors per population.
    progress : Callable, optional
        Called with the name of each stage as it begins.

    Returns
    -------
    splits : dict
        Shares by coding.
    reasons : dict
        Why there are none, by coding.
    """
    problem.require_plain("split")
    climbed = ladder_record(ladder(problem, progress=progress))
    bound, proof = bound_of(climbed)
    splits, reasons = {}, {}
    for coding in codings:
        if progress is not None:
            progress(f"{swarm}, {coding} coding")
        run = Run(problem.name, coding, swarm, seed, budget, population)
        row = grade(run, problem, bound, proof).row
        if row.seconds is None:
            reasons[coding] = f"{row.status}: {row.note}"
        else:
            splits[coding] = split(problem, climbed["ladder"], row.seconds, coding)
    return splits, reasons


def as_text(shares: list[Share]) -> str:
    """Lay shares out as a table: the bound first, the whole last.

    Parameters
    ----------
    shares : list of Share
        Those of one motion.

    Returns
    -------
    str
        The table.
    """
    bound, whole = shares[0].low, shares[-1].high
    rows = [["no motion is faster", f"{bound:.6f}", "", "certified"]]
    rows += [
        [f"+ {s.name}", f"{s.seconds:+.6f}", f"{100.0 * s.seconds / bound:+.4g} %", MEANINGS[s.name]]
        for s in shares
    ]
    rows.append(["the motion", f"{whole:.6f}", f"{100.0 * (whole / bound - 1.0):+.4g} %", "verified"])
    return table(["share", "seconds", "of the bound", "what it is"], rows, right=(1, 2))


def as_json(splits: dict[str, list[Share]]) -> dict[str, Any]:
    """Turn shares into plain data.

    Parameters
    ----------
    splits : dict
        Shares by coding.

    Returns
    -------
    dict
        The same, ready for strict JSON.
    """
    return {
        coding: [{**asdict(share), "seconds": share.seconds} for share in shares]
        for coding, shares in splits.items()
    }


@styled
def split_figure(title: str, splits: dict[str, list[Share]]) -> Figure:
    """Draw a waterfall per motion, from the certified bound up to its time.

    Parameters
    ----------
    title : str
        The title.
    splits : dict
        Shares by the name of the motion.

    Returns
    -------
    Figure
        The picture; one line of text if there is no motion.
    """
    if not splits:
        figure = plt.figure(figsize=(8.6, 0.8))
        figure.text(0.01, 0.5, f"{title}: no verified motion to split", va="center")
        return figure
    figure, axes = plt.subplots(figsize=(8.6, 0.7 + 0.75 * len(splits)))
    left = min(shares[0].low for shares in splits.values())
    right = max(shares[-1].high for shares in splits.values())
    shown: set[str] = set()
    for row, shares in enumerate(splits.values()):
        axes.barh(row, shares[0].low, color=GREEN, height=0.55,
                  label=None if row else "no motion is faster (certified)")  # fmt: skip
        for share in shares:
            name = None if share.name in shown else share.name
            shown.add(share.name)
            hatch = "" if share.seconds >= 0.0 else "///"
            axes.barh(row, share.seconds, left=share.low, color=COLOURS[share.name], height=0.55,
                      edgecolor="white", lw=0.6, hatch=hatch, label=name)  # fmt: skip
            if abs(share.seconds) > 0.035 * right:
                axes.text(0.5 * (share.low + share.high), row, f"{share.seconds:.3g}", ha="center",
                          va="center", color="white", fontsize=8)  # fmt: skip
        whole, bound = shares[-1].high, shares[0].low
        text = f"{whole:.4g} s, {100.0 * (whole / bound - 1.0):.3g} % above"
        axes.text(whole + 0.005 * right, row, text, va="center", fontsize=8)
    axes.axvline(left, color=GREEN, lw=1.0, ls=":")
    axes.set_yticks(range(len(splits)), list(splits))
    axes.invert_yaxis()
    axes.set_xlim(0.0, 1.22 * right)
    axes.set_xlabel("time [s]")
    axes.set_title(title, loc="left")
    below = (0.0, -0.28 / (0.4 + 0.25 * len(splits)))
    axes.legend(frameon=False, fontsize=8, ncols=6, loc="upper left", bbox_to_anchor=below)
    return figure
