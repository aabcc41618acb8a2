"""What the tests of swarms share: a box, objectives, a recorder, and swarms written as loops."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from metaheuristics import ALGORITHMS, Result, Status, Task, minimise
from metaheuristics.driver.task import Moves

Array = NDArray[np.float64]
LO, HI = np.array([-1.0, 2.0, -7.0]), np.array([3.0, 2.5, -1.0])
CENTRE = np.array([0.3, 2.1, -2.0])
NAMES = list(ALGORITHMS)
D = range(3)  # coordinates of the box


def bowl(x: Array) -> Array:
    """Squared distance from CENTRE, (n, 3) -> (n,)."""
    squares: Array = (x - CENTRE) ** 2
    return np.asarray(squares.sum(1))


def holed(x: Array) -> Array:
    """Give `bowl` with half of the box infeasible."""
    return np.where(x[:, 0] > 1.0, inf, bowl(x))


class Recorder:
    """An objective that remembers each batch it was given and what it returned."""

    def __init__(self, f: Callable[[Array], Array]) -> None:
        self.f = f
        self.batches: list[Array] = []
        self.values: list[float] = []

    def __call__(self, x: Array) -> Array:
        """Evaluate and remember."""
        self.batches.append(x.copy())
        values = self.f(x)
        self.values += values.tolist()
        return values

    @property
    def points(self) -> Array:
        """All points in order (evaluations, dim)."""
        return np.concatenate(self.batches)


def recorded(search: Callable[..., Moves], *, budget: int, seed: int, **parameters: Any) -> Recorder:
    """Run on `holed` and return what was evaluated."""
    f = Recorder(holed)
    result = minimise(search, f, LO, HI, budget=budget, seed=seed, **parameters)
    assert result.status is Status.ok
    return f


def assert_same_batches(actual: list[Array], expected: list[Array]) -> None:
    """Compare batch by batch, to rounding."""
    assert [len(x) for x in actual] == [len(x) for x in expected]
    for x, y in zip(actual, expected, strict=True):
        np.testing.assert_allclose(x, y, rtol=1e-11, atol=1e-13)


def value(x: Any) -> float:
    """Evaluate `holed` at one point."""
    return float(holed(np.array([x]))[0])


def clipped(v: float, lo: float, hi: float) -> float:
    """Clip one number."""
    return lo if v < lo else hi if v > hi else v


class LoopSwarm:
    """One PSO swarm, particle by particle, coordinate by coordinate."""

    def __init__(self, x: Array) -> None:
        self.x = x.tolist()
        self.n, self.dim = x.shape
        self.v = [[0.0] * self.dim for _ in range(self.n)]
        self.f = [inf] * self.n
        self.p, self.pf = [row[:] for row in self.x], [inf] * self.n
        self.g, self.gf = self.x[0][:], inf

    def evaluate(self) -> None:
        """Evaluate all, then renew the bests."""
        self.f = [value(row) for row in self.x]
        self.remember()

    def remember(self) -> None:
        """Renew own bests and the global best."""
        for i in range(self.n):
            if self.f[i] < self.pf[i]:
                self.p[i], self.pf[i] = self.x[i][:], self.f[i]
        i = self.f.index(min(self.f))
        if self.f[i] < self.gf:
            self.g, self.gf = self.x[i][:], self.f[i]

    def move(self, rng: np.random.Generator, w: float, c1: float, c2: float) -> None:
        """Take one step."""
        r = rng.random((2, self.n, self.dim))
        for i, d in itertools.product(range(self.n), range(self.dim)):
            v = w * self.v[i][d]
            v += c1 * r[0, i, d] * (self.p[i][d] - self.x[i][d])
            v += c2 * r[1, i, d] * (self.g[d] - self.x[i][d])
            width = HI[d] - LO[d]
            self.v[i][d] = clipped(v, -0.2 * width, 0.2 * width)
            self.x[i][d] = clipped(self.x[i][d] + self.v[i][d], LO[d], HI[d])


def loop_probability(f: list[float], pm1: float, pm2: float) -> list[float]:
    """Eq. 17, particle by particle."""
    finite = [v for v in f if v < inf]
    if not finite:
        return [pm2] * len(f)
    f_min, f_avg = min(finite), sum(finite) / len(finite)
    p = []
    for i, v in enumerate(f):
        if i == f.index(f_min):
            p.append(0.0)
        elif v < f_avg:
            p.append(pm1 * (v - f_min) / (f_avg - f_min))
        else:
            p.append(pm2)
    return p


def task_on(dim: int, seed: int = 0, lo: float = 0.0, hi: float = 1.0) -> Task:
    """Make a task outside any run."""
    return Task(np.full(dim, lo), np.full(dim, hi), np.random.default_rng(seed), 2, lambda: 1)


def run_entry(
    name: str,
    f: Callable[[Array], Array] = bowl,
    *,
    budget: int = 700,
    seed: int | np.random.SeedSequence = 1,
    **changed: Any,
) -> Result:
    """Run a registered algorithm on the 3-D box."""
    algorithm = ALGORITHMS[name]
    return minimise(
        algorithm.function, f, LO, HI, budget=budget, seed=seed, **(algorithm.parameters | changed)
    )


def same(a: Result, b: Result) -> bool:
    """Tell whether two results agree to the bit, times apart."""
    return (
        np.array_equal(np.asarray(a.x), np.asarray(b.x))
        and a.fitness == b.fitness
        and a.evaluations == b.evaluations
        and np.array_equal(a.trace_evaluations, b.trace_evaluations)
        and np.array_equal(a.trace_best, b.trace_best)
        and (a.status, a.note) == (b.status, b.note)
    )


def start(rng: np.random.Generator, n: int) -> list[list[float]]:
    """Draw n uniform points."""
    return (LO + (HI - LO) * rng.random((n, 3))).tolist()  # type: ignore[no-any-return]


def boxed(row: list[float]) -> list[float]:
    """Clip one point."""
    return [clipped(row[d], LO[d], HI[d]) for d in D]


def one_task(seed: int, dim: int = 3, lo: float = -2.0, hi: float = 3.0, budget: int = 400) -> Task:
    """Make a task outside any run; nothing of its budget is ever used."""
    rng = np.random.default_rng(seed)
    return Task(np.full(dim, lo), np.full(dim, hi), rng, budget, lambda: 0)


def script(sizes: list[int]) -> Callable[[Task], Moves]:
    """Yield random batches of the given sizes, then return."""

    def algorithm(task: Task) -> Moves:
        for n in sizes:
            yield task.sample(n)

    return algorithm
