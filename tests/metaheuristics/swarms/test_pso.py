"""PSO and its published settings, against loops over particles and coordinates."""

from __future__ import annotations

from collections.abc import Callable
from math import exp, inf
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from loops import HI, LO, D, LoopSwarm, assert_same_batches, boxed, clipped, recorded, start, value

from metaheuristics import ALGORITHMS
from metaheuristics.driver.task import Moves
from metaheuristics.swarms.mpso import mpso
from metaheuristics.swarms.pso import pso, pso_1995, pso_linear
from metaheuristics.swarms.pso_zhang_2025 import adaptive_factors, pso_zhang_2025, three_others

pytestmark = pytest.mark.filterwarnings("error")


@pytest.mark.parametrize(
    ("search", "factors"),
    [
        (pso, lambda k: (0.7298, 1.49618, 1.49618)),
        (pso_linear, lambda k: (0.9 - 0.5 * k, 2.0, 2.0)),
        (pso_1995, lambda k: (1.0, 2.0, 2.0)),
    ],
)
def test_pso_moves_as_the_loops_say(
    search: Callable[..., Moves], factors: Callable[[float], tuple[float, float, float]]
) -> None:
    n, steps = 9, 12
    rng = np.random.default_rng(4)
    swarm = LoopSwarm(LO + (HI - LO) * rng.random((n, 3)))
    expected = [np.array(swarm.x)]
    for step in range(1, steps):
        swarm.evaluate()
        swarm.move(rng, *factors(step / steps))
        expected.append(np.array(swarm.x))

    actual = recorded(search, budget=n * steps, seed=4, population=n)
    assert_same_batches(actual.batches, expected)
    assert inf in actual.values
    assert np.any((actual.points == LO) | (actual.points == HI)), "no position was ever clipped"


def test_mpso_with_a_population_per_coordinate_moves_as_the_loops_say() -> None:
    n, rounds = 6, 10
    budget = n * (1 + 3 * rounds)
    rng = np.random.default_rng(9)
    x = start(rng, n)
    expected, f = [np.array(x)], [value(row) for row in x]
    best, least, used = x[f.index(min(f))][:], min(f), n
    v, own = [[0.0] * 3 for _ in range(n)], [row[:] for row in x]
    own_f = [f[:] for _ in D]  # of each population
    moved = set()
    for _ in range(rounds):
        for d in D:
            k = used / budget
            c = 10 * (0.05 - 0.03 * k)
            r = rng.random((2, n))
            batch = []
            for i in range(n):
                step = (0.9 - 0.5 * k) * v[i][d]
                step += c * r[0, i] * (own[i][d] - x[i][d]) + c * r[1, i] * (best[d] - x[i][d])
                v[i][d] = clipped(step, -0.2 * (HI[d] - LO[d]), 0.2 * (HI[d] - LO[d]))
                x[i][d] = clipped(x[i][d] + v[i][d], LO[d], HI[d])
                batch.append([x[i][e] if e == d else best[e] for e in D])
            expected.append(np.array(batch))
            f = [value(row) for row in batch]
            for i in range(n):
                if f[i] < own_f[d][i]:
                    own[i][d], own_f[d][i] = x[i][d], f[i]
            if min(f) < least:
                best, least = batch[f.index(min(f))][:], min(f)
                moved.add(d)
            used += n
    assert moved == set(D)
    actual = recorded(mpso, budget=budget, seed=9, population=n, c_start=0.5, c_end=0.2, split=True)
    assert_same_batches(actual.batches, expected)
    assert inf in actual.values


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=25, deadline=None)
def test_the_vector_beside_which_a_population_is_judged_is_the_best_so_far(seed: int) -> None:
    f = recorded(mpso, budget=8 * 31, seed=seed, population=8, split=True)
    least, best = inf, f.points[0]
    for b, batch in enumerate(f.batches):
        values = np.array(f.values[8 * b : 8 * (b + 1)])
        if b:  # all but one coordinate stand as they are in the best
            assert ((batch == best).all(axis=0)).sum() >= 2
        if values.min() < least:
            least, best = values.min(), batch[values.argmin()]


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


@pytest.mark.parametrize("printed", [False, True])
def test_the_pso_of_zhang_2025_moves_as_the_loops_say(printed: bool) -> None:
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


def test_the_factors_of_zhang_2025_by_rank() -> None:
    c1, c2 = adaptive_factors(np.array([1.0, 3.0, 2.0, inf]), 0.5, 0.25, 0.02, 2.0)
    np.testing.assert_allclose(c1, [0.25, 1.25, 0.75, 2.0])  # best, 2 x excess, average, infeasible
    np.testing.assert_allclose(c2, [0.75, 0.02, 0.25, 0.02])
    c1, c2 = adaptive_factors(np.array([7.0, 7.0]), 0.5, 0.25, 0.02, 2.0)
    assert (c1.tolist(), c2.tolist()) == ([0.25, 0.25], [0.75, 0.75])
    c1, c2 = adaptive_factors(np.array([inf, inf]), 0.5, 0.25, 0.02, 2.0)
    assert (c1.tolist(), c2.tolist()) == ([2.0, 2.0], [0.02, 0.02])
