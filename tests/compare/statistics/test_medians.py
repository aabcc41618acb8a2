"""Medians and gains: their intervals hold as often as they say."""

from __future__ import annotations

from math import comb, inf

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from compare.statistics.medians import gain_over, median_of


@pytest.mark.parametrize("n", [1, 2, 5, 6, 8, 11, 12, 20, 31])
def test_the_interval_is_the_shortest_that_misses_seldom_enough(n: int) -> None:
    found = median_of(np.arange(1.0, n + 1.0)[::-1])
    assert found.value == (n + 1) // 2

    def missed(left_out: int) -> float:  # the median lies beyond the run that is left, on either side
        return 2.0 * sum(comb(n, k) for k in range(left_out + 1)) / 2.0**n

    if found.low == -inf:
        assert found.high == inf
        assert missed(0) > 0.05
    else:
        left_out = int(found.low) - 1
        assert int(found.high) == n - left_out
        assert missed(left_out) <= 0.05 < missed(left_out + 1)


def test_a_run_without_a_result_counts() -> None:
    assert median_of([3.0, inf, inf]).value == inf
    assert median_of([3.0, 1.0, inf]).value == 3.0
    assert median_of([2.0] * 5 + [inf] * 2).high == inf
    assert gain_over([1.0, 1.0, 1.0], [inf, inf, inf], seed=0).low == 1.0
    assert gain_over([inf, inf], [inf, inf], seed=0).value == 0.0
    with pytest.raises(ValueError, match="NaN"):
        gain_over([1.0, float("nan")], [1.0], seed=0)


def test_intervals_of_gains_hold() -> None:
    rng, truth, held = np.random.default_rng(3), 1.0 - 16.0 / 20.0, 0
    for trial in range(200):
        first, second = (middle * np.exp(0.1 * rng.standard_normal(15)) for middle in (16.0, 20.0))
        found = gain_over(first, second, seed=trial, resamples=400)
        held += found.low <= truth <= found.high
    assert 178 <= held <= 200


@given(st.lists(st.floats(1.0, 9.0), min_size=1, max_size=12), st.floats(0.1, 10.0))
def test_laws_of_gains(losses: list[float], factor: float) -> None:
    scaled = [factor * x for x in losses]
    found = gain_over(scaled, losses, seed=1, resamples=50)
    assert found.value == pytest.approx(1.0 - factor)
    assert found.low <= found.high
    assert gain_over(scaled, losses, seed=1, resamples=50) == found
