"""The ablation of MIPSO in Wang 2025, sec. 3.4: runs on CEC2017, the factors of eq. 19, and their tests.

Eq. 19 divides the mean best fitness without a strategy by the mean with all of them. It is computed twice:
over raw values as printed, which carry CEC2017's bias of 100 i, and over f - f*. Mutants count as
evaluations, so that every variant has the same budget. Where the runs are too few for a verdict, there is none.
"""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from scipy import stats

from compare.audit.paper import settings
from compare.statistics.equivalence import NEGLIGIBLE, effect_over_instances
from compare.statistics.pairs import compared, holm
from compare.statistics.seeds import seeds_for_effect
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


class StrategyVerdict(StrEnum):
    """What the runs show of a strategy."""

    helps = "helps"
    hurts = "hurts"
    none = "no difference"
    undecided = "undecided"


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


def require_packages() -> None:
    """Make sure that the packages of the ablation are there, before anything is computed.

    Raises
    ------
    InputError
        One is not installed.
    """
    for name in ("minionpy", "statsmodels"):
        if importlib.util.find_spec(name) is None:
            raise InputError(f"{name} is not installed: pip install 'timebound[ablation]'")


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
        If a package is not installed.
    """
    require_packages()
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

    The tests are those of ``compare.statistics``: on a function Mann-Whitney with Holm's correction over all
    of them, over the functions the mean of A12, the probability that a run with all strategies is the better.

    Parameters
    ----------
    rows : list of AblationRun
        Runs of MIPSO and of every variant, of each as many.

    Returns
    -------
    dict
        By variant: strategy, and by function printed, raw, factor, a12, their intervals, p, p_holm, verdict,
        and needed, the runs that would show an effect as large as the one seen (None: no effect is seen);
        under overall the counts of these verdicts, and effect, interval, p_holm and verdict over all functions.
    """
    functions = sorted({row.function for row in rows})
    tests: list[tuple[str, int]] = [(s, i) for s in STRATEGIES for i in functions]
    found: dict[str, Any] = {s: {"strategy": STRATEGIES[s], "functions": {}} for s in STRATEGIES}
    pairs = []
    for swarm, number in tests:
        with_all, without = _fitness(rows, "mipso", number), _fitness(rows, swarm, number)
        pair = compared(with_all, without)
        pairs.append(pair)
        least = 100.0 * number
        factor, low, high = _factor(without - least, with_all - least)
        raw, raw_low, raw_high = _factor(without, with_all)
        found[swarm]["functions"][number] = {
            "printed": PRINTED[number][list(STRATEGIES).index(swarm)],
            "raw": raw, "raw_interval": [raw_low, raw_high],
            "factor": factor, "interval": [low, high],
            "a12": pair.a12, "a12_interval": [pair.low, pair.high], "p": pair.p,
        }  # fmt: skip
    corrected = holm([pair.p for pair in pairs])
    for (swarm, number), pair, p in zip(tests, pairs, corrected, strict=True):
        within = max(0.5 - pair.low, pair.high - 0.5) < NEGLIGIBLE
        entry = found[swarm]["functions"][number]
        entry["p_holm"] = float(p)
        entry["verdict"] = _verdict(pair.a12, float(p), negligible=within)
        entry["needed"] = seeds_for_effect(pair.a12, len(tests))
    runs = len(_fitness(rows, "mipso", functions[0]))
    return found | {"overall": _overall(found, runs)}


def _verdict(a12: float, p: float, *, negligible: bool) -> StrategyVerdict:
    """Say what is shown, by the rule of ``timebound versus``."""
    if negligible:
        return StrategyVerdict.none
    if p >= LEVEL:
        return StrategyVerdict.undecided
    return StrategyVerdict.helps if a12 > 0.5 else StrategyVerdict.hurts


def _overall(found: dict[str, Any], runs: int) -> dict[str, Any]:
    """Judge each strategy over all functions, and count the single verdicts."""
    entries = {s: list(found[s]["functions"].values()) for s in STRATEGIES}
    effects = [effect_over_instances([e["a12"] for e in entries[s]], runs, runs) for s in STRATEGIES]
    overall = {}
    for swarm, effect, p in zip(STRATEGIES, effects, holm([e.p for e in effects]), strict=True):
        verdicts = [e["verdict"] for e in entries[swarm]]
        overall[swarm] = {
            "geometric_mean": float(np.exp(np.mean(np.log([e["factor"] for e in entries[swarm]])))),
            "effect": effect.mean,
            "interval": [effect.low, effect.high],
            "p_holm": float(p),
            "verdict": _verdict(effect.mean, float(p), negligible=effect.negligible),
            **{word.value: verdicts.count(word) for word in StrategyVerdict},
        }
    return overall


def size_for_any_effect() -> int:
    """Runs of each variant that would show any effect on a function that is not negligible."""
    found = seeds_for_effect(0.5 + NEGLIGIBLE, len(STRATEGIES) * len(PRINTED))
    assert found is not None
    return found


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
