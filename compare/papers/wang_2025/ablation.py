"""The ablation of MIPSO in Wang 2025, sec. 3.4: runs on CEC2017, the factors of eq. 19, and their tests.

Eq. 19 divides the mean best fitness without a strategy by the mean with all of them. It is computed twice:
over raw values as printed, which carry CEC2017's bias of 100 i, and over f - f*. Mutants count as
evaluations, so that every variant has the same budget.
"""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import stats

from compare.audit.paper import settings
from formulations import InputError
from formulations.problem.arrays import Array
from metaheuristics import ALGORITHMS, minimise

STRATEGIES = {
    "mipso-pso1": "tent map",
    "mipso-pso2": "dynamic factors and inertia",
    "mipso-pso3": "mutation",
}


def _printed() -> dict[int, tuple[float, float, float]]:
    table = settings("wang_2025")["ablation_factors"]
    columns = (table[name] for name in ("PSO1", "PSO2", "PSO3"))
    return dict(zip(table["functions"], zip(*columns, strict=True), strict=True))


PRINTED = _printed()
"""Factors of Table 3 without each of ``STRATEGIES``, by function of CEC2017."""
BOX = 100.0
LEVEL = 0.05  # significance of the whole family of tests


@dataclass(frozen=True)
class Protocol:
    """Particles, dimensions, iterations after the first population, runs."""

    population: int
    dim: int
    iterations: int
    runs: int


def _full() -> Protocol:
    settled = settings("wang_2025")["ablation"]
    return Protocol(*(settled[name] for name in ("population", "dimensions", "iterations", "runs")))


SHORT = Protocol(100, 50, 100, 15)
FULL = _full()
"""The protocol of sec. 3.4."""


@dataclass(frozen=True)
class AblationRun:
    """One run: best fitness, which includes CEC2017's bias."""

    function: int
    swarm: str
    seed: int
    fitness: float
    evaluations: int
    status: str


def cec2017(number: int, dim: int) -> Any:
    """Load a function of CEC2017 (minionpy).

    Parameters
    ----------
    number : int
        Its number in the suite.
    dim : int
        Number of dimensions.

    Returns
    -------
    callable
        A population (n, dim) -> list of n values.

    Raises
    ------
    InputError
        If minionpy is not installed.
    """
    if importlib.util.find_spec("minionpy") is None:
        raise InputError("minionpy is not installed: pip install 'timebound[ablation]'")
    from minionpy.cec import CEC2017Functions

    return CEC2017Functions(number, dim)


def repeat(number: int, swarm: str, protocol: Protocol, seeds: range) -> list[AblationRun]:
    """Run one variant of MIPSO on one function.

    Parameters
    ----------
    number : int
        The function of CEC2017.
    swarm : str
        A name of ``ALGORITHMS``.
    protocol : Protocol
        Its size.
    seeds : range
        One run for each seed.

    Returns
    -------
    list of AblationRun
    """
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
        rows.append(
            AblationRun(number, swarm, seed, result.fitness, result.evaluations, result.status.value)
        )
    return rows


def summarise(rows: list[AblationRun]) -> dict[str, Any]:
    """Compute the factors of eq. 19 with intervals, tests and verdicts.

    Parameters
    ----------
    rows : list of AblationRun
        Runs of MIPSO and of every variant.

    Returns
    -------
    dict
        By variant: strategy, and by function printed, raw, factor, their intervals, p, p_holm and verdict;
        under overall the same over all functions.
    """
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
    """Test the log factors of all functions by signed ranks, and count the single verdicts."""
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
    """Correct p values by Holm's step-down method (statsmodels).

    Parameters
    ----------
    p_values : list of float
        Of one family of tests.

    Returns
    -------
    list of float

    Raises
    ------
    InputError
        If statsmodels is not installed.
    """
    if importlib.util.find_spec("statsmodels") is None:
        raise InputError("statsmodels is not installed: pip install 'timebound[ablation]'")
    from statsmodels.stats.multitest import multipletests

    return [float(p) for p in multipletests(p_values, method="holm")[1]]


def _fitness(rows: list[AblationRun], swarm: str, number: int) -> Array:
    return np.array([row.fitness for row in rows if (row.swarm, row.function) == (swarm, number)])


def _factor(without: Array, with_all: Array) -> tuple[float, float, float]:
    """Factor of eq. 19, a ratio of means, with its 95 % bootstrap interval."""

    def ratio(a: Array, b: Array, axis: int) -> Array:
        return np.asarray(a.mean(axis=axis) / b.mean(axis=axis))

    interval = stats.bootstrap(
        (without, with_all), ratio, n_resamples=2000, method="percentile", rng=np.random.default_rng(0)
    ).confidence_interval
    return float(without.mean() / with_all.mean()), float(interval.low), float(interval.high)
