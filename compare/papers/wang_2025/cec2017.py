"""Table 3 of Wang 2025 (``timebound ablation``), the ablation of MIPSO on CEC2017, run again.

Protocol of its section 3.4 (--full): 100 particles, 50 dimensions, 500 iterations, 30 runs; eight
functions of CEC2017 by minionpy. The factor of eq. 19 is the mean best fitness without a strategy over
that with all of them: once over raw values as printed, which carry CEC2017's bias of 100 i and so hide
most of it, and once over f - f*. Mutants count as evaluations, so every variant has the same budget.
"""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from scipy import stats

from compare.report.style import BLUE, GREY, VERMILION, styled
from compare.screen import table
from formulations import InputError
from formulations.problem.arrays import Array
from metaheuristics import ALGORITHMS, minimise

STRATEGIES = {
    "mipso-pso1": "tent map",
    "mipso-pso2": "dynamic factors and inertia",
    "mipso-pso3": "mutation",
}
PRINTED = {  # 000, table 3: f -> PSO1, PSO2, PSO3
    3: (1.31, 1.22, 1.07),
    6: (1.01, 1.00, 1.04),
    12: (1.04, 1.04, 1.07),
    16: (1.04, 1.00, 1.02),
    17: (1.17, 1.07, 1.25),
    22: (1.00, 1.00, 1.01),
    24: (1.02, 1.03, 1.00),
    25: (1.03, 1.00, 1.01),
}
BOX = 100.0
LEVEL = 0.05  # of the family of tests


@dataclass(frozen=True)
class Protocol:
    """Particles, dimensions, iterations after the first population, runs."""

    population: int
    dim: int
    iterations: int
    runs: int


SHORT = Protocol(100, 50, 100, 15)
FULL = Protocol(100, 50, 500, 30)


@dataclass(frozen=True)
class Row:
    """One run: best fitness, CEC2017's bias included."""

    function: int
    swarm: str
    seed: int
    fitness: float
    evaluations: int
    status: str


def cec2017(number: int, dim: int) -> Any:
    """Function f_i of CEC2017: (n, dim) -> list of n. Raises InputError without minionpy."""
    if importlib.util.find_spec("minionpy") is None:
        raise InputError("minionpy is not installed: pip install 'timebound[ablation]'")
    from minionpy.cec import CEC2017Functions

    return CEC2017Functions(number, dim)


def repeat(number: int, swarm: str, protocol: Protocol, seeds: range) -> list[Row]:
    """Runs of one variant on one function."""
    f = cec2017(number, protocol.dim)
    entry = ALGORITHMS[swarm]
    parameters = entry.parameters | {"population": protocol.population}
    box = np.full(protocol.dim, BOX)
    budget = protocol.population * (protocol.iterations + 1)
    rows = []
    for seed in seeds:
        # unequal seeds: the variants are compared as independent samples
        sequence = np.random.SeedSequence([seed, number, sorted(ALGORITHMS).index(swarm)])
        result = minimise(entry.function, f, -box, box, budget=budget, seed=sequence, **parameters)
        rows.append(Row(number, swarm, seed, result.fitness, result.evaluations, result.status.value))
    return rows


def summarise(rows: list[Row]) -> dict[str, Any]:
    """Factors with intervals, tests and verdicts: by strategy and function."""
    functions = sorted({row.function for row in rows})
    tests: list[tuple[str, int]] = [(s, i) for s in STRATEGIES for i in functions]
    found: dict[str, Any] = {s: {"strategy": STRATEGIES[s], "functions": {}} for s in STRATEGIES}
    p_values = []
    for swarm, number in tests:
        with_all, without = _fitness(rows, "mipso", number), _fitness(rows, swarm, number)
        p = float(stats.mannwhitneyu(without, with_all, alternative="two-sided").pvalue)
        p_values.append(p)
        least = 100.0 * number
        factor, low, high = _factor(without - least, with_all - least)
        raw, raw_low, raw_high = _factor(without, with_all)
        found[swarm]["functions"][number] = {
            "printed": PRINTED[number][list(STRATEGIES).index(swarm)],
            "raw": raw, "raw_interval": [raw_low, raw_high],
            "factor": factor, "interval": [low, high], "p": p,
        }  # fmt: skip
    for (swarm, number), p in zip(tests, holm(p_values), strict=True):
        entry = found[swarm]["functions"][number]
        entry["p_holm"] = p
        entry["verdict"] = (
            "no difference" if p >= LEVEL else "helps" if entry["factor"] > 1 else "hurts"
        )
    return found | {"overall": _overall(found, functions)}


def _overall(found: dict[str, Any], functions: list[int]) -> dict[str, Any]:
    """By strategy: signed-rank test over the functions' log factors, and what the single tests say."""
    logs = {s: [np.log(found[s]["functions"][i]["factor"]) for i in functions] for s in STRATEGIES}
    p = [float(stats.wilcoxon(values).pvalue) for values in logs.values()]
    overall = {}
    for swarm, p_holm in zip(STRATEGIES, holm(p), strict=True):
        verdicts = [found[swarm]["functions"][i]["verdict"] for i in functions]
        mean = float(np.exp(np.mean(logs[swarm])))
        overall[swarm] = {
            "geometric_mean": mean,
            "p_holm": p_holm,
            "verdict": "not shown" if p_holm >= LEVEL else "helps" if mean > 1 else "hurts",
            **{word: verdicts.count(word) for word in ("helps", "hurts", "no difference")},
        }
    return overall


def holm(p_values: list[float]) -> list[float]:
    """Holm-corrected p values (statsmodels)."""
    if importlib.util.find_spec("statsmodels") is None:
        raise InputError("statsmodels is not installed: pip install 'timebound[ablation]'")
    from statsmodels.stats.multitest import multipletests

    return [float(p) for p in multipletests(p_values, method="holm")[1]]


def _fitness(rows: list[Row], swarm: str, number: int) -> Array:
    return np.array([row.fitness for row in rows if (row.swarm, row.function) == (swarm, number)])


def _factor(without: Array, with_all: Array) -> tuple[float, float, float]:
    """Eq. 19, a ratio of means, with its 95 % bootstrap interval."""

    def ratio(a: Array, b: Array, axis: int) -> Array:
        return np.asarray(a.mean(axis=axis) / b.mean(axis=axis))

    interval = stats.bootstrap(
        (without, with_all), ratio, n_resamples=2000, method="percentile", rng=np.random.default_rng(0)
    ).confidence_interval
    return float(without.mean() / with_all.mean()), float(interval.low), float(interval.high)


@styled
def ablation_figure(summary: dict[str, Any], protocol: Protocol) -> Figure:
    """A panel per strategy, a row per function: the printed factor, ours raw, ours over f - f*."""
    figure, panels = plt.subplots(1, len(STRATEGIES), figsize=(10.5, 3.6), sharey=True)
    for axes, (swarm, strategy) in zip(panels, STRATEGIES.items(), strict=True):
        functions = summary[swarm]["functions"]
        axes.axvline(1.0, color=GREY, lw=0.8)
        for y, entry in enumerate(functions.values()):
            low, high = entry["interval"]
            axes.plot([low, high], [y, y], color=BLUE, lw=1.4)
            hollow = entry["verdict"] == "no difference"
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
    axes.plot([], [], "o", color=BLUE, mfc="white", ls="", label="the same, no difference shown")
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize=8)
    figure.suptitle(
        f"MIPSO's strategies on CEC2017: {protocol.population} particles, {protocol.dim} dimensions,"
        f" {protocol.iterations} iterations, {protocol.runs} runs",
        fontsize=9,
    )
    return figure


def as_text(summary: dict[str, Any]) -> str:
    """Table 3 with intervals and verdicts, and the verdict per strategy."""
    lines = []
    for swarm, strategy in STRATEGIES.items():
        for number, e in summary[swarm]["functions"].items():
            lines.append([
                strategy, f"f{number}", f"{e['printed']:.2f}", f"{e['raw']:.2f}",
                f"{e['factor']:.2f}", f"{e['interval'][0]:.2f} to {e['interval'][1]:.2f}",
                f"{e['p_holm']:.2g}", e["verdict"],
            ])  # fmt: skip
    header = ["without", "f", "printed", "raw", "over f - f*", "95 % interval", "p (Holm)", "verdict"]
    parts = [table(header, lines, right=range(2, 7))]
    for swarm, strategy in STRATEGIES.items():
        o = summary["overall"][swarm]
        parts.append(
            f"{strategy}: helps on {o['helps']}, hurts on {o['hurts']}, no difference on"
            f" {o['no difference']}; over all functions {o['verdict']} (geometric mean"
            f" {o['geometric_mean']:.3f}, p = {o['p_holm']:.2g} after Holm)"
        )
    return "\n".join(parts)
