"""MIPSO against loops over particles and coordinates, and by its parts."""

from __future__ import annotations

import itertools
from math import cos, exp, inf, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from loops import HI, LO, LoopSwarm, assert_same_batches, loop_probability, recorded, task_on, value

from metaheuristics import ALGORITHMS
from metaheuristics.swarms.mipso import (
    MEAN_DECAY,
    learning_factors,
    mutate,
    mutation_probability,
    printed_inertia,
    resolved_inertia,
)

pytestmark = pytest.mark.filterwarnings("error")


@pytest.mark.parametrize("name", ["mipso", "mipso-pso1", "mipso-pso2", "mipso-pso3", "mipso-printed"])
def test_mipso_moves_as_the_loops_say(name: str) -> None:
    n, budget, pm1, pm2 = 9, 300, 0.4, 0.6
    rng = np.random.default_rng(16)
    if name == "mipso-pso1":
        x = LO + (HI - LO) * rng.random((n, 3))
    else:
        z = rng.random(3)
        x = np.empty((n, 3))
        for i, d in itertools.product(range(n), range(3)):
            z[d] = z[d] / 0.499 if z[d] < 0.499 else (1 - z[d]) / (1 - 0.499)
            x[i, d] = LO[d] + z[d] * (HI[d] - LO[d])

    swarm = LoopSwarm(x)
    expected, used, accepted, refused = [np.array(swarm.x)], n, 0, 0
    swarm.evaluate()
    while used < budget:
        k = used / budget
        w, c1 = 0.9 - 0.5 * exp(1 - 1 / k), 2 * cos(pi * k / 2) ** 2
        c2 = 2 * sin(pi * k / 2) ** 2
        if name == "mipso-printed":
            w = 0.9 - 0.5 * exp(1 - k)
        if name == "mipso-pso2":
            w, c1, c2 = 0.9 - 0.5 * MEAN_DECAY, 1.0, 1.0
        swarm.move(rng, w, c1, c2)
        expected.append(np.array(swarm.x))
        swarm.evaluate()
        used += n
        if used >= budget:
            break
        if name == "mipso-pso3":
            continue
        draws = rng.random(n)
        p = loop_probability(swarm.f, pm1, pm2)
        rows = [i for i in range(n) if draws[i] < p[i]]
        if not rows:
            continue
        genes, r = rng.integers(3, size=len(rows)), rng.random(len(rows))
        mutants = []
        for i, d, u in zip(rows, genes, r, strict=True):
            mutant = swarm.x[i][:]
            end = mutant[d] if name == "mipso-printed" else HI[d]
            mutant[d] = LO[d] + (end - LO[d]) * u
            mutants.append(mutant)
        expected.append(np.array(mutants))
        used += len(rows)
        for i, mutant in zip(rows, mutants, strict=True):
            if swarm.f[i] >= value(mutant):
                swarm.x[i], swarm.f[i] = mutant, value(mutant)
                accepted += 1
            else:
                refused += 1
        swarm.remember()
    expected[-1] = expected[-1][: len(expected[-1]) - (used - budget)]

    parameters = ALGORITHMS[name].parameters | {"population": n, "pm1": pm1, "pm2": pm2}
    actual = recorded(ALGORITHMS[name].function, budget=budget, seed=16, **parameters)
    assert_same_batches(actual.batches, expected)
    assert inf in actual.values
    if name != "mipso-pso3":
        assert accepted > 3
        assert refused > 3


def test_resolved_inertia_falls_all_the_way_and_less_in_the_first_half() -> None:
    w = np.array([resolved_inertia(k) for k in np.linspace(0, 1, 501)])
    assert np.all(np.diff(w) <= 0)
    assert w[0] - w[250] < 0.6 * (w[250] - w[-1])
    assert np.all(np.diff([printed_inertia(k) for k in np.linspace(0, 1, 501)]) > 0)


def test_the_held_factors_are_the_means_of_their_schedules() -> None:
    k = (np.arange(20_000) + 0.5) / 20_000
    mean_w = np.mean([resolved_inertia(float(v)) for v in k])
    assert mean_w == pytest.approx(0.9 - 0.5 * MEAN_DECAY, abs=1e-8)
    assert np.mean([learning_factors(float(v))[0] for v in k]) == pytest.approx(1.0, abs=1e-8)


@given(
    st.lists(
        st.one_of(st.just(inf), st.integers(-1000, 1000).map(lambda v: v / 8)),
        min_size=1,
        max_size=20,
    )
)
def test_mutation_probability_is_eq_17_over_the_feasible(f: list[float]) -> None:
    p = mutation_probability(np.array(f), 0.1, 0.2)
    finite = [v for v in f if v < inf]
    on_average = {sum(finite) / len(finite)} if finite else set()
    for i, q in enumerate(loop_probability(f, 0.1, 0.2)):
        if f[i] not in on_average or f[i] == min(f):  # where rounding may choose the branch
            assert p[i] == pytest.approx(q, rel=1e-9, abs=1e-12)


def test_mutation_probability_where_eq_17_degenerates() -> None:
    assert mutation_probability(np.array([0.1] * 10)).tolist() == [0.0] + [0.2] * 9
    assert mutation_probability(np.array([inf, inf])).tolist() == [0.2, 0.2]
    assert mutation_probability(np.array([inf, 3.0])).tolist() == [0.2, 0.0]
    big = np.finfo(float).max
    p = mutation_probability(np.array([1.0, big, big, 2.0]))
    assert p.tolist() == pytest.approx([0.0, 0.2, 0.2, 0.0])


def test_a_mutant_has_one_new_gene_anywhere_in_the_domain() -> None:
    task = task_on(4, lo=-2.0, hi=6.0)
    x = task.sample(20_000)
    mutants = mutate(task, x)
    changed = mutants != x
    assert np.all(changed.sum(1) == 1)
    assert np.all(np.abs(changed.sum(0) - 5000) < 300)
    counts = np.histogram(mutants[changed], bins=10, range=(-2, 6))[0]
    assert np.all(np.abs(counts - 2000) < 220)


def test_a_mutant_as_printed_only_shrinks_towards_the_lower_bound() -> None:
    task = task_on(4, lo=-2.0, hi=6.0)
    x = task.sample(20_000)
    mutants = mutate(task, x, printed=True)
    changed = mutants != x
    assert np.all(changed.sum(1) == 1)
    assert np.all(mutants <= x)
    share = ((mutants + 2) / (x + 2))[changed]
    assert share.mean() == pytest.approx(0.5, abs=0.01)
