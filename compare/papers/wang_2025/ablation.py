"""Paper 000, the ablation of its swarm: Table 3."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from compare.papers.item import Item, Shown, Table
from compare.papers.wang_2025 import cec2017 as ablation

# a run of 101 x 100 evaluations takes a tenth of a second
SHORT = ablation.Protocol(100, 50, 100, 10)


def make_ablation(full: bool) -> dict[str, Any]:
    """Factors with intervals, tests and verdicts."""
    protocol = ablation.FULL if full else SHORT
    ablation.holm([0.5])  # says at once what is missing
    rows = [
        row
        for number in ablation.PRINTED
        for swarm in ("mipso", *ablation.STRATEGIES)
        for row in ablation.repeat(number, swarm, protocol, range(protocol.runs))
    ]
    return {"protocol": asdict(protocol), "summary": ablation.summarise(rows)}


def show_ablation(data: dict[str, Any]) -> Shown:
    """The table, the picture, and what is left of the paper's reading of it."""
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
            shown = "" if e["verdict"] == "no difference" else f" {e['verdict']}"
            factor = f"{e['factor']:.2f} ({low:.2f} to {high:.2f}){shown}"
            row += [f"{e['printed']:.2f}", f"{e['raw']:.2f}", factor]
        rows.append(row)
    caption = (
        "Factor by which the mean best fitness grows without one strategy (eq. 19), 95 % interval; "
        'PSO1: no tent map, PSO2: no dynamic factors and inertia, PSO3: no mutation. "Helps" or "hurts" '
        "where a Mann-Whitney test shows a difference, with Holm's correction over all 24."
    )
    remarks = [_reduced(protocol)] if protocol != ablation.FULL else []
    for swarm, strategy in ablation.STRATEGIES.items():
        o, found = summary["overall"][swarm], entries[swarm].values()
        least = min(e["printed"] for e in found)
        remarks.append(
            f"Without {strategy}: printed factors are all at least {least:.2f}; reproduced, it helps on "
            f"{o['helps']} of {len(found)} functions, hurts on {o['hurts']}, and no difference is shown on "
            f"{o['no difference']}; over all functions: {o['verdict']} (geometric mean over f - f* "
            f"{o['geometric_mean']:.3f}, p = {o['p_holm']:.2g})."
        )
    raw = [abs(e["raw"] - e["printed"]) for functions in entries.values() for e in functions.values()]
    remarks.append(
        f"Raw factors, the printed reading, lie within {max(raw):.2f} of the printed ones, half of them "
        f"within {float(np.median(raw)):.2f}; they carry CEC2017's bias of 100 i, which hides most of "
        "what a strategy does."
    )
    return Shown(
        [
            Table(header, rows, caption, range(1, len(header))),
            ablation.ablation_figure(summary, protocol),
        ],
        remarks,
    )


def _reduced(protocol: ablation.Protocol) -> str:
    paper = ablation.FULL
    return (
        f"Made with {protocol.iterations} iterations and {protocol.runs} runs where the paper has "
        f"{paper.iterations} and {paper.runs}: --full makes those."
    )


ITEMS = (
    Item(
        "Table 3",
        "ablation of MIPSO on CEC2017",
        make_ablation,
        show_ablation,
        "The constants that PSO2 holds in place of the dynamic ones are not printed: the means of their "
        "own schedules are taken. Mutants count as evaluations, so every variant has the same budget. "
        "Eq. 19 divides raw values; the ratio over f - f* stands beside it.",
        cost=60.0,
    ),
)
