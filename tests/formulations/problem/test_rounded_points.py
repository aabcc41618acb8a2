"""Dense waypoints that were rounded are told from exact ones, and from those that a person wrote."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import CASES, Conditions, Problem, load, plan

LIMITS = {"velocity": 2.0, "acceleration": 10.0, "jerk": 100.0}


def line(dof: int = 3, n: int = 100, step: float = 1e-3, seed: int = 0) -> np.ndarray:
    """Points on a straight line."""
    direction = np.random.default_rng(seed).uniform(0.2, 1.0, dof)
    return 0.3 + np.arange(n)[:, None] * step * direction / np.linalg.norm(direction)


@settings(max_examples=30, deadline=None)
@given(dof=st.integers(2, 7), seed=st.integers(0, 99))
def test_a_line_rounded_to_a_tenth_of_its_steps_is_found(dof: int, seed: int) -> None:
    (hint,) = Problem(line(dof, seed=seed).round(4), LIMITS).hints
    assert "multiples of 0.0001 rad" in hint
    assert "tolerance = 5e-05" in hint
    assert len(hint.splitlines()) == 1


@settings(max_examples=30, deadline=None)
@given(dof=st.integers(1, 7), seed=st.integers(0, 99))
def test_exact_points_get_no_hint(dof: int, seed: int) -> None:
    assert Problem(line(dof, seed=seed), LIMITS).hints == ()
    curve = np.sin(line(dof, seed=seed) * np.arange(1, dof + 1))
    assert Problem(curve, LIMITS).hints == ()


def test_the_unit_is_that_of_the_numbers_and_the_tolerance_that_of_the_file() -> None:
    points = np.rad2deg(line()).round(3)
    limits = {"velocity": 120, "acceleration": 600, "jerk": 6000}
    (hint,) = Problem(points, limits, unit="deg").hints
    assert "multiples of 0.001 deg" in hint
    assert "tolerance = 0.0005 " in hint
    (other,) = Problem(points, limits, unit="deg", display_unit="rad").hints
    assert "multiples of 0.001 deg" in other
    assert f"tolerance = {np.deg2rad(0.0005):.3g} " in other


def test_the_hint_ends_with_the_tolerance_that_it_asks_for() -> None:
    problem = Problem(line().round(4), LIMITS)
    zone = np.full(3, 5e-5)
    zoned = Conditions(tolerance=dict.fromkeys(range(1, problem.n_segments), zone))
    assert replace(problem, conditions=zoned).hints == ()
    assert replace(problem, conditions=Conditions(tolerance={1: zone})).hints


def test_rounding_that_costs_nothing_is_not_spoken_of() -> None:
    assert Problem(line().round(7), LIMITS).hints == ()
    assert Problem(line().round(4), {"velocity": 2.0}).hints == ()  # a corner costs nothing then


def test_a_dense_part_between_far_waypoints_is_found_too() -> None:
    far = np.random.default_rng(2).uniform(-1.0, 1.0, (3, 3)).round(2)
    points = np.vstack([line().round(4), far])
    (hint,) = Problem(points, LIMITS).hints
    second = np.abs(np.diff((points * 1e4).round(), 2, axis=0)).max(axis=1)
    assert f"{np.sum((second > 0) & (second <= 2))} of them lie beside" in hint
    assert Problem(np.vstack([line(), far]), LIMITS).hints == ()


@pytest.mark.parametrize("case", CASES)
def test_the_cases_of_the_papers_get_no_hint(case: str) -> None:
    assert load(case).hints == ()


def test_points_that_a_person_typed_get_no_hint() -> None:
    rng = np.random.default_rng(1)
    for digits in (1, 2, 3, 4):
        assert Problem(rng.uniform(-2, 2, (40, 6)).round(digits), LIMITS).hints == ()
    staircase = np.cumsum(np.tile(np.eye(2) * 0.01, (20, 1)), axis=0)
    assert Problem(staircase, LIMITS).hints == ()
    grid = 0.01 * np.arange(50)[:, None] * [1.0, 2.0]  # exact multiples on a line
    assert Problem(grid, LIMITS).hints == ()


def test_the_tolerance_that_the_hint_gives_undoes_the_rounding() -> None:
    points = line(dof=2, n=40)
    exact, rounded = Problem(points, LIMITS), Problem(points.round(4), LIMITS)
    half = Conditions(tolerance=dict.fromkeys(range(1, 39), np.full(2, 5.0001e-5)))
    assert np.abs(points[[0, -1]] - points[[0, -1]].round(4)).max() < 1e-4
    seconds = {
        name: plan(problem, bound=False).seconds
        for name, problem in (
            ("exact", exact),
            ("rounded", rounded),
            ("zoned", replace(rounded, conditions=half)),
        )
    }
    (hint,) = rounded.hints
    said = float(hint.split("take about ")[1].split()[0])
    assert 1.1 < said <= seconds["rounded"] / seconds["exact"]
    # the exact points are in the zones, and only the ends have moved, by half a step
    assert seconds["zoned"] <= 1.001 * seconds["exact"]
