"""The shipped cases against the papers' tables."""

from __future__ import annotations

import math

import numpy as np
import pytest

from formulations import CASES, FAMILIES, load, parse

DEG = math.pi / 180.0


# --- the shipped cases against the papers' tables -------------------------------------------------


@pytest.mark.parametrize("case", CASES)
def test_every_shipped_case_loads_under_its_own_name(case: str) -> None:
    problem = load(case)
    assert problem.name == case
    assert problem.dof == 6
    assert problem.title != case
    assert len(problem.source) > 100
    assert FAMILIES[problem.family].refusal(problem.n_segments) is None


def test_sr4c_holds_tables_5_and_6_of_wang_2025() -> None:
    problem = load("sr4c")
    joints = [
        [0.3927, 0.5236, 1.0472, 1.5709],
        [0.1496, 0.1745, 0.5236, 0.7854],
        [-0.7854, -0.3491, 0.6283, 0.7854],
        [-0.6489, -0.1365, 1.0512, 1.3236],
        [-0.5236, -0.3491, 0.4854, 0.5172],
        [0.0, 0.5236, 2.5133, 3.1413],
    ]
    assert problem.waypoints.T.tolist() == joints
    limits = problem.limits
    np.testing.assert_allclose(limits.velocity / DEG, [90, 75, 90, 90, 150, 150], rtol=1e-14)
    np.testing.assert_allclose(limits.acceleration / DEG, [110, 55, 60, 60, 110, 90], rtol=1e-14)
    np.testing.assert_allclose(
        limits.position / DEG,
        [[-180, 180], [-130, 80], [-70, 160], [-240, 240], [-30, 200], [-360, 360]],
        rtol=1e-14,
    )
    assert not limits.has_jerk
    assert problem.family == "3-5-3"


def test_bagging_holds_table_2_of_li_2022() -> None:
    problem = load("bagging")
    assert problem.waypoints.tolist() == [
        [0, 1.5708, 0, 0, -1.5708, 0],
        [0.0133, 1.0304, -0.1374, 0, -0.8929, 1.5841],
        [-0.1787, 1.0038, -0.0971, 0, -0.9067, 1.3921],
        [-0.1787, 0.9975, -0.1019, 0, -0.8956, 1.3921],
        [0.039, 1.3226, -0.1503, 0, -1.1722, 0.039],
        [0.039, 1.2301, 0.5439, 0, -1.7739, 0.039],
        [0.2813, 1.3618, 0.3102, 0, -1.672, 0.2813],
    ]
    assert problem.limits.velocity.tolist() == [math.pi] * 6
    assert not problem.limits.has_acceleration
    assert not problem.limits.has_jerk
    assert not problem.limits.has_position
    assert problem.family == "4-3-4"
    assert problem.moving_joints == [0, 1, 2, 4, 5]


@pytest.mark.parametrize(("case", "first"), [("ur5", 64.7841), ("ur5-corrected", -64.7841)])
def test_ur5_holds_tables_1_to_3_of_zhou_2025(case: str, first: float) -> None:
    problem = load(case)
    degrees = [
        [-25.2188, 44.8152, -0.0197, 45.0923, 89.8880, first],
        [-42.8992, 14.3382, -0.0799, 75.2622, 89.9529, -47.1029],
        [70.6249, -42.8564, -0.0439, -46.3651, -89.4308, 19.3823],
        [-29.4114, -64.3680, 0.0110, -26.6506, -89.6939, 119.4000],
    ]
    limits = problem.limits
    np.testing.assert_allclose(problem.waypoints / DEG, degrees, rtol=1e-14)
    np.testing.assert_allclose(limits.velocity / DEG, [25, 25, 25, 30, 30, 35], rtol=1e-14)
    np.testing.assert_allclose(limits.acceleration / DEG, [30, 30, 30, 40, 40, 45], rtol=1e-14)
    np.testing.assert_allclose(limits.jerk / DEG, [40, 40, 40, 50, 50, 60], rtol=1e-14)
    np.testing.assert_allclose(limits.position / DEG, [[-360, 360]] * 6, rtol=1e-14)
    assert problem.family == "3-5-3"


def test_cobot_holds_table_3_of_zhang_2025() -> None:
    problem = load("cobot")
    joints = [
        [-30, 0, 30, 60],
        [0, -30, -45, -90],
        [-90, -60, -45, -30],
        [-60, -90, -60, -45],
        [-120, -90, -45, -30],
        [-30, -45, -60, -90],
    ]
    np.testing.assert_allclose(problem.waypoints.T / DEG, joints, rtol=1e-14, atol=1e-14)
    np.testing.assert_allclose(problem.limits.velocity / DEG, 100.0, rtol=1e-14)
    assert not problem.limits.has_acceleration
    assert problem.family == "3-5-3"


def test_joint_5_of_sr4c_starts_on_its_limit_and_that_is_legal() -> None:
    problem = load("sr4c")
    outside = problem.limits.position[4, 0] - problem.waypoints[0, 4]
    assert outside == pytest.approx(0.5236 - math.pi / 6.0, abs=1e-15)
    assert outside == pytest.approx(1.2244e-6, rel=1e-4)
    assert problem.position_bounds[4, 0] == -0.5236


def test_waypoints_may_repeat_and_joints_may_stand_still() -> None:
    text = "waypoints = [[0, 7], [1, 7], [1, 7], [0, 7]]\n[limits]\nvelocity = 1"
    assert parse(text).moving_joints == [0]
    assert parse("waypoints = [[3], [3]]\n[limits]\nvelocity = 1").moving_joints == []
