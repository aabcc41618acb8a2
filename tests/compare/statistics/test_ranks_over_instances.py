"""Ranks over instances: Friedman and Wilcoxon by other means, groups by loops, profiles by counting."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.statistics.instances import performance_profile, ranks, signed_rank

# Demsar 2006, Table 6: C4.5, +m, +cf, +m+cf on 14 data sets, areas under the curve
DEMSAR = np.array([
    [0.763, 0.768, 0.771, 0.798], [0.599, 0.591, 0.590, 0.569], [0.954, 0.971, 0.968, 0.967],
    [0.628, 0.661, 0.654, 0.657], [0.882, 0.888, 0.886, 0.898], [0.936, 0.931, 0.916, 0.931],
    [0.661, 0.668, 0.609, 0.685], [0.583, 0.583, 0.563, 0.625], [0.775, 0.838, 0.866, 0.875],
    [1.000, 1.000, 1.000, 1.000], [0.940, 0.962, 0.965, 0.962], [0.619, 0.666, 0.614, 0.669],
    [0.972, 0.981, 0.9751, 0.975], [0.957, 0.978, 0.946, 0.970],
])  # fmt: skip


def test_demsars_example() -> None:
    found = ranks(-DEMSAR)  # an area is the better the larger it is
    assert found.mean == pytest.approx([3.143, 2.000, 2.893, 1.964], abs=1e-3)
    assert found.difference == pytest.approx(1.25, abs=0.01)  # 2.569 sqrt(4 * 5 / (6 * 14))
    assert found.p < 0.05
    # at 0.05 the test of Nemenyi finds no pair: all lie within one critical difference
    assert found.groups == ((3, 1, 2, 0),)


@given(st.integers(0, 10_000))
@settings(max_examples=25, deadline=None)
def test_the_order_of_instances_and_algorithms_does_not_matter(seed: int) -> None:
    rng = np.random.default_rng(seed)
    table = rng.normal(size=(9, 4)) + np.arange(4)
    rows, columns = rng.permutation(9), rng.permutation(4)
    found, mixed = ranks(table), ranks(table[rows][:, columns])
    assert mixed.mean == pytest.approx(found.mean[columns])
    assert mixed.p == pytest.approx(found.p)
    named = {tuple(sorted(columns[list(group)])) for group in mixed.groups}
    assert named == {tuple(sorted(group)) for group in found.groups}


def test_groups_tie_whoever_lies_within_the_difference() -> None:
    rng = np.random.default_rng(4)
    found = ranks(rng.normal(size=(40, 6)) + 0.4 * np.arange(6))
    tied = {frozenset((a, b)) for group in found.groups for a in group for b in group if a != b}
    for a in range(6):
        for b in range(a):
            near = abs(found.mean[a] - found.mean[b]) < found.difference
            assert (frozenset((a, b)) in tied) == near
            assert near == (found.pairs[a, b] > 0.05)  # another implementation of the same test


def test_friedman_errs_as_often_as_it_says() -> None:
    wrong = sum(ranks(np.random.default_rng(seed).normal(size=(24, 4))).p < 0.05 for seed in range(150))
    assert wrong / 150 <= 0.1


def test_a_table_with_a_hole_names_it_and_misses_tie_as_the_worst() -> None:
    with pytest.raises(ValueError, match="instance 1 and algorithm 2 is missing"):
        ranks([[1, 2, 3], [1, 2, math.nan]])
    assert ranks([[1, math.inf, math.inf]] * 3).mean.tolist() == [1.0, 2.5, 2.5]


def by_signs(differences: list[float]) -> float:
    """Oracle: all signs of the ranks, zeros ranked and then dropped."""
    size = np.abs(differences)
    rank = np.array([(size < s).sum() + ((size == s).sum() + 1) / 2 for s in size])
    rank, sign = rank[size > 0], np.sign(differences)[size > 0]
    seen = float((rank * sign).sum())
    every = [float((rank * signs).sum()) for signs in product((-1, 1), repeat=len(rank))]
    up = sum(one >= seen - 1e-9 for one in every) / len(every)
    down = sum(one <= seen + 1e-9 for one in every) / len(every)
    return min(1.0, 2 * min(up, down))


@given(st.lists(st.integers(-4, 4).map(float), min_size=1, max_size=8).filter(any))
@settings(max_examples=50, deadline=None)
def test_few_differences_are_judged_exactly(differences: list[float]) -> None:
    assert signed_rank(differences) == pytest.approx(by_signs(differences))


def test_the_signed_rank_test_errs_as_often_as_it_says() -> None:
    draws = [np.random.default_rng([seed, 1]).normal(size=36).round(2) for seed in range(800)]
    assert 0.03 <= sum(signed_rank(one) < 0.05 for one in draws) / 800 <= 0.075
    assert signed_rank([0.0, 0.0]) == 1.0
    with pytest.raises(ValueError, match="finite"):
        signed_rank([math.inf])


def test_a_profile_counts_instances_within_a_ratio_of_the_best() -> None:
    costs = [[10.0, 20.0], [30.0, 30.0], [math.inf, 5.0], [math.inf, math.inf]]
    found = performance_profile(costs, points=50)
    for k in range(2):
        for ratio, share in zip(found.ratios, found.share[k], strict=True):
            within = sum(
                row[k] < math.inf and row[k] <= ratio * min(row) * (1 + 1e-12) for row in costs
            )
            assert share == within / 4
    assert found.share[:, -1].tolist() == [0.5, 0.75]
    assert (np.diff(found.share, axis=1) >= 0).all()
    with pytest.raises(ValueError, match="positive"):
        performance_profile([[0.0, 1.0]])
