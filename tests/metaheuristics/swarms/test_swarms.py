"""Each swarm of the papers: one step and many against an oracle in loops, schedules, laws.

Oracles draw the same random numbers in the same order; shapes: n points, three coordinates.
"""

from __future__ import annotations

from math import cos, exp, inf, pi, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from loops import (
    HI,
    LO,
    Array,
    LoopSwarm,
    Recorder,
    assert_same_batches,
    bowl,
    clipped,
    recorded,
    value,
)

from compare.benchmark.objective import Objective, search_box
from formulations import load
from metaheuristics import ALGORITHMS, NOT_REPRODUCIBLE, Task, minimise
from metaheuristics.swarms.butterfly import butterfly, fragrance, grown
from metaheuristics.swarms.issa import Blend, issa, weight
from metaheuristics.swarms.mpso import linear_factor, mpso
from metaheuristics.swarms.pso_zhang_2025 import adaptive_factors, pso_zhang_2025, three_others
from metaheuristics.swarms.sparrow import Flock, forage, sparrow, sparrow_printed
from metaheuristics.swarms.tent import tent_population
from metaheuristics.swarms.whale_lu_2024 import inertia, whale_lu_2024

pytestmark = pytest.mark.filterwarnings("error")

D = range(3)


def start(rng: np.random.Generator, n: int) -> list[list[float]]:
    """Draw n uniform points."""
    return (LO + (HI - LO) * rng.random((n, 3))).tolist()  # type: ignore[no-any-return]


def boxed(row: list[float]) -> list[float]:
    """Clip one point."""
    return [clipped(row[d], LO[d], HI[d]) for d in D]


# ------------------------------------------------------------------------------- 001: MPSO, loops


@pytest.mark.parametrize("times", [1, 10])
def test_mpso_moves_as_the_loops_say(times: int) -> None:
    n, steps = 7, 12
    rng = np.random.default_rng(4)
    swarm = LoopSwarm(np.array(start(rng, n)))
    expected = [np.array(swarm.x)]
    for step in range(1, steps):
        k = step / steps
        c = times * (0.05 - 0.03 * k)
        swarm.evaluate()
        swarm.move(rng, 0.4 + 0.5 * (1 - k), c, c)
        expected.append(np.array(swarm.x))
    parameters = ALGORITHMS["mpso" if times == 1 else "mpso-times-ten"].parameters | {"population": n}
    assert_same_batches(recorded(mpso, budget=n * steps, seed=4, **parameters).batches, expected)


# ------------------------------------------------------------------------------ 004: PSO, loops


@pytest.mark.parametrize("printed", [False, True])
def test_the_pso_of_004_moves_as_the_loops_say(printed: bool) -> None:
    n, steps, alpha, beta, F, CR = 9, 14, 0.6, 0.3, 0.5, 0.4
    rng = np.random.default_rng(11)
    swarm = LoopSwarm(np.array(start(rng, n)))
    expected, cut = [np.array(swarm.x)], set()
    for step in range(1, steps):
        swarm.evaluate()
        w = 0.4 + 0.5 * exp(-step / steps) + 0.1 * rng.beta(1, 3)  # (5)
        finite = [f for f in swarm.f if f < inf]
        least, average = min(finite), sum(finite) / len(finite)
        r = rng.random((2, n, 3))
        for i in range(n):
            ratio = (swarm.f[i] - least) / (average - least)
            c1, c2 = alpha * ratio + beta, alpha * (1 - ratio) + beta  # (6)
            cut |= {name for name, c in (("c1", c1), ("c2", c2)) if not 0.02 <= c <= 2}
            c1, c2 = clipped(c1, 0.02, 2), clipped(c2, 0.02, 2)
            for d in D:
                v = w * swarm.v[i][d] + c1 * r[0, i, d] * (swarm.p[i][d] - swarm.x[i][d])
                v += c2 * r[1, i, d] * (swarm.g[d] - swarm.x[i][d])  # (3)
                swarm.v[i][d] = clipped(v, -0.2 * (HI[d] - LO[d]), 0.2 * (HI[d] - LO[d]))
            swarm.x[i] = boxed([swarm.x[i][d] + swarm.v[i][d] for d in D])  # (2)
        others = three_others(rng, n)
        u = rng.random((n, 3))
        x = [row[:] for row in swarm.x]
        for i in range(n):
            r1, r2, r3 = (int(other[i]) for other in others)
            for d in D:
                mutant = x[r1][d] + F * (x[r2][d] - x[r3][d])  # (7)
                kept = x[r1][d] if printed else x[i][d]
                swarm.x[i][d] = clipped(mutant if u[i, d] < CR else kept, LO[d], HI[d])
        expected.append(np.array(swarm.x))

    assert cut == {"c1", "c2"}, "the listed bounds of the factors were never met"
    parameters: dict[str, Any] = {"alpha": alpha, "beta": beta, "F": F, "CR": CR, "printed": printed}
    actual = recorded(pso_zhang_2025, budget=n * steps, seed=11, population=n, **parameters)
    assert_same_batches(actual.batches, expected)
    assert inf in actual.values


@given(n=st.integers(4, 12), seed=st.integers(0, 1000))
@settings(max_examples=40)
def test_three_others_are_three_and_others(n: int, seed: int) -> None:
    r = three_others(np.random.default_rng(seed), n)
    for i, trio in enumerate(zip(*r, strict=True)):
        assert len({i, *trio}) == 4
        assert all(0 <= other < n for other in trio)


def test_three_others_are_drawn_evenly() -> None:
    n = 6
    found = np.array([three_others(np.random.default_rng(s), n) for s in range(4000)])  # (s, 3, n)
    for which in range(3):
        counts = np.bincount(found[:, which, 2], minlength=n)
        assert counts[2] == 0
        assert np.all(np.abs(np.delete(counts, 2) - 800) < 130)  # 5 standard deviations


def test_the_factors_of_004_by_rank() -> None:
    c1, c2 = adaptive_factors(np.array([1.0, 3.0, 2.0, inf]), 0.5, 0.25, 0.02, 2.0)
    np.testing.assert_allclose(c1, [0.25, 1.25, 0.75, 2.0])  # best, 2 x excess, average, infeasible
    np.testing.assert_allclose(c2, [0.75, 0.02, 0.25, 0.02])
    c1, c2 = adaptive_factors(np.array([7.0, 7.0]), 0.5, 0.25, 0.02, 2.0)
    assert (c1.tolist(), c2.tolist()) == ([0.25, 0.25], [0.75, 0.75])
    c1, c2 = adaptive_factors(np.array([inf, inf]), 0.5, 0.25, 0.02, 2.0)
    assert (c1.tolist(), c2.tolist()) == ([2.0, 2.0], [0.02, 0.02])


# ----------------------------------------------------------------------- 002: sparrows, loops


class LoopFlock:
    """Sparrows one by one; ``moved`` collects what is evaluated."""

    def __init__(self, rng: np.random.Generator, n: int, generations: float, printed: bool) -> None:
        self.rng, self.n, self.generations, self.printed = rng, n, generations, printed
        self.x = start(rng, n)
        self.f = [value(row) for row in self.x]
        self.batches = [np.array(self.x)]
        self.branches: set[str] = set()

    def generation(self, t: int, combine: Any = None) -> None:
        """Producers, scroungers, scouts."""
        order = sorted(range(self.n), key=lambda i: self.f[i])
        self.x, self.f = [self.x[i] for i in order], [self.f[i] for i in order]
        producers, scouts = max(1, round(0.2 * self.n)), max(1, round(0.1 * self.n))
        self.batch(range(producers), self.produce(producers, t), combine)
        self.batch(range(producers, self.n), self.scrounge(producers), combine)
        rows = self.rng.permutation(self.n)[:scouts].tolist()
        self.batch(rows, self.scout(rows), combine)

    def batch(self, rows: Any, moves: list[list[float]], combine: Any) -> None:
        """Evaluate moves and keep what is better."""
        moves = [boxed(move) for move in moves]
        if combine is not None:
            moves = combine(list(rows), moves)
        self.batches.append(np.array(moves))
        for i, move in zip(rows, moves, strict=True):
            if value(move) < self.f[i]:
                self.x[i], self.f[i] = move, value(move)

    def produce(self, m: int, t: int) -> list[list[float]]:
        """Eq. 3 (002: 8, 9)."""
        x = self.x
        if self.printed:
            alpha, Q = 1 - self.rng.random(m), self.rng.standard_normal(m)
            M = float(np.median(self.f))
            self.branches |= {"low" if self.f[i] < M else "high" for i in range(m)}
            return [
                [
                    x[i][d] * exp(-t * self.f[i] / (alpha[i] * self.generations))
                    if self.f[i] < M
                    else x[i][d] + Q[i]
                    for d in D
                ]
                for i in range(m)
            ]
        if self.rng.random() < 0.8:
            self.branches.add("safe")
            alpha = 1 - self.rng.random(m)
            return [
                [x[i][d] * exp(-(i + 1) / (alpha[i] * self.generations)) for d in D] for i in range(m)
            ]
        self.branches.add("alarm")
        Q = self.rng.standard_normal(m)
        return [[x[i][d] + Q[i] * 1 for d in D] for i in range(m)]

    def scrounge(self, m: int) -> list[list[float]]:
        """Eq. 4 (002: 10), with the pseudo-inverse computed as one."""
        best = self.x[self.f[:m].index(min(self.f[:m]))]
        worst = self.x[self.f.index(max(self.f))]
        Q = self.rng.standard_normal(self.n - m)
        shape = (self.n - m, 3)
        A = self.rng.random(shape) if self.printed else 2.0 * self.rng.integers(2, size=shape) - 1
        moves = []
        for row, i in enumerate(range(m, self.n)):
            if i + 1 > self.n / 2:
                moves.append([Q[row] * exp((worst[d] - self.x[i][d]) / (i + 1) ** 2) for d in D])
            elif self.printed:
                moves.append([best[d] + abs(self.x[i][d] - best[d]) * A[row, d] for d in D])
            else:
                plus = np.linalg.pinv(A[row][None])  # A+ = A^T (A A^T)^-1, (3, 1)
                step = float((np.abs(np.array(self.x[i]) - best) @ plus)[0])
                moves.append([best[d] + step for d in D])
        return moves

    def scout(self, rows: list[int]) -> list[list[float]]:
        """Eq. 5 (002: 11)."""
        best, worst = self.f.index(min(self.f)), self.f.index(max(self.f))
        beta, K = self.rng.standard_normal((len(rows), 3)), 2 * self.rng.random(len(rows)) - 1
        moves = []
        for row, i in enumerate(rows):
            x = self.x[i]
            if self.f[i] > self.f[best]:
                moves.append([self.x[best][d] + beta[row, d] * abs(x[d] - self.x[best][d]) for d in D])
                continue
            self.branches.add("the best scouts")
            step = K[row] / (self.f[i] - self.f[worst] + 1e-50)
            moves.append([x[d] + step * abs(x[d] - self.x[worst][d]) for d in D])
        return moves


@pytest.mark.parametrize("printed", [False, True])
def test_sparrows_move_as_the_loops_say(printed: bool) -> None:
    n, steps = 20, 12
    generations = steps  # (budget - n) / (n + scouts)
    flock = LoopFlock(np.random.default_rng(21), n, generations, printed)
    for t in range(1, steps + 1):
        flock.generation(t)
    search = sparrow_printed if printed else sparrow
    actual = recorded(search, budget=n + steps * (n + 2), seed=21, population=n)
    assert_same_batches(actual.batches, flock.batches)
    assert flock.branches > ({"low"} if printed else {"safe", "alarm"})
    assert inf in actual.values


def loop_butterflies(
    rng: np.random.Generator, x: Array, rows: list[int], f: list[float], c: float
) -> list[list[float]]:
    """Eq. 2 and 3 of Arora & Singh for some rows of x (n, 3); fitness f is positive or infinite."""
    n, m = len(x), len(rows)
    best = x[f.index(min(f))]
    largest = max((v for v in f if v < inf), default=1.0)
    r, u = rng.random(m), rng.random(m)
    j = rng.integers(n, size=m)
    k = [(j[row] + 1 + step) % n for row, step in enumerate(rng.integers(n - 1, size=m))]
    moves = []
    for row, i in enumerate(rows):
        smell = c * min(f[i], largest) ** 0.1
        towards = (
            [r[row] ** 2 * x[j[row]][d] - x[k[row]][d] for d in D]
            if u[row] >= 0.8
            else [r[row] ** 2 * best[d] - x[i][d] for d in D]
        )
        moves.append(boxed([x[i][d] + towards[d] * smell for d in D]))
    return moves


def test_butterflies_move_as_the_loops_say() -> None:
    n, steps = 8, 15
    rng = np.random.default_rng(2)
    x = np.array(start(rng, n))
    f = [value(row) for row in x]
    expected, c = [x.copy()], 0.01
    for _ in range(steps):
        moved = loop_butterflies(rng, x, list(range(n)), f, c)
        expected.append(np.array(moved))
        for i in range(n):
            if value(moved[i]) <= f[i]:
                x[i], f[i] = moved[i], value(moved[i])
        c += 0.025 / (c * steps)
    actual = recorded(butterfly, budget=n * (steps + 1), seed=2, population=n)
    assert_same_batches(actual.batches, expected)
    assert inf in actual.values


@pytest.mark.parametrize("blended", [False, True])
def test_issa_moves_as_the_loops_say(blended: bool) -> None:
    n, steps, window, threshold = 20, 14, 3, 0.05
    rng = np.random.default_rng(5)
    flock = LoopFlock(rng, n, steps, printed=False)
    w, c, changes, weights = 0.5, 0.01, [0.0] * window, []

    def combine(rows: list[int], moves: list[list[float]]) -> list[list[float]]:
        u = None if blended else rng.random(len(rows))
        others = loop_butterflies(rng, np.array(flock.x), rows, flock.f, c)
        if u is not None:
            return [a if v < w else b for a, b, v in zip(moves, others, u, strict=True)]
        return [
            boxed([w * p + (1 - w) * q for p, q in zip(a, b, strict=True)])
            for a, b in zip(moves, others, strict=True)
        ]

    for t in range(1, steps + 1):
        before = min(flock.f)
        flock.generation(t, combine)
        changes = [*changes[1:], abs(min(flock.f) - before)]  # (12)
        w = min(1.0, sum(changes) / window / (threshold * min(flock.f)))  # (13), (14)
        c += 0.025 / (c * steps)
        weights.append(w)

    assert min(weights) < 0.3 < 0.9 < max(weights)
    parameters: dict[str, Any] = {"window": window, "threshold": threshold, "blended": blended}
    actual = recorded(issa, budget=n + steps * (n + 2), seed=5, population=n, **parameters)
    # later the flock is so close that one rounding decides a comparison
    assert_same_batches(actual.batches[:30], flock.batches[:30])


def test_issa_that_always_moves_like_a_sparrow_is_a_sparrow_search() -> None:
    task, other = one_task(3), one_task(3)
    blend = Blend(task, Flock(task.sample(10)), 0.1, (0.8, 0.01, 0.1), 5, 1e-3)
    blend.weight = 1.0
    moves = task.clip(other.sample(10))
    rows = np.arange(10)
    assert np.array_equal(blend.chosen(rows, moves), moves)
    np.testing.assert_allclose(blend.blended(rows, moves), moves, rtol=1e-15)


# --------------------------------------------------------------------------- 003: whales, loops


@pytest.mark.parametrize("printed", [False, True])
def test_the_whales_of_003_move_as_the_loops_say(printed: bool) -> None:
    n, steps, s, b, lam = 11, 12, 2.0, 0.7, 0.4
    rng = np.random.default_rng(8)
    z = rng.random(3)
    x = np.empty((n, 3))
    for i in range(n):
        z = np.array([v / lam if v < lam else (1 - v) / (1 - lam) for v in z])  # (23)
        x[i] = LO + z * (HI - LO)
    expected, branches = [x], set()
    best, best_f = x[0], inf
    for step in range(1, steps):
        for row in x:
            if value(row) < best_f:
                best, best_f = row, value(row)
        k = step / steps
        w, delta = (1 - k) / (1 + s * k), 2 - 2 * k  # (22)
        r1, r2, choice, r3 = rng.random((4, n))
        other = rng.integers(n, size=n)
        new = []
        for i in range(n):
            A, C, g = 2 * delta * r1[i] - delta, 2 * (r1[i] if printed else r2[i]), 2 * r3[i] - 1
            branch = "spiral" if choice[i] >= 0.5 else "round" if printed or abs(A) < 1 else "search"
            branches.add(branch)
            moved = []
            for d in D:
                if branch == "spiral":
                    turn = exp(b * g) * cos(2 * pi * g)
                    moved.append(abs(best[d] - x[i, d]) * turn + w * best[d])
                elif branch == "round":
                    moved.append(w * best[d] - A * abs(C * best[d] - x[i, d]))
                else:
                    leader = x[other[i], d]
                    moved.append(leader - A * abs(C * leader - x[i, d]))
            new.append(boxed(moved))
        x = np.array(new)
        expected.append(x)
    assert branches == {"spiral", "round"} | (set() if printed else {"search"})
    parameters: dict[str, Any] = {"population": n, "s": s, "b": b, "lam": lam, "printed": printed}
    actual = recorded(whale_lu_2024, budget=n * steps, seed=8, **parameters)
    assert_same_batches(actual.batches, expected)


# --------------------------------------------------------------------- schedules and single parts


def test_schedules_start_and_end_where_the_papers_say() -> None:
    assert [linear_factor(0), linear_factor(1)] == pytest.approx([0.05, 0.02])
    assert [linear_factor(0, 0.5, 0.2), linear_factor(1, 0.5, 0.2)] == pytest.approx([0.5, 0.2])
    for s in (-0.5, 0.0, 1.0, 9.0):
        assert [inertia(0, s), inertia(1, s)] == [1.0, 0.0]
    assert inertia(0.5, 0.0) == 0.5 > inertia(0.5, 1.0)
    c = 0.01
    for _ in range(500):
        c = grown(c, 500)
    assert c == pytest.approx(sqrt(0.01**2 + 2 * 0.025), rel=0.02)  # c dc = 0.025 dk


def test_the_weight_of_issa_is_the_mean_change_over_the_threshold() -> None:
    assert weight([0.0, 0.0, 0.3], 0.2) == pytest.approx(0.5)
    assert weight([0.3, 0.3, 0.3], 0.2) == 1.0
    assert weight([0.0], 0.2) == weight([0.0], 0.0) == 0.0
    assert weight([0.1], 0.0) == weight([inf, 0.0], 0.2) == 1.0


def test_fragrance_of_what_has_no_positive_fitness() -> None:
    np.testing.assert_allclose(fragrance(np.array([2.0, inf, 8.0]), 0.1, 2.0), [0.4, 6.4, 6.4])
    np.testing.assert_allclose(fragrance(np.array([-2.0, 1.0]), 0.1, 2.0), [0.1, 1.6])
    np.testing.assert_allclose(fragrance(np.array([inf, inf]), 0.1, 2.0), [0.1, 0.1])


def test_a_tent_population_is_as_even_as_a_random_one_and_no_more() -> None:
    """000, Fig. 4: 500 numbers in ten bins. One orbit is no evidence; the mean of many is."""

    def unevenness(x: Array) -> float:
        counts = np.histogram(x, bins=10, range=(0, 1))[0]
        return float(((counts - 50.0) ** 2 / 50.0).sum())

    tent = [unevenness(tent_population(one_task(s, dim=1, lo=0, hi=1), 500)) for s in range(300)]
    uniform = [unevenness(np.random.default_rng(s).random(500)) for s in range(300)]
    assert np.mean(uniform) == pytest.approx(9.0, abs=1.3)  # chi-square of 9 degrees
    assert np.mean(tent) < 1.3 * np.mean(uniform)
    assert np.mean(tent) > 0.3 * np.mean(uniform)


# -------------------------------------------------------------------------------------------- laws


def one_task(seed: int, dim: int = 3, lo: float = -2.0, hi: float = 3.0, budget: int = 400) -> Task:
    """Make a task outside any run; nothing of its budget is ever used."""
    rng = np.random.default_rng(seed)
    return Task(np.full(dim, lo), np.full(dim, hi), rng, budget, lambda: 0)


def test_no_sparrow_ever_worsens_by_itself_or_blended() -> None:
    for combined in (False, True):
        task = one_task(7)
        flock = Flock(task.sample(15))
        blend = Blend(task, flock, 0.1, (0.8, 0.01, 0.1), 5, 1e-3)
        moves = forage(task, flock, 0.2, 0.1, 0.8, *([blend.chosen, blend.weigh] if combined else []))
        x = next(moves)
        before = np.full(15, inf)
        for _ in range(120):
            x = moves.send(((x - 1.0) ** 2).sum(1))
            assert np.all(np.sort(flock.fitness) <= before)
            np.testing.assert_array_equal(flock.fitness, ((flock.x - 1.0) ** 2).sum(1))
            before = np.sort(flock.fitness)


def test_no_butterfly_ever_worsens() -> None:
    """Seen from outside: what a butterfly leaves behind at each move is the best it has met."""
    n, kept = 6, [inf] * 6
    f = Recorder(bowl)
    minimise(butterfly, f, LO, HI, budget=n * 40, seed=3, population=n)
    for x in f.batches:
        kept = [min(a, b) for a, b in zip(kept, bowl(x).tolist(), strict=True)]
    again = one_task(0)
    moves = butterfly(Task(LO, HI, np.random.default_rng(3), n * 40, lambda: 0), population=n)
    x, best = next(moves), np.full(n, inf)
    for _ in range(39):
        best = np.minimum(best, bowl(x))
        x = moves.send(bowl(x))
    assert np.minimum(best, bowl(x)).tolist() == pytest.approx(kept)
    assert again.dim == 3


KNOWS_WHERE_ZERO_IS = {
    "sparrow", "sparrow-printed", "butterfly", "issa", "issa-blended",
    "whale", "whale-lu-2024", "whale-lu-2024-printed",
}  # fmt: skip
OWN = [name for name, a in ALGORITHMS.items() if not a.libraries]


def drift(name: str, shift: float) -> float:
    """Return how far a run moves, as a share of the box, when box and f are translated."""
    algorithm = ALGORITHMS[name]
    at_home, away = Recorder(bowl), Recorder(lambda x: bowl(x - shift))
    for f, by in ((at_home, 0.0), (away, shift)):
        minimise(algorithm.function, f, LO + by, HI + by, budget=400, seed=2, **algorithm.parameters)
    return float(np.abs((away.points - shift - at_home.points) / (HI - LO)).max())


@pytest.mark.parametrize("name", OWN)
def test_particle_swarms_do_not_know_where_zero_is_and_the_animals_do(name: str) -> None:
    if name in KNOWS_WHERE_ZERO_IS:
        assert drift(name, 64.0) > 0.1
    else:
        assert drift(name, 64.0) < 1e-7


@pytest.mark.parametrize("name", list(ALGORITHMS))
def test_every_algorithm_reaches_the_optimum_of_sr4c_or_says_why_not(name: str) -> None:
    """Within 20,000 evaluations. What falls short misses in five of 30 seeds or more; three show it."""
    objective = Objective(load("sr4c"), stretch=True)
    algorithm = ALGORITHMS[name]
    lo, hi = search_box(objective.problem)

    def reached(seed: int, budget: int) -> bool:
        result = minimise(
            algorithm.function, objective, lo, hi, budget=budget, seed=seed, **algorithm.parameters
        )
        return result.fitness < 4.700657 * (1 + 1e-3)

    if algorithm.shortfall:
        assert not all(reached(seed, 20_000) for seed in (17, 18, 19))
    else:  # what a smaller budget does, the larger one need not show
        seeds = range(1 if algorithm.libraries else 3)
        assert all(reached(seed, 2_000) or reached(seed, 20_000) for seed in seeds)


def test_what_cannot_be_reproduced_is_named_with_its_reason() -> None:
    assert "no equation" in NOT_REPRODUCIBLE["ipso"].reason
    assert not set(NOT_REPRODUCIBLE) & set(ALGORITHMS)
