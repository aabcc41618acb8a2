"""Wang 2025, Table 3: the ablation of its swarm, on the paper's page."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.verdicts import SAME, Reproduction, held
from compare.papers.wang_2025 import ablation
from compare.papers.wang_2025.ablation import StrategyVerdict
from compare.papers.wang_2025.cec2017 import ablation_figure, on_functions
from compare.statistics.equivalence import NEGLIGIBLE
from compare.statistics.seeds import least_effect

# a run of 101 x 100 evaluations takes a tenth of a second
SHORT = ablation.Protocol(100, 50, 100, 10)


def make_ablation(full: bool) -> dict[str, Any]:
    """Run every variant; factors with intervals, tests and verdicts."""
    protocol = ablation.FULL if full else SHORT
    ablation.require_packages()
    rows = [
        row
        for number in ablation.PRINTED
        for swarm in ("mipso", *ablation.STRATEGIES)
        for row in ablation.repeat(number, swarm, protocol, range(protocol.runs))
    ]
    return {"protocol": asdict(protocol), "summary": ablation.summarise(rows)}


def show_ablation(data: dict[str, Any]) -> Shown:
    """Show the table, the picture, and what each strategy does."""
    summary, protocol = data["summary"], ablation.Protocol(**data["protocol"])
    entries = {s: summary[s]["functions"] for s in ablation.STRATEGIES}
    header = ["function"]
    for name in ("PSO1", "PSO2", "PSO3"):
        header += [f"{name}, printed", "raw", "over f - f*"]
    rows = []
    for number in next(iter(entries.values())):
        row = [f"f{number}"]
        for functions in entries.values():
            e = functions[number]
            low, high = e["interval"]
            decided = e["verdict"] != StrategyVerdict.undecided
            factor = f"{e['factor']:.2f} ({low:.2f} to {high:.2f})" + decided * f" {e['verdict']}"
            row += [f"{e['printed']:.2f}", f"{e['raw']:.2f}", factor]
        rows.append(row)
    caption = (
        "Factor by which the mean best fitness grows without one strategy (eq. 19), 95 % interval; "
        'PSO1: no tent map, PSO2: no dynamic factors and inertia, PSO3: no mutation. "Helps" or "hurts" '
        "where a Mann-Whitney test shows a difference, with Holm's correction over all "
        f'{len(rows) * len(entries)}; "no difference" where the interval of A12, the probability that a run '
        f"with the strategy is the better, lies within {0.5 - NEGLIGIBLE:.2f} and {0.5 + NEGLIGIBLE:.2f}; "
        "nothing where the runs are too few for a verdict."
    )
    remarks = [_size(protocol)]
    for swarm, strategy in ablation.STRATEGIES.items():
        o, found = summary["overall"][swarm], entries[swarm].values()
        least, (low, high) = min(e["printed"] for e in found), o["interval"]
        shown = "no verdict" if o["verdict"] == StrategyVerdict.undecided else o["verdict"]
        remarks.append(
            f"Without {strategy}: the printed factors are all at least {least:.2f}. Reproduced: "
            f"{on_functions(summary, swarm)}. Over all functions: {shown} (that it helps is "
            f"{_HELPS[o['verdict']].inside}; A12 {o['effect']:.2f}, "
            f"{low:.2f} to {high:.2f}, p = {o['p_holm']:.2g}; geometric mean of the factors over f - f* "
            f"{o['geometric_mean']:.3f})."
        )
    pairs = [(e["raw"], e["printed"], e["factor"]) for fs in entries.values() for e in fs.values()]
    apart = [abs(raw - printed) for raw, printed, _ in pairs]
    larger = sum(abs(factor - 1.0) > abs(raw - 1.0) for raw, _, factor in pairs)
    factors = _factors(entries, protocol)
    remarks.append(
        f"The printed factors are {factors.inside}: the raw ones, the printed reading, lie within "
        f"{max(apart):.2f} of them, half within {float(np.median(apart)):.2f}. They carry CEC2017's bias of "
        f"100 i: without it, {larger} of {len(pairs)} factors lie farther from 1."
    )
    return Shown(
        [
            Table(header, rows, caption, range(1, len(header))),
            ablation_figure(summary, protocol),
        ],
        remarks,
        [
            *(
                ItemVerdict(f"a gain by {strategy}", _HELPS[summary["overall"][swarm]["verdict"]])
                for swarm, strategy in ablation.STRATEGIES.items()
            ),
            ItemVerdict("the factors of eq. 19, raw as printed", factors),
        ],
    )


_HELPS = {
    StrategyVerdict.helps: Reproduction.REPRODUCED,
    StrategyVerdict.hurts: Reproduction.NOT,
    StrategyVerdict.none: Reproduction.NOT,
    StrategyVerdict.undecided: Reproduction.UNDECIDED,
}


def _factors(entries: dict[str, Any], protocol: ablation.Protocol) -> Reproduction:
    """Judge the printed factors; runs of another size than the paper's do not refute them."""
    every = [e for functions in entries.values() for e in functions.values()]
    near = all(abs(e["raw"] / e["printed"] - 1.0) <= SAME for e in every)
    return held(near) if near or protocol == ablation.FULL else Reproduction.UNDECIDED


def _size(protocol: ablation.Protocol) -> str:
    """What the number of runs can show, and how the size differs from the paper's."""
    paper, tests = ablation.FULL, len(ablation.STRATEGIES) * len(ablation.PRINTED)
    shown = least_effect(paper.runs, tests)
    text = (
        f"{ablation.size_for_any_effect()} runs of each variant would show any effect on a function that is "
        f"not negligible (A12 of {0.5 + NEGLIGIBLE:g}, power 80 %)"
        + ("" if shown is None else f"; the {paper.runs} runs of the paper show an A12 of {shown:.2f}")
        + "."
    )
    if protocol == paper:
        return text
    return (
        f"Made with {protocol.iterations} iterations and {protocol.runs} runs where the paper has "
        f"{paper.iterations} and {paper.runs}: --full makes those. {text}"
    )


TABLE_3 = Item(
    "Table 3",
    "ablation of MIPSO on CEC2017",
    make_ablation,
    show_ablation,
    "The paper does not print the constants that PSO2 holds in place of the dynamic ones: the means of their "
    "own schedules are taken. Mutants count as evaluations, so that every variant has the same budget. "
    "Eq. 19 divides raw values; the ratio over f - f* stands beside it.",
    cost=60.0,
)
