"""The family optimum against closed forms, differential evolution and random candidates."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import family_oracle
import numpy as np
import pytest
from conftest import SOLVED, problems
from family_oracle import (
    NO_SHRINKING,
    THREE,
    agrees,
    judged,
    optimum,
    quick,
    scaled_seconds,
    searched,
)
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from formulations import (
    FAMILIES,
    Limits,
    NoFeasibleMotion,
    Problem,
    family_optimum,
    load,
)
from formulations.optima.family.program import duration_scales


def test_there_and_back_in_two_quartics_takes_four_root_three() -> None:
    """x = 4 s^3 - 3 s^4 and its mirror: |a| peaks at 12 / T^2, so A = 1 asks for T = sqrt(12)."""
    problem = Problem.of([[0.0], [1.0], [0.0]], Limits.of(1.0, 1.0, dof=1))
    found = family_optimum(problem)
    judged(found)
    assert found.seconds == pytest.approx(4.0 * math.sqrt(3.0), rel=1e-9)
    np.testing.assert_allclose(found.durations, math.sqrt(12.0), rtol=1e-4)


def test_there_and_back_with_velocity_alone_takes_32_ninths() -> None:
    """|v| of 4 s^3 - 3 s^4 peaks at 16/9 / T, at s = 2/3."""
    problem = Problem.of([[0.0, 5.0], [1.0, 5.0], [0.0, 5.0]], Limits.of(1.0, dof=2))
    found = family_optimum(problem)
    judged(found)
    assert found.seconds == pytest.approx(32.0 / 9.0, rel=1e-9)


@given(problem=problems(segments=2, reach=(-3.0, 2.0)))
@settings(max_examples=8, phases=NO_SHRINKING)
def test_two_segments_agree_with_a_search_along_the_one_ratio(problem: Problem) -> None:
    assume(problem.moving_joints)
    found = family_optimum(problem)
    judged(found)
    y = np.linspace(-14.0, 14.0, 20_001)
    seconds = scaled_seconds(problem, np.exp(np.stack([y / 2.0, -y / 2.0], axis=1)))
    best = int(seconds.argmin())
    assume(0 < best < len(y) - 1)

    def along(z: float) -> float:
        return float(scaled_seconds(problem, np.exp([[z / 2.0, -z / 2.0]]))[0])

    exact = minimize_scalar(
        along, bounds=(y[best - 1], y[best + 1]), method="bounded", options={"xatol": 1e-12}
    )
    oracle = min(float(exact.fun), float(seconds[best]))
    assert found.seconds <= oracle * (1.0 + 1e-9)
    assert found.seconds >= oracle * (1.0 - 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("case", THREE)
def test_shipped_cases_agree_with_differential_evolution(case: str) -> None:
    agrees(load(case), optimum(case))


@pytest.mark.slow
@pytest.mark.parametrize("family", ["quintic", "b-spline-3", "b-spline-5"])
def test_other_families_agree_with_differential_evolution(
    family: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Joint 5 starts on its limit and the B-splines lean on it: no slack at all for the oracle."""
    monkeypatch.setattr(family_oracle, "KEPT", 1e-13)
    problem = replace(load("sr4c"), family=family)
    assert (problem.waypoints[0] == problem.position_bounds[:, 0])[4]
    agrees(problem, quick(problem))


@pytest.mark.slow
@pytest.mark.parametrize("case", THREE)
def test_every_joint_alone_agrees_with_differential_evolution(case: str) -> None:
    problem, known = load(case), load("ur5")
    for joint in problem.moving_joints:
        if case == "ur5-corrected" and (problem.waypoints == known.waypoints)[:, joint].all():
            continue  # the same joint as in ur5
        agrees(problem.joint(joint), optimum(case, joint))


@pytest.mark.slow
@given(problem=problems(reach=(-3.0, 1.0)))
@settings(max_examples=8, phases=NO_SHRINKING)
def test_made_up_problems_agree_with_differential_evolution(problem: Problem) -> None:
    assume(problem.moving_joints)
    found = family_optimum(problem)
    judged(found)
    oracle, _ = searched(problem, reach=9.0)
    assert found.seconds <= oracle * (1.0 + 1e-9)


@pytest.mark.slow
@given(
    middle=st.floats(-0.4, 0.4),
    last=st.floats(-1.5, 1.5),
    limited=st.sampled_from(["v", "va", "vaj"]),
)
@settings(max_examples=6, phases=NO_SHRINKING)
def test_problems_with_two_basins_end_in_the_better_one(
    middle: float, last: float, limited: str
) -> None:
    """One joint and a small middle displacement: where local solvers are misled."""
    limits = {"velocity": 1.0, "acceleration": 1.5, "jerk": 4.0}
    kept = {name: limits[name] for name in limits if name[0] in limited}
    problem = Problem.of(
        [[0.0], [1.0], [1.0 + middle], [1.0 + middle + last]], Limits.of(**kept, dof=1)
    )
    found = family_optimum(problem)
    judged(found)
    assert found.seconds <= searched(problem)[0] * (1.0 + 1e-9)


@pytest.mark.parametrize(
    ("points", "limits"),
    [
        ([[0.0], [1.0], [1.2], [1.21]], {"velocity": 1.4, "acceleration": 0.2}),
        ([[0.0], [1.0], [1.2], [1.2001]], {"velocity": 1.4, "acceleration": 0.2}),
        (
            np.cumsum(
                [[0, 0], [-6.6034e-7, -3.5427e-7], [-0.14149, -0.11083], [-0.41967, -0.31097]], axis=0
            ),
            {
                "velocity": [1.129, 0.70614],
                "acceleration": [7.3339, 0.50884],
                "jerk": [1.9512, 0.27405],
            },
        ),
    ],
    ids=["a short last step", "a shorter one", "a tiny first step"],
)
def test_a_narrow_better_basin_is_found(points: Any, limits: dict[str, Any]) -> None:
    problem = Problem.of(points, Limits.of(**limits, dof=len(points[0])))
    found = family_optimum(problem)
    judged(found)
    oracle, _ = searched(problem, reach=9.0)
    assert found.seconds <= oracle * (1.0 + 1e-9)


def test_a_start_that_is_called_ok_ends_where_no_neighbour_is_faster() -> None:
    problem = Problem.of([[0.0], [1.0], [1.2], [1.21]], Limits.of(1.4, 0.2, dof=1))
    rng = np.random.default_rng(5)
    steps = np.exp(rng.normal(size=(20_000, 3)) * 10.0 ** rng.uniform(-6.0, -2.0, (20_000, 1)))
    for start in family_optimum(problem).starts:
        if start.status == "ok":
            near = float(scaled_seconds(problem, start.durations * steps).min())
            assert start.seconds <= near * (1.0 + 1e-7), start


@pytest.mark.long
@given(problem=problems(reach=(-3.0, 1.0), position=True), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=8, phases=NO_SHRINKING)
def test_no_random_candidate_is_faster_than_the_optimum(problem: Problem, seed: int) -> None:
    assume(problem.moving_joints)
    rng = np.random.default_rng(seed)
    t = np.exp(rng.uniform(-7.0, 7.0, (20_000, 3)))
    t[:5000] = np.exp(rng.uniform(-1.0, 1.0, (5000, 3))) * duration_scales(problem)
    try:
        found = family_optimum(problem)
    except NoFeasibleMotion:
        assert not np.isfinite(scaled_seconds(problem, t)).any()
        return
    judged(found)
    t[5000:10_000] = found.durations * np.exp(rng.normal(size=(5000, 3)) * 1e-2)
    assert found.seconds <= scaled_seconds(problem, t).min() * (1.0 + 1e-9)


@given(problem=problems(segments=st.integers(2, 6), family="4-3-4", reach=(-2.0, 1.0)))
@settings(max_examples=4, phases=NO_SHRINKING)
def test_no_random_candidate_is_faster_in_longer_splines(problem: Problem) -> None:
    assume(problem.moving_joints)
    found = family_optimum(problem)
    judged(found)
    rng = np.random.default_rng(3)
    n = problem.n_segments
    t = np.exp(rng.uniform(-3.0, 3.0, (20_000, n)))
    t[10_000:] = found.durations * np.exp(
        rng.normal(size=(10_000, n)) * 10.0 ** rng.uniform(-5.0, 0.0, (10_000, 1))
    )
    assert found.seconds <= scaled_seconds(problem, t).min() * (1.0 + 1e-9)


@pytest.mark.long
@pytest.mark.parametrize("case", SOLVED)
def test_no_neighbour_of_a_shipped_optimum_is_faster(case: str) -> None:
    found = optimum(case)
    judged(found)
    rng = np.random.default_rng(11)
    steps = rng.normal(size=(20_000, len(found.durations)))
    steps *= 10.0 ** rng.uniform(-7.0, -0.5, (20_000, 1))
    seconds = scaled_seconds(found.problem, found.durations * np.exp(steps))
    assert found.seconds <= seconds.min() * (1.0 + 1e-9)
    # the stretched optimum is stretched to the limit
    assert FAMILIES[found.family].stretch(found.problem, found.durations[None])[0] == pytest.approx(
        1.0, rel=1e-12
    )


@pytest.mark.parametrize("case", THREE)
def test_the_cubes_of_an_optimum_keep_their_closed_form_bounds(case: str) -> None:
    """The first and last cube alone ask for T >= 3 |d| / V, sqrt(6 |d| / A), cbrt(6 |d| / J)."""
    found = optimum(case)
    limits, d = found.problem.limits, np.abs(found.problem.displacements)
    for k in (0, 2):
        least = max(
            (3.0 * d[k] / limits.velocity).max(),
            np.sqrt(6.0 * d[k] / limits.acceleration).max(),
            np.cbrt(6.0 * d[k] / limits.jerk).max(),
        )
        assert found.durations[k] >= least * (1.0 - 1e-9)
