"""The tent map and the start along its orbit."""

from __future__ import annotations

import numpy as np
import pytest
from loops import Array, one_task, task_on

from metaheuristics.swarms.tent import tent_map, tent_population

pytestmark = pytest.mark.filterwarnings("error")


def test_the_tent_map_folds_at_its_peak() -> None:
    z = np.array([0.0, 0.25, 0.499, 0.7495, 1.0])
    np.testing.assert_allclose(tent_map(z, 0.499), [0.0, 0.25 / 0.499, 1.0, 0.5, 0.0], atol=1e-15)


def test_a_tent_population_follows_the_map_and_fills_the_box_evenly() -> None:
    x = tent_population(task_on(4, seed=2), 10_000)
    np.testing.assert_array_equal(x[1:], tent_map(x[:-1]))
    for d in range(4):
        counts = np.histogram(x[:, d], bins=10, range=(0, 1))[0]
        assert np.all(np.abs(counts - 1000) < 150)  # 5 standard deviations of uniform draws
    assert np.all(np.abs(np.corrcoef(x.T) - np.eye(4)) < 0.05)


def test_a_tent_orbit_through_its_peak_stays_in_the_box() -> None:
    peak = np.random.default_rng(0).random()  # the first state drawn
    x = tent_population(task_on(1, lo=-3.0, hi=0.1), 2, peak)
    assert x.tolist() == [[0.1], [-3.0]]


def test_the_tent_orbit_lives_on_at_0499_and_dies_at_one_half() -> None:
    alive = tent_population(task_on(5), 10_000, 0.499)
    assert len(np.unique(alive[:, 0])) == 10_000
    assert np.all(alive[-100:].max(0) > 0.5)
    dead = tent_population(task_on(5), 100, 0.5)
    assert np.all(dead[:40].max(1) > 0)
    assert np.all(dead[60:] == 0)


def test_a_tent_population_is_as_even_as_a_random_one_and_no_more() -> None:
    """Wang 2025, Fig. 4, counts 500 numbers in ten bins. One orbit proves nothing; the mean of many does."""

    def unevenness(x: Array) -> float:
        counts = np.histogram(x, bins=10, range=(0, 1))[0]
        return float(((counts - 50.0) ** 2 / 50.0).sum())

    tent = [unevenness(tent_population(one_task(s, dim=1, lo=0, hi=1), 500)) for s in range(300)]
    uniform = [unevenness(np.random.default_rng(s).random(500)) for s in range(300)]
    assert np.mean(uniform) == pytest.approx(9.0, abs=1.3)  # chi-square of 9 degrees
    assert np.mean(tent) < 1.3 * np.mean(uniform)
    assert np.mean(tent) > 0.3 * np.mean(uniform)
