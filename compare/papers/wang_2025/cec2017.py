"""Wang 2025, Table 3 (``timebound ablation``), the ablation of MIPSO on CEC2017, run again.

``--full`` runs the protocol of its sec. 3.4. The runs, factors and tests stand in ``ablation``; the page of
the paper shows them as Table 3 (``table_3``).
"""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from compare.papers.wang_2025.ablation import (
    STRATEGIES,
    Protocol,
    StrategyVerdict,
)
from compare.report.style import BLUE, GREY, VERMILION, styled
from compare.screen import table


@styled
def ablation_figure(summary: dict[str, Any], protocol: Protocol) -> Figure:
    """Draw a panel per strategy and a row per function: printed, raw and over f - f*.

    Parameters
    ----------
    summary : dict
        Of ``ablation.summarise``.
    protocol : Protocol
        For the title.

    Returns
    -------
    Figure
    """
    figure, panels = plt.subplots(1, len(STRATEGIES), figsize=(10.5, 3.6), sharey=True)
    for axes, (swarm, strategy) in zip(panels, STRATEGIES.items(), strict=True):
        functions = summary[swarm]["functions"]
        axes.axvline(1.0, color=GREY, lw=0.8)
        for y, entry in enumerate(functions.values()):
            low, high = entry["interval"]
            axes.plot([low, high], [y, y], color=BLUE, lw=1.4)
            hollow = entry["verdict"] not in (StrategyVerdict.helps, StrategyVerdict.hurts)
            axes.plot(entry["factor"], y, "o", color=BLUE, mfc="white" if hollow else BLUE, ms=5)
            axes.plot(entry["raw"], y - 0.22, "^", color=BLUE, ms=4, alpha=0.6)
            axes.plot(entry["printed"], y + 0.22, "X", color=VERMILION, ms=5)
        axes.set_xscale("log")
        low, high = axes.get_xlim()
        ticks = [t for t in (0.5, 0.7, 0.85, 1, 1.2, 1.5, 2, 3, 5, 10, 30, 100) if low < t < high]
        if high > 10:
            ticks = [t for t in ticks if t in (1, 3, 10, 30, 100)]
        axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
        axes.minorticks_off()
        axes.set_yticks(range(len(functions)), [f"f{i}" for i in functions])
        axes.set_ylim(len(functions) - 0.4, -0.6)
        axes.set_title(f"without {strategy}", loc="left", fontsize=9)
        axes.set_xlabel("ablation factor [1]; above 1: it helped")
    axes = panels[0]
    axes.plot([], [], "X", color=VERMILION, ls="", label="printed in table 3")
    axes.plot([], [], "^", color=BLUE, alpha=0.6, ls="", label="ours, raw values as printed")
    axes.plot([], [], "o", color=BLUE, ls="", label="ours, over f - f*, 95 % interval")
    axes.plot([], [], "o", color=BLUE, mfc="white", ls="", label="the same, undecided or no difference")
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=8)
    figure.suptitle(
        f"MIPSO's strategies on CEC2017: {protocol.population} particles, {protocol.dim} dimensions,"
        f" {protocol.iterations} iterations, {protocol.runs} runs",
        fontsize=9,
    )
    return figure


def on_functions(summary: dict[str, Any], swarm: str) -> str:
    """Say on how many functions a strategy helps or hurts, and what the runs leave undecided.

    Parameters
    ----------
    summary : dict
        Of ``ablation.summarise``.
    swarm : str
        The variant without it.

    Returns
    -------
    str
        Counts of what is decided; where nothing is, only that, and how many runs would show the effects seen.
    """
    o, entries = summary["overall"][swarm], summary[swarm]["functions"].values()
    told = [
        f"{word} on {o[word]}"
        for word in StrategyVerdict
        if word is not StrategyVerdict.undecided and o["undecided"] < len(entries)
    ]
    if not o["undecided"]:
        return ", ".join(told)
    left = "each of the" if not told else f"{o['undecided']} of"
    sizes = [e["needed"] for e in entries if e["verdict"] == StrategyVerdict.undecided and e["needed"]]
    seen = f" (the effects seen take {min(sizes)} to {max(sizes)} runs)" if sizes else ""
    return ", ".join([*told, f"too few runs for a verdict on {left} {len(entries)} functions{seen}"])


def as_text(summary: dict[str, Any]) -> str:
    """Write factors, intervals, tests and verdicts for the terminal.

    Parameters
    ----------
    summary : dict
        Of ``ablation.summarise``.

    Returns
    -------
    str
    """
    lines = []
    for swarm, strategy in STRATEGIES.items():
        for number, e in summary[swarm]["functions"].items():
            lines.append([
                strategy, f"f{number}", f"{e['printed']:.2f}", f"{e['raw']:.2f}",
                f"{e['factor']:.2f}", f"{e['interval'][0]:.2f} to {e['interval'][1]:.2f}",
                f"{e['a12']:.2f}", f"{e['p_holm']:.2g}", e["verdict"],
            ])  # fmt: skip
    header = [
        "without",
        "f",
        "printed",
        "raw",
        "over f - f*",
        "95 % interval",
        "A12",
        "p (Holm)",
        "verdict",
    ]
    parts = [table(header, lines, right=range(2, 8))]
    for swarm, strategy in STRATEGIES.items():
        o = summary["overall"][swarm]
        low, high = o["interval"]
        parts.append(
            f"{strategy}: {on_functions(summary, swarm)}; over all functions {o['verdict']} (A12"
            f" {o['effect']:.2f}, {low:.2f} to {high:.2f}, p = {o['p_holm']:.2g} after Holm; geometric mean"
            f" {o['geometric_mean']:.3f})"
        )
    return "\n".join(parts)
