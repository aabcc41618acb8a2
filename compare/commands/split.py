"""``python -m compare.split CASE``: where the time goes between a swarm's motion and the fastest one.

From the verified time of one motion down to the certified bound on every motion there is, each step
with its cause; the steps add up to the whole, as each starts where the one before ended.

    optimiser        the swarm's motion -> the optimum of what its coding can reach
    synchronisation  (published coding) the longest-segment rule -> the optimum of shared durations
    timing           the optimum of the family -> the fastest timing of that same path
    path             the fastest timing of that path -> the fastest motion known
    proof            the fastest motion known -> the certified bound: what is not known

The fastest timing of the path is TOPP-RA's where there is no jerk limit, else COPP's (``copp-py``);
both are discretised, so a share may be off by their stated grid error. Without one, timing and path are
one share, "family".
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from compare.benchmark.grade import Run, grade
from compare.benchmark.ladders import RungRecord, ladder_record
from compare.benchmark.objective import CODINGS
from compare.benchmark.statistics import bound_of
from compare.commands import shared as commands
from compare.report.style import BLUE, GREEN, GREY, ORANGE, SKY, VERMILION, styled
from formulations import InputError, Problem, ladder, load
from metaheuristics import ALGORITHMS

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
    "optimiser": "what the search left on the table",
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


def split(rungs: Mapping[str, RungRecord], seconds: float, coding: str, *, has_jerk: bool) -> list[Share]:
    """Shares of a verified time [s] above the certified bound, from the bound up.

    rungs: ``Ladder.to_json()["ladder"]``. has_jerk: whether the problem limits any jerk.
    The shares add up to ``seconds`` minus ``free_form_lower``. Raises InputError where the ladder lacks
    the bound, a free-form motion or the family's optimum.
    """
    known = {key: rung["seconds"] for key, rung in rungs.items() if rung["seconds"] is not None}
    for key in ("free_form_lower", "free_form", "family"):
        if key not in known:
            raise InputError(f"split: the ladder has no {key} ({rungs[key]['note']})")
    levels = [("", known["free_form_lower"]), ("proof", known["free_form"])]
    timed = path_timing(rungs, has_jerk=has_jerk)
    if timed is None:
        levels.append(("family", known["family"]))
    else:
        levels += [("path", known[timed]), ("timing", known["family"])]
    if coding == "published" and "family_longest_segment" in known:
        levels.append(("synchronisation", known["family_longest_segment"]))
    levels.append(("optimiser", seconds))
    return [Share(name, low, high) for (_, low), (name, high) in pairwise(levels)]


def path_timing(rungs: Mapping[str, RungRecord], *, has_jerk: bool) -> str | None:
    """The rung that is the optimum on the family's own path under all limits, None if there is none."""
    if rungs["copp_family_path"]["seconds"] is not None:
        return "copp_family_path"
    # without a jerk limit TOPP-RA has all limits there are
    timed = not has_jerk and rungs["toppra_family_path"]["seconds"] is not None
    return "toppra_family_path" if timed else None


def as_text(shares: list[Share]) -> str:
    """A line per share, the bound first and the whole last."""
    bound, whole = shares[0].low, shares[-1].high
    rows = [["no motion is faster", f"{bound:.6f}", "", "certified"]]
    rows += [
        [f"+ {s.name}", f"{s.seconds:+.6f}", f"{100.0 * s.seconds / bound:+.4g} %", MEANINGS[s.name]]
        for s in shares
    ]
    rows.append(["the motion", f"{whole:.6f}", f"{100.0 * (whole / bound - 1.0):+.4g} %", "verified"])
    return commands.table(["share", "seconds", "of the bound", "what it is"], rows, right=(1, 2))


@styled
def split_figure(title: str, splits: dict[str, list[Share]]) -> Figure:
    """A waterfall per motion, from the certified bound up to its time."""
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


def main() -> int:
    """Run one swarm on one problem and split its time."""
    parser = commands.parser(
        "split",
        "Where the time goes: what a swarm's motion loses to its search, to the papers' rule, to the\n"
        "spline's timing and path, down to the certified bound on every motion there is.",
        "python -m compare.split sr4c --swarm pso --figure split.svg",
    )
    parser.add_argument("file", metavar="FILE", help="a problem file (TOML) or a shipped case")
    parser.add_argument("--swarm", default="pso", help=f"one of {', '.join(ALGORITHMS)}")
    parser.add_argument("--codings", help=f"some of {','.join(CODINGS)}")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--budget", type=int, default=2550, help="evaluations")
    parser.add_argument("--population", type=int, default=50)
    parser.add_argument("--json", metavar="OUT", help="write the shares as JSON too")
    parser.add_argument("--figure", metavar="OUT", help="draw them (.svg, .png or .pdf)")
    options = parser.parse_args()
    for key in ("budget", "population"):
        commands.positive(f"--{key}", getattr(options, key))
    swarm = commands.swarms("--swarm", options.swarm, [])[0]
    problem = load(options.file)
    splits = split_of(
        problem,
        swarm,
        commands.chosen("--codings", options.codings, CODINGS),
        seed=options.seed,
        budget=options.budget,
        population=options.population,
    )
    for coding, shares in splits.items():
        print(f"{problem.name}, {swarm}, {coding} coding: {CODINGS[coding]}\n{as_text(shares)}\n")
    if options.json:
        data = {
            coding: [{**asdict(share), "seconds": share.seconds} for share in shares]
            for coding, shares in splits.items()
        }
        commands.write_json(
            Path(options.json), {"problem": problem.name, "swarm": swarm, "split": data}
        )
    if options.figure:
        mpl.use("Agg")
        figure = split_figure(f"{problem.name}: where the time of {swarm} goes", splits)
        try:
            figure.savefig(options.figure, bbox_inches="tight")
        except (OSError, ValueError) as error:
            raise InputError(f"--figure: {options.figure}: {error}") from None
        plt.close(figure)
    return commands.DONE


def split_of(
    problem: Problem, swarm: str, codings: list[str], *, seed: int, budget: int, population: int
) -> dict[str, list[Share]]:
    """Climb the ladder, run the swarm in each coding, and split what it found; by coding."""
    climbed = ladder_record(ladder(problem))
    bound, proof = bound_of(climbed)
    splits = {}
    for coding in codings:
        run = Run(problem.name, coding, swarm, seed, budget, population)
        row = grade(run, problem, bound, proof).row
        if row.seconds is None:
            print(f"{coding}: no verified motion ({row.status}: {row.note})", file=sys.stderr)
            continue
        splits[coding] = split(climbed["ladder"], row.seconds, coding, has_jerk=problem.limits.has_jerk)
    if not splits:
        raise InputError(f"--swarm: {swarm} found no verified motion in {', '.join(codings)}")
    return splits


if __name__ == "__main__":
    commands.run(main)
