"""Tune one algorithm: optuna's tree-structured Parzen estimator, on the open instances.

Every algorithm has the same number of trials, and every trial the same runs, so that no swarm is tuned
harder than another. The first trial has the constants as published: tuned ones are no worse on the open
instances.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from compare.benchmark.grade import Run, grade
from compare.benchmark.protocol import DEFAULT_BUDGET, TARGETS, Track
from compare.benchmark.suite.instance import Instance, Split
from compare.benchmark.tuning.constants import Constants
from compare.benchmark.tuning.ranges import Range, ranges_of
from formulations import InputError
from metaheuristics import algorithm

CODING = "stretched"
_DIGITS = 4  # significant ones of a constant


def tune(
    swarm: str, instances: Sequence[tuple[Instance, float]], trials: int, evaluations: int, seed: int
) -> tuple[str, Constants, float, float]:
    """Tune the constants of an algorithm.

    Parameters
    ----------
    swarm : str
    instances : sequence of (Instance, float)
        Open instances, each with the time of its optimum [s].
    trials : int
        Sets of constants that are tried, the published one among them.
    evaluations : int
        Budget of each run.
    seed : int
        Of the tuner, and of the runs.

    Returns
    -------
    swarm : str
    constants : dict
        The best set; empty if the algorithm has no constants to tune.
    published, tuned : float
        Mean logarithm to base 10 of the gap, before and after.

    Raises
    ------
    InputError
        If an instance is not open, or optuna is not installed.
    """
    closed = [one.name for one, _ in instances if one.split is not Split.open]
    if closed:
        raise InputError(
            f"tuning: {', '.join(closed)}: not open; nothing is tuned on held-out instances"
        )
    ranges = ranges_of(algorithm(swarm).parameters)
    published = {name: algorithm(swarm).parameters[name] for name in ranges}
    before = score(swarm, published, instances, evaluations, seed)
    if not ranges:
        return swarm, {}, before, before
    study = _study(seed)
    study.enqueue_trial(published)
    best, least = published, math.inf
    for _ in range(trials):
        trial = study.ask()
        constants = {name: _suggested(trial, name, allowed) for name, allowed in ranges.items()}
        if trial.number == 0:
            constants = published  # not rounded
        found = before if trial.number == 0 else score(swarm, constants, instances, evaluations, seed)
        study.tell(trial, found)
        if found < least:
            best, least = constants, found
    return swarm, best, before, least


def score(
    swarm: str,
    constants: Constants,
    instances: Sequence[tuple[Instance, float]],
    evaluations: int,
    seed: int,
) -> float:
    """Run an algorithm with given constants, once on each instance.

    Parameters
    ----------
    swarm : str
    constants : dict
    instances : sequence of (Instance, float)
        With the time of the optimum [s].
    evaluations : int
        Budget of each run.
    seed : int

    Returns
    -------
    float
        Mean logarithm to base 10 of the gap, between the least and the greatest target; a run without a
        verified motion has the greatest.
    """
    total = 0.0
    for one, optimum in instances:
        run = Run(
            one.name,
            CODING,
            swarm,
            seed,
            evaluations,
            DEFAULT_BUDGET.population,
            track=Track.tuned,
            constants=tuple(constants.items()),
        )
        gap = grade(run, one.problem, optimum).row.gap
        total += math.log10(TARGETS[0] if gap is None else min(max(gap, TARGETS[-1]), TARGETS[0]))
    return total / len(instances)


def optuna_library() -> Any:
    """Return optuna.

    Returns
    -------
    module

    Raises
    ------
    InputError
        It is not installed.
    """
    try:
        import optuna
    except ImportError:
        raise InputError("tuning needs optuna: pip install 'timebound[grade]'") from None
    return optuna


def _study(seed: int) -> Any:
    optuna = optuna_library()
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    return optuna.create_study(sampler=optuna.samplers.TPESampler(seed=seed))


def _suggested(trial: Any, name: str, allowed: Range) -> float | int:
    if allowed.whole:
        return int(trial.suggest_int(name, int(allowed.low), int(allowed.high), log=True))
    value = trial.suggest_float(name, allowed.low, allowed.high, log=allowed.logarithmic)
    return float(f"{value:.{_DIGITS}g}")
