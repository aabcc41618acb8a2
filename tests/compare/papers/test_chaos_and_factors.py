"""Chaotic maps and learning factors of the papers follow their formulas."""

from __future__ import annotations

import numpy as np
import pytest

from compare.papers.lu_2024.figure_1 import one_orbit, orbit
from compare.papers.wang_2025.figures import figures_4_5


def test_the_tent_orbit_follows_its_formula() -> None:
    z, points = 0.3, []
    for _ in range(12):
        z = z / 0.499 if z < 0.499 else (1 - z) / 0.501
        points.append(z)
    found = figures_4_5.orbits(np.array([0.3, 0.7]), 12, 0.499)
    np.testing.assert_allclose(found[:, 0], points, rtol=1e-12)
    np.testing.assert_array_equal(
        figures_4_5.counts(found, 10)[:, 0], np.histogram(points, 10, (0, 1))[0]
    )
    assert figures_4_5.counts(np.array([[0.0], [1.0]]), 10)[:, 0].tolist() == [1, *[0] * 8, 1]
    data = figures_4_5.make_tent(False)
    assert all(sum(found) == data["particles"] for found in data["counts"].values())
    assert data["zeros"] > 0.8  # at 0.5 a double loses a bit at each of 500 steps
    # uniform numbers mapped once are uniform: the same scatter as without the map
    assert data["scatter"]["tent map, once on each"][1] == pytest.approx(
        data["scatter"]["random"][1], rel=0.05
    )


def test_the_learning_factors_are_one_plus_and_minus_a_cosine() -> None:
    data = figures_4_5.make_factors(False)
    cosine = np.cos(np.pi * np.arange(data["iterations"] + 1) / data["iterations"])
    np.testing.assert_allclose(data["c1"], 1 + cosine, atol=1e-12)
    np.testing.assert_allclose(data["c2"], 1 - cosine, atol=1e-12)
    assert (np.diff(data["w_printed"]) > 0).all()  # the text wants it to fall
    assert (np.diff(data["w_resolved"]) <= 0).all()
    assert data["w_resolved"][0] == 0.9
    assert data["w_resolved"][-1] == pytest.approx(0.4) == data["w_printed"][-1]


def test_the_chaotic_map_follows_its_closed_form_and_dies_at_one_half():
    start = np.random.default_rng(3).random(50)
    found = orbit(start, 60, 0.5)
    for n in range(1, 21):  # x_n = arccos(cos(2^n pi x_0)) / pi; the cosine loses half the digits
        expected = np.arccos(np.cos(2.0**n * np.pi * start)) / np.pi
        assert found[n - 1] == pytest.approx(expected, abs=2.0**n * 1e-15 + 1e-7)
    assert not found[54:].any()
    assert orbit(start, 500, 0.499).all()


def test_one_orbit_through_all_numbers_lies_on_the_graph_of_the_map():
    x, y = one_orbit(np.random.default_rng(0), 20, 2, 0.5).T
    assert y == pytest.approx(1.0 - np.abs(1.0 - 2.0 * x), abs=1e-15)
