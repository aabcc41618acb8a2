"""Optimisers that misbehave, for the driver to survive; and honest ones in each form."""

from __future__ import annotations

import os
import random
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from metaheuristics.driver.task import Array, Moves, Task

F = Callable[[Array], Any]


def honest(task: Task) -> Moves:
    """Uniform points, as a generator."""
    while True:
        yield task.sample(4)


class Asked:
    """Uniform points, by ask and tell; keeps the truth."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.truth: tuple[Array, float] | None = None

    def ask(self) -> Array:
        """Give four points."""
        return self.task.sample(4)

    def tell(self, x: Array, fitness: Array) -> None:
        """Keep the best."""
        i = fitness.argmin()
        if self.truth is None or fitness[i] < self.truth[1]:
            self.truth = x[i], float(fitness[i])

    def best(self) -> Any:
        """Claim it."""
        return self.truth


class Flatterer(Asked):
    """Claims one hundredth less than it found."""

    def best(self) -> Any:
        """Claim too much."""
        assert self.truth is not None
        return self.truth[0], self.truth[1] - 0.01


def called(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Uniform points, by a function that calls f, one by one and in batches; uses what it has."""
    best: tuple[Any, float] = (None, np.inf)
    used = 0
    while used < budget:
        n = min(3, budget - used)
        x = lo + (hi - lo) * rng.random((n, len(lo)))
        fitness = f(x) if used % 2 else np.array([f(row) for row in x])
        used += n
        if fitness.min() < best[1]:
            best = x[fitness.argmin()], float(fitness.min())
    return best


def liar(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Work honestly, then claim zero."""
    return called(f, lo, hi, budget, rng)[0], 0.0


def early_liar(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Evaluate once and claim the moon."""
    f(lo)
    return lo, float("nan")


def nonsense(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Claim what is no number."""
    f(lo)
    return lo, "best"


def glutton(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Evaluate once more than the budget, whatever is raised."""
    for _ in range(budget + 1):
        try:
            f(lo)
        except Exception:
            continue
    return lo, 1e9


def gulper(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Evaluate all and one more in a single batch."""
    f(np.tile(lo, (budget + 1, 1)))


def painter(task: Task) -> Moves:
    """Overwrite the fitness that is sent."""
    while True:
        fitness = yield task.sample(4)
        fitness[:] = -1.0


def painter_called(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Overwrite the fitness that f returned."""
    for _ in range(budget // 2):
        f(np.stack([lo, hi]))[:] = -1.0


def vandal(task: Task) -> Moves:
    """Make the box writable and widen it."""
    task.lo.flags.writeable = True
    task.lo[:] = -1e9
    while True:
        yield np.tile(task.hi, (4, 1))


def gambler(task: Task) -> Moves:
    """Draw from numpy's global state."""
    while True:
        yield task.lo + (task.hi - task.lo) * np.random.random((4, task.dim))


def dicer(task: Task) -> Moves:
    """Draw from Python's global state."""
    while True:
        yield task.lo + (task.hi - task.lo) * random.random() * np.ones((1, task.dim))


def reseeder(task: Task) -> Moves:
    """Seed the global state, for everybody."""
    np.random.seed(0)
    yield from honest(task)


def quitter(task: Task) -> Moves:
    """Leave the program politely."""
    yield task.sample(4)
    sys.exit(7)


def quitter_called(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Leave the program politely, from a function."""
    f(lo)
    sys.exit(7)


def crasher(task: Task) -> Moves:
    """Leave the program at once."""
    yield task.sample(4)
    os._exit(9)


def sleeper(task: Task) -> Moves:
    """Hang after four points."""
    yield task.sample(4)
    while True:
        time.sleep(0.01)


def late_sleeper(task: Task) -> Moves:
    """Hang once the budget is gone."""
    try:
        yield from honest(task)
    finally:
        while True:
            time.sleep(0.01)


def raiser(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Divide by zero after one point."""
    f(lo)
    return 1 / 0


def wanderer(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Leave the box."""
    f(lo)
    f(hi + 1e-9)


def poser(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Evaluate a number too few."""
    f(lo[:-1])


not_callable = 3


def aborter(task: Task) -> Moves:
    """Crash."""
    yield task.sample(4)
    os.abort()


def crowd(f: F, lo: Array, hi: Array, budget: int, rng: np.random.Generator) -> Any:
    """Call f from eight threads at once, and raise if one gets the fitness of another."""

    def one(x: Array) -> bool:
        return bool(f(x) == ((x - [0.3, 2.1, -2.0]) ** 2).sum())

    with ThreadPoolExecutor(8) as pool:
        if not all(pool.map(one, lo + (hi - lo) * rng.random((budget, len(lo))))):
            raise ValueError("the fitness of another thread")
