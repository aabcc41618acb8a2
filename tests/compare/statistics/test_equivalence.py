"""Alike, or better: the interval over instances covers, two equal swarms are alike, and a region is kept."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest

from compare.statistics.cells import MissingCellError, complete
from compare.statistics.equivalence import (
    NEGLIGIBLE,
    effect_over_instances,
    practically_equal,
)
from compare.statistics.needed import MissingStatisticsError, all_present, needed
from compare.statistics.pairs import superiority


def effect(seed: int, shift: float, instances: int = 36, runs: int = 31):  # type: ignore[no-untyped-def]
    rng = np.random.default_rng([seed, 11])
    a12 = [superiority(rng.normal(size=runs), rng.normal(size=runs) + shift) for _ in range(instances)]
    return effect_over_instances(a12, runs, runs)


def test_two_equal_swarms_are_alike_at_the_default_size() -> None:
    found = [effect(seed, 0.0) for seed in range(200)]
    assert sum(one.negligible for one in found) >= 197
    assert 0.01 <= sum(one.p < 0.05 for one in found) / 200 <= 0.09


def test_two_equal_swarms_are_not_called_alike_on_little_evidence() -> None:
    assert not any(effect(seed, 0.0, instances=4, runs=5).negligible for seed in range(50))


def test_a_swarm_at_the_edge_of_the_region_is_seldom_called_alike() -> None:
    shift = 0.2135  # A12 = 0.56
    assert sum(effect(seed, shift).negligible for seed in range(200)) / 200 <= 0.09


def test_the_interval_covers_the_mean_effect() -> None:
    truth = 0.5 * (1 + math.erf(0.4 / 2))
    inside = [effect(seed, 0.4, instances=12, runs=15) for seed in range(200)]
    assert 0.84 <= sum(one.low <= truth <= one.high for one in inside) / 200 <= 0.98


def test_the_interval_is_never_narrower_than_the_runs_allow() -> None:
    found = effect_over_instances([0.5] * 36, 31, 31)
    width = 1.6896 * math.sqrt(63 / (12 * 31 * 31) / 36)  # Student's t at 95 %, 35 degrees of freedom
    assert (found.low, found.high) == pytest.approx((0.5 - width, 0.5 + width), abs=1e-5)
    assert found.negligible
    assert width < NEGLIGIBLE


def test_one_instance_alone_proves_nothing() -> None:
    found = effect_over_instances([1.0], 31, 31)
    assert (found.low, found.high) == (0.0, 1.0)
    assert not found.negligible


def test_gaps_within_the_region_are_equal_in_practice() -> None:
    rng = np.random.default_rng(0)
    gaps = rng.uniform(0.0, 0.05, 36)
    near = practically_equal(gaps, gaps + rng.uniform(-4e-4, 4e-4, 36), seed=1)
    assert near.equal > 0.99
    far = practically_equal(gaps, gaps + 0.01, seed=1)
    assert far.lower > 0.99
    assert practically_equal(gaps + 0.01, gaps, seed=1).higher > 0.99
    assert near.lower + near.equal + near.higher == pytest.approx(1.0)
    again = practically_equal(gaps, gaps + rng.uniform(-4e-4, 4e-4, 36), seed=1)
    assert again.equal > 0.99


def test_a_median_that_is_a_miss_is_far_from_every_gap() -> None:
    found = practically_equal([0.01] * 20, [math.inf] * 20, seed=0)
    assert found.lower > 0.99
    assert practically_equal([math.inf] * 20, [math.inf] * 20, seed=0).equal > 0.99
    with pytest.raises(ValueError, match="one gap each"):
        practically_equal([0.1], [0.1, 0.2], seed=0)


def test_a_missing_cell_is_named() -> None:
    cells = {("a", "pso"): [1.0, 2.0], ("b", "pso"): [1.0, 2.0], ("a", "mine"): [1.0]}
    complete(cells, ["a", "b"], ["pso"], 2)
    with pytest.raises(MissingCellError, match="mine on a: 1 of 2 runs; mine on b: 0 of 2 runs"):
        complete(cells, ["a", "b"], ["pso", "mine"], 2)


def test_a_missing_library_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    all_present()
    monkeypatch.setitem(sys.modules, "baycomp", None)
    with pytest.raises(MissingStatisticsError, match=r"baycomp is not installed: .*timebound\[grade\]"):
        needed("baycomp")
