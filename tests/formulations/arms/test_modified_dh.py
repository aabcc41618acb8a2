"""The modified form of DH tables (Craig) against products of elementary motions and printed arms."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import InputError
from formulations.arms import Arm, Chain, DHTable, branches, distance_to
from formulations.arms.kinematics import error_of

DEG = np.pi / 180.0

# Craig, Introduction to Robotics, Fig. 3.21: PUMA 560 in the modified form; lengths in mm
PUMA = DHTable(
    d=np.array([0.0, 0.0, 149.09, 433.07, 0.0, 0.0]),
    a=np.array([0.0, 0.0, 431.8, -20.32, 0.0, 0.0]),
    alpha=np.array([0.0, -90.0, 0.0, -90.0, 90.0, -90.0]),
    offset=np.zeros(6),
    sign=np.ones(6),
    form="modified",
    length="mm",
    angle="deg",
)


def turn(axis: int, angle: float) -> np.ndarray:
    pose, (i, j) = np.eye(4), [(1, 2), (2, 0), (0, 1)][axis]
    pose[i, i] = pose[j, j] = np.cos(angle)
    pose[j, i], pose[i, j] = np.sin(angle), -np.sin(angle)
    return pose


def shift(x: float, z: float) -> np.ndarray:
    pose = np.eye(4)
    pose[[0, 2], 3] = x, z
    return pose


def product(table: DHTable, q: np.ndarray) -> np.ndarray:
    """The tool by elementary motions, in the order that Craig gives; lengths in m."""
    metre, unit = {"m": 1.0, "mm": 1e-3}[table.length], {"rad": 1.0, "deg": DEG}[table.angle]
    pose = np.eye(4)
    for i, angle in enumerate(table.sign * q + table.offset * unit):
        first = turn(0, table.alpha[i] * unit) @ shift(table.a[i] * metre, 0.0)
        last = turn(2, angle) @ shift(0.0, table.d[i] * metre)
        pose = pose @ (first @ last if table.form == "modified" else last @ shift_then_turn(table, i))
    return pose


def shift_then_turn(table: DHTable, i: int) -> np.ndarray:
    metre, unit = {"m": 1.0, "mm": 1e-3}[table.length], {"rad": 1.0, "deg": DEG}[table.angle]
    return shift(table.a[i] * metre, 0.0) @ turn(0, table.alpha[i] * unit)


@given(
    seed=st.integers(0, 10**6),
    dof=st.integers(1, 7),
    form=st.sampled_from(["standard", "modified"]),
    length=st.sampled_from(["m", "mm"]),
    angle=st.sampled_from(["rad", "deg"]),
)
@settings(max_examples=60)
def test_any_table_is_the_product_of_elementary_motions(
    seed: int, dof: int, form: str, length: str, angle: str
) -> None:
    rng = np.random.default_rng(seed)
    d, a = rng.uniform(-500.0, 500.0, (2, dof)) * (1.0 if length == "mm" else 1e-3)
    alpha, offset = rng.uniform(-180.0, 180.0, (2, dof)) * (1.0 if angle == "deg" else DEG)
    table = DHTable(d, a, alpha, offset, rng.choice([-1.0, 1.0], dof), form, length, angle)
    q = rng.uniform(-3.0, 3.0, (4, dof))
    tools = table.chain().forward(q)
    for pose, joints in zip(tools, q, strict=True):
        np.testing.assert_allclose(pose, product(table, joints), atol=1e-12)


def test_the_wrist_of_the_puma_is_where_craig_computes_it() -> None:
    # eq. 3.14: px = c1 (a2 c2 + a3 c23 - d4 s23) - d3 s1 and so on
    rng = np.random.default_rng(2)
    a2, a3, d3, d4 = 0.4318, -0.02032, 0.14909, 0.43307
    for q in rng.uniform(-3.0, 3.0, (20, 6)):
        c1, s1, c2, s2 = np.cos(q[0]), np.sin(q[0]), np.cos(q[1]), np.sin(q[1])
        c23, s23 = np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
        out = a2 * c2 + a3 * c23 - d4 * s23
        wanted = [c1 * out - d3 * s1, s1 * out + d3 * c1, -a3 * s23 - a2 * s2 - d4 * c23]
        np.testing.assert_allclose(PUMA.chain().forward(q)[:3, 3], wanted, atol=1e-13)


def test_the_jacobian_of_the_modified_form_is_the_difference_quotient() -> None:
    chain, q, h = PUMA.chain(), np.array([0.4, -1.0, 0.7, 0.3, 1.1, -0.2]), 1e-6
    for j, step in enumerate(h * np.eye(6)):
        quotient = error_of(chain.forward(q + step), chain.forward(q - step)) / (2.0 * h)
        np.testing.assert_allclose(chain.jacobian(q)[:, j], quotient, atol=1e-8)


def arm_of(chain: Chain) -> Arm:
    everywhere = np.tile([-np.inf, np.inf], (len(chain.d), 1))
    return Arm("puma", "PUMA 560", "Craig", "", chain, chain, everywhere)


def test_inverse_kinematics_and_reach_know_the_modified_form() -> None:
    pytest.importorskip("eaik")
    arm = arm_of(PUMA.chain())
    q = np.array([0.4, -1.0, 0.7, 0.3, 1.1, -0.2])
    pose = arm.chain.forward(q)
    found = branches(arm, pose)
    assert len(found) == 8
    assert min(np.abs(other - q).max() for other in found) < 1e-9
    for other in found:
        np.testing.assert_allclose(product(PUMA, other), pose, atol=1e-9)
    assert distance_to(arm, pose[:3, 3])[0] < 1e-6
    # a straight arm: sqrt((a2 + hypot(a3, d4))^2 + d3^2)
    far = np.hypot(0.4318 + np.hypot(0.02032, 0.43307), 0.14909)
    assert distance_to(arm, np.array([2.0, 0.0, 0.0]))[0] == pytest.approx(2.0 - far, abs=1e-6)


@pytest.mark.parametrize(("key", "known"), [("form", "standard"), ("length", "mm"), ("angle", "deg")])
def test_an_unknown_form_or_unit_is_refused_by_name(key: str, known: str) -> None:
    words = {"form": "standard", "length": "m", "angle": "rad", key: "craigs"}
    with pytest.raises(InputError, match=rf"^{key}: 'craigs' is not one of .*{known}"):
        DHTable(*np.zeros((5, 2)), **words)
