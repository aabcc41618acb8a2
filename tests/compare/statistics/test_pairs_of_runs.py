"""Two sets of runs: A12 by counting, the exact test by enumeration, Holm by hand, errors by simulation."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from statsmodels.stats.nonparametric import rank_compare_2indep

from compare.statistics.pairs import compared, holm, superiority

losses = st.lists(
    st.one_of(st.integers(-5, 5).map(float), st.floats(-5, 5), st.just(math.inf)),
    min_size=1,
    max_size=6,
)


def beats(x: list[float], y: list[float]) -> float:
    """Oracle: the share of pairs that the first wins, ties counted half."""
    won = sum(1.0 if a < b else 0.5 if a == b else 0.0 for a in x for b in y)
    return won / (len(x) * len(y))


def by_enumeration(x: list[float], y: list[float]) -> float:
    """Oracle: share of arrangements whose A12 is at least as far from 1/2 on its side, doubled."""
    both = x + y
    seen = beats(x, y)
    every = [
        beats([both[i] for i in chosen], [both[i] for i in range(len(both)) if i not in chosen])
        for chosen in combinations(range(len(both)), len(x))
    ]
    up = sum(one >= seen - 1e-12 for one in every) / len(every)
    down = sum(one <= seen + 1e-12 for one in every) / len(every)
    return min(1.0, 2 * min(up, down))


@given(losses, losses)
@settings(max_examples=60, deadline=None)
def test_a12_counts_pairs_and_its_interval_holds_it(x: list[float], y: list[float]) -> None:
    found = compared(x, y)
    assert found.a12 == superiority(x, y) == pytest.approx(beats(x, y))
    assert 0.0 <= found.low <= found.a12 + 1e-9
    assert found.a12 - 1e-9 <= found.high <= 1.0


@given(losses, losses, st.randoms(use_true_random=False))
@settings(max_examples=40, deadline=None)
def test_neither_order_nor_scale_of_the_losses_matters(
    x: list[float], y: list[float], rnd: object
) -> None:
    found = compared(x, y)
    mixed = list(x)
    rnd.shuffle(mixed)  # type: ignore[attr-defined]
    assert compared(mixed, y) == found
    cubed = compared([a**3 for a in x], [b**3 for b in y])
    if len({*x, *y}) == len({a**3 for a in (*x, *y)}):  # no two became equal by rounding
        assert cubed == found
    back = compared(y, x)
    assert back.p == pytest.approx(found.p)
    assert back.a12 == pytest.approx(1.0 - found.a12)
    assert (back.low, back.high) == pytest.approx((1.0 - found.high, 1.0 - found.low), abs=1e-6)


@given(
    st.lists(st.integers(0, 3).map(float), min_size=2, max_size=4),
    st.lists(st.integers(0, 3).map(float), min_size=2, max_size=4),
)
@settings(max_examples=40, deadline=None)
def test_small_sets_are_judged_exactly_with_ties_too(x: list[float], y: list[float]) -> None:
    found = compared(x, y)
    assert found.method == "exact"
    assert found.p == pytest.approx(by_enumeration(x, y))


def test_a_miss_is_worse_than_any_success_and_as_bad_as_another_miss() -> None:
    assert superiority([1e300], [math.inf]) == 1.0
    assert superiority([math.inf, math.inf], [math.inf]) == 0.5
    assert compared([math.inf] * 20, [math.inf] * 20).p == 1.0
    with pytest.raises(ValueError, match="NaN"):
        superiority([math.nan], [1.0])
    with pytest.raises(ValueError, match="n > 0"):
        superiority([], [1.0])


def test_the_interval_is_near_that_of_another_method() -> None:
    rng = np.random.default_rng(1)
    x, y = rng.normal(size=60), rng.normal(size=60) + 0.5
    other = rank_compare_2indep(y, x)
    found = compared(x, y)
    assert found.a12 == pytest.approx(other.prob1)
    assert (found.low, found.high) == pytest.approx(other.conf_int(), abs=0.015)


def test_the_interval_of_two_separated_sets_is_no_point() -> None:
    found = compared(range(5), range(10, 15))
    assert found.a12 == found.high == 1.0
    assert 0.5 < found.low < 0.9
    assert compared(range(10), range(20, 30)).low > found.low


def test_the_interval_covers_the_truth() -> None:
    """Normal losses half a deviation apart: A12 is Phi(0.5 / sqrt 2)."""
    truth = 0.5 * (1 + math.erf(0.5 / math.sqrt(2) / math.sqrt(2)))
    covered = 0
    for seed in range(300):
        rng = np.random.default_rng([seed, 2])
        found = compared(rng.normal(size=25), rng.normal(size=25) + 0.5)
        covered += found.low <= truth <= found.high
    assert 0.92 <= covered / 300 <= 0.985


@pytest.mark.parametrize("digits", [1, 6])  # with many ties, and with none
def test_the_test_errs_as_often_as_it_says(digits: int) -> None:
    wrong = 0
    for seed in range(600):
        rng = np.random.default_rng([seed, digits])
        wrong += compared(rng.normal(size=15).round(digits), rng.normal(size=15).round(digits)).p < 0.05
    assert 0.025 <= wrong / 600 <= 0.07


def test_a_larger_effect_and_more_seeds_are_found_more_often() -> None:
    def power(shift: float, n: int) -> float:
        found = 0
        for seed in range(200):
            rng = np.random.default_rng([seed, n])
            found += compared(rng.normal(size=n), rng.normal(size=n) + shift).p < 0.05
        return found / 200

    assert power(0.3, 15) < power(0.8, 15) < power(1.5, 15)
    assert power(0.8, 8) < power(0.8, 15) < power(0.8, 31)


def test_holm_by_hand() -> None:
    # sorted: 0.01 * 4, 0.02 * 3, 0.03 * 2, 0.04 * 1, each at least the one before
    assert holm([0.04, 0.01, 0.03, 0.02]).tolist() == pytest.approx([0.06, 0.04, 0.06, 0.06])
    assert holm([]).size == 0


@settings(max_examples=20)  # statsmodels collects garbage at each call
@given(st.lists(st.floats(0, 1), min_size=1, max_size=20))
def test_holm_never_lowers_a_value_and_keeps_their_order(p: list[float]) -> None:
    found = holm(p)
    assert (found >= np.array(p) - 1e-12).all()
    assert (found <= 1.0).all()
    assert (np.diff(found[np.argsort(p, kind="stable")]) >= -1e-12).all()
