"""The kinematics of the tool against products of poses, finite differences and long random motions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations.arms import ARMS, load_arm
from formulations.kinematics.jets import tool_motion
from formulations.kinematics.link_chain import LinkChain, Step
from formulations.kinematics.reach_bounds import ORDERS, curvatures, derivative_bounds, step_levers


def slider_and_hinges(seed: int) -> LinkChain:
    """A chain of a hinge, a slider and a hinge in random poses; the slider also moves a second hinge."""
    rng = np.random.default_rng(seed)
    steps = []
    for prismatic, variable in ((False, 0), (True, 1), (False, 1), (False, 2)):
        poses = []
        for _ in range(2):
            pose = np.eye(4)
            pose[:3, :3] = np.linalg.qr(rng.normal(size=(3, 3)))[0]
            pose[:3, 3] = rng.normal(size=3) * 0.3
            poses.append(pose)
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        steps.append(Step(*poses, axis, prismatic, variable, float(rng.uniform(-1, 1)), 0.1))
    return LinkChain(("a", "b", "c"), tuple(steps), np.eye(4)).extended([0.1, 0.2, 0.3])


@pytest.mark.parametrize("arm", ARMS)
def test_the_chain_of_an_arm_is_its_table(arm: str) -> None:
    table = load_arm(arm)
    q = np.random.default_rng(1).normal(size=(50, table.dof))
    expected = table.chain.forward(q)
    assert np.abs(table.tool.forward(q) - expected).max() < 1e-14
    point, _, _ = tool_motion(table.tool, q, q, q)
    assert np.abs(point.T - expected[:, :3, 3]).max() < 1e-14


@given(st.integers(0, 1000))
@settings(max_examples=30, deadline=None)
def test_velocity_and_acceleration_are_differences(seed: int) -> None:
    chain = slider_and_hinges(seed)
    q, v, a = np.random.default_rng(seed).normal(size=(3, 4, 3))
    step = 1e-4

    def point(t: float) -> np.ndarray:
        return chain.forward(q + t * v + t * t / 2 * a)[:, :3, 3]

    _, velocity, acceleration = tool_motion(chain, q, v, a)
    size = 1.0 + np.abs(velocity).max() + np.abs(acceleration).max()
    assert np.abs((point(step) - point(-step)) / (2 * step) - velocity.T).max() < 1e-5 * size**2
    second = (point(step) - 2 * point(0.0) + point(-step)) / step**2
    assert np.abs(second - acceleration.T).max() < 1e-4 * size**2


@given(st.integers(0, 1000))
@settings(max_examples=20, deadline=None)
def test_no_derivative_is_above_its_bound(seed: int) -> None:
    chain = slider_and_hinges(seed)
    rng = np.random.default_rng(seed)
    taylor = rng.normal(size=(ORDERS + 1, 3))  # of the joints, around t = 0
    # by an oracle: the Taylor polynomial of the tool point through Chebyshev points close to 0
    width = 0.05
    t = width * np.cos(np.pi * (np.arange(12) + 0.5) / 12)
    q = sum(np.outer(t**k, taylor[k]) for k in range(ORDERS + 1))
    fit = np.polynomial.polynomial.polyfit(t, chain.forward(q)[:, :3, 3], 9)
    factorials = np.array([1.0, 1.0, 2.0, 6.0, 24.0, 120.0])
    found = np.linalg.norm(fit[: ORDERS + 1], axis=1) * factorials
    rates = np.abs(taylor[1:, None]) * factorials[1:, None, None]
    bound = derivative_bounds(chain, np.abs(taylor[:1]), rates)[:, 0]
    assert (found[:5] <= bound[:5] * (1.0 + 1e-6)).all(), (found, bound)


@given(st.integers(0, 1000))
@settings(max_examples=20, deadline=None)
def test_second_derivatives_by_joints_are_below_their_bound(seed: int) -> None:
    chain = slider_and_hinges(seed)
    q, step = np.random.default_rng(seed).normal(size=3), 1e-4
    bound = curvatures(chain, np.abs(q) + step)
    assert np.allclose(bound, bound.T)
    unit = step * np.eye(3)
    for j in range(3):
        for k in range(3):
            corners = chain.forward(
                [
                    q + unit[j] + unit[k],
                    q + unit[j] - unit[k],
                    q - unit[j] + unit[k],
                    q - unit[j] - unit[k],
                ]
            )[:, :3, 3]
            mixed = (corners[0] - corners[1] - corners[2] + corners[3]) / (4 * step**2)
            assert np.linalg.norm(mixed) <= bound[j, k] + 1e-5
    assert (step_levers(chain, np.abs(q)) >= 0.0).all()


def test_equal_chains_are_equal() -> None:
    assert slider_and_hinges(1) == slider_and_hinges(1)
    assert hash(slider_and_hinges(1)) == hash(slider_and_hinges(1))
    assert slider_and_hinges(1) != slider_and_hinges(2)
