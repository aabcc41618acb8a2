"""How many seeds: the least p by enumeration, Noether's number by simulation, monotone in all it depends on."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from compare.statistics.pairs import compared
from compare.statistics.seeds import least_effect, least_p, least_seeds, seeds_for_effect, seeds_needed


@pytest.mark.parametrize(("n", "m"), [(1, 1), (2, 3), (4, 4), (5, 5), (3, 9)])
def test_nothing_is_more_significant_than_two_separated_sets(n: int, m: int) -> None:
    assert least_p(n, m) == pytest.approx(compared(range(n), range(100, 100 + m)).p)


def test_five_seeds_show_nothing_over_36_instances() -> None:
    # 2 / C(10, 5) = 2 / 252, times 36
    found = seeds_needed(5, 0.8, tests=36)
    assert found.least_p == pytest.approx(36 * 2 / 252)
    assert not found.possible
    assert found.least_seeds == 7  # 36 * 2 / C(14, 7) = 0.021, and 36 * 2 / C(12, 6) = 0.078
    assert seeds_needed(7, 0.8, tests=36).possible
    assert not seeds_needed(3, 1.0, tests=1).possible  # 2 / C(6, 3) = 0.1
    assert seeds_needed(4, 1.0, tests=1).possible


def test_noether_by_hand_and_by_simulation() -> None:
    # (1.959964 + 0.841621)^2 / (6 * 0.2^2) = 32.7
    assert seeds_for_effect(0.7) == 33
    shift = 0.741614  # of two normal losses with A12 = 0.7
    found = 0
    for seed in range(400):
        rng = np.random.default_rng([seed, 7])
        found += compared(rng.normal(size=33), rng.normal(size=33) + shift).p < 0.05
    assert 0.74 <= found / 400 <= 0.88


@given(st.floats(0.01, 0.49), st.floats(0.01, 0.49), st.integers(1, 60))
def test_a_smaller_effect_or_more_tests_never_need_fewer_seeds(a: float, b: float, tests: int) -> None:
    small, large = sorted((a, b))
    few, many = seeds_for_effect(0.5 + large, tests), seeds_for_effect(0.5 + small, tests)
    assert few is not None
    assert many is not None
    assert few <= many
    assert seeds_for_effect(0.5 - large, tests) == few  # worse is found as easily as better
    assert few >= least_seeds(tests)
    more = seeds_for_effect(0.5 + large, tests + 1)
    assert more is not None
    assert more >= few


def test_no_effect_is_found_by_no_number_of_seeds() -> None:
    assert seeds_for_effect(0.5) is None


@given(seeds=st.integers(2, 3000), tests=st.integers(1, 40))
def test_the_least_effect_is_the_one_that_takes_so_many_seeds(seeds: int, tests: int) -> None:
    found = least_effect(seeds, tests)
    if found is None:
        takes = seeds_for_effect(1.0, tests)
        assert takes is not None
        assert takes > seeds
        return
    takes, fewer = seeds_for_effect(found * (1 + 1e-9), tests), seeds_for_effect(found - 1e-3, tests)
    assert takes is not None
    assert fewer is not None
    assert takes <= seeds <= fewer
