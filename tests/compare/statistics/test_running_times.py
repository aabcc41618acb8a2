"""Hitting times, ECDF, expected running time, success rate, area over the curve: by loops and by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.statistics.runtimes import (
    area_over_curve,
    expected_running_time,
    fixed_target_ecdf,
    hitting_times,
    success_rate,
    targets_above,
)

TARGETS = [10.0 ** (1 - 0.2 * k) for k in range(41)]

times = st.lists(st.one_of(st.integers(1, 500).map(float), st.just(math.inf)), min_size=1, max_size=30)


@st.composite
def traces(draw: st.DrawFn) -> tuple[list[int], list[float]]:
    """A trace: where the best value fell, and to what; it may begin with nothing feasible."""
    steps = sorted(draw(st.sets(st.integers(1, 300), min_size=1, max_size=12)))
    falls = draw(st.lists(st.floats(1e-9, 20.0), min_size=len(steps), max_size=len(steps)))
    best = [2.0 * (1.0 + gap) for gap in sorted(falls, reverse=True)]
    if draw(st.booleans()):
        best[0] = math.inf
    return steps, best


def best_at(steps: list[int], best: list[float], e: int) -> float:
    """Oracle: the best value after e evaluations."""
    return min((b for s, b in zip(steps, best, strict=True) if s <= e), default=math.inf)


@given(traces())
def test_hitting_times_are_those_of_a_walk_through_every_evaluation(
    trace: tuple[list[int], list[float]],
) -> None:
    found = hitting_times(*trace, 2.0, TARGETS)
    for target, hit in zip(TARGETS, found, strict=True):
        walked = (e for e in range(1, 301) if best_at(*trace, e) / 2.0 - 1.0 <= target)
        assert hit == next(walked, math.inf)
    assert (np.diff(found[np.isfinite(found)]) >= 0).all()  # a harder target is never reached earlier


def test_no_target_is_below_what_is_proved() -> None:
    assert targets_above([1.0, 1e-3, 1e-7], 1e-4).tolist() == [1.0, 1e-3]
    assert targets_above([1.0, 1e-3], 1e-3).tolist() == [1.0, 1e-3]


@given(times, st.permutations(range(30)))
def test_the_ecdf_counts_what_was_reached_and_keeps_what_was_not(
    hits: list[float], order: list[int]
) -> None:
    found = fixed_target_ecdf(hits)
    for at, share in zip(found.at, found.share, strict=True):
        assert share == pytest.approx(sum(hit <= at for hit in hits) / len(hits))
    reached = sum(map(math.isfinite, hits)) / len(hits)
    assert (found.share[-1] if len(found.share) else 0.0) == pytest.approx(reached)
    shuffled = fixed_target_ecdf([hits[i] for i in order if i < len(hits)])
    assert np.array_equal(shuffled.at, found.at)
    assert np.allclose(shuffled.share, found.share)


def test_an_empty_set_has_no_distribution() -> None:
    with pytest.raises(ValueError, match="empty set"):
        fixed_target_ecdf([])


@given(times)
@settings(max_examples=25, deadline=None)
def test_each_failure_is_charged_its_own_budget(hits: list[float]) -> None:
    spent = [600.0 + 10 * k for k in range(len(hits))]
    paid = sum(h if math.isfinite(h) else s for h, s in zip(hits, spent, strict=True))
    successes = sum(map(math.isfinite, hits))
    found = expected_running_time(hits, spent, seed=3, resamples=200)
    assert found.value == (pytest.approx(paid / successes) if successes else math.inf)
    assert (found.successes, found.runs) == (successes, len(hits))
    assert found.low <= found.value <= found.high


def test_the_expected_running_time_of_restarts_is_what_restarts_take() -> None:
    """Restarts until the first success, simulated: 1 in 4 runs succeeds, after 30 of 100 evaluations."""
    rng = np.random.default_rng(5)
    waited = [30.0 + 100.0 * (rng.geometric(0.25) - 1) for _ in range(20_000)]
    found = expected_running_time([30.0] * 25 + [math.inf] * 75, [100.0] * 100, seed=0)
    assert found.value == 330.0
    assert found.value == pytest.approx(float(np.mean(waited)), rel=0.03)
    assert found.low < found.value < found.high


def test_the_bootstrap_interval_repeats_with_its_seed_and_covers() -> None:
    hits, spent = [10.0, 20.0, 40.0, math.inf, 15.0], [50.0] * 5
    assert expected_running_time(hits, spent, seed=1) == expected_running_time(hits, spent, seed=1)
    truth, covered = (0.7 * 20.0 + 0.3 * 50.0) / 0.7, 0
    for seed in range(200):
        success = np.random.default_rng([seed, 9]).random(60) < 0.7
        drawn = np.where(success, 20.0, math.inf)
        found = expected_running_time(drawn, [50.0] * 60, seed=seed, resamples=400)
        covered += found.low <= truth <= found.high
    assert 0.88 <= covered / 200 <= 0.99


def test_the_wilson_interval_is_that_of_the_formula() -> None:
    found = success_rate([1.0] * 7 + [math.inf] * 3)
    z, p, n = 1.959963984540054, 0.7, 10
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    assert (found.count, found.of, found.rate) == (7, 10, 0.7)
    assert (found.low, found.high) == pytest.approx((middle - half, middle + half), abs=1e-12)
    assert success_rate([math.inf] * 4).high > 0.4  # none of four is not never


@given(traces(), st.integers(1, 400))
def test_the_area_is_the_mean_over_all_evaluations(
    trace: tuple[list[int], list[float]], budget: int
) -> None:
    heights = []
    for e in range(1, budget + 1):
        gap = min(max(best_at(*trace, e) / 2.0 - 1.0, 1e-7), 1e1)
        heights.append((1.0 - math.log10(gap)) / 8.0)
    assert area_over_curve(*trace, 2.0, budget) == pytest.approx(sum(heights) / budget, abs=1e-9)


def test_the_area_of_a_run_that_finds_the_optimum_at_once_is_one() -> None:
    assert area_over_curve([1], [2.0], 2.0, 100) == 1.0
    assert area_over_curve([100], [math.inf], 2.0, 100) == 0.0
