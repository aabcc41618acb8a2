"""Torques against equations written here, and their greatest values between samples."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_arms import LEVEL, SIX, VERTICAL, pendulum, six_axes, two_links

from formulations import Conditions, InputError, Limits, Problem, Trajectory, check
from formulations.problem.torque import Payload, TorqueLimits

pytest.importorskip("pinocchio", reason="pin is not installed (extra dynamics)")
pytest.importorskip("yourdfpy", reason="yourdfpy is not installed (extra robot)")

from formulations.dynamics.growth import growth
from formulations.dynamics.model import dynamics_of
from formulations.dynamics.peaks import RESOLUTION, stretch_of, torque_extremes
from formulations.dynamics.symbolic import symbolic_torques

G = 9.81
MASSES, LENGTHS, INERTIAS = (3.0, 2.0), (0.6, 0.5), (0.12, 0.07)


def by_hand(q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Torques of ``two_links`` by Lagrange's equations; angles from the horizontal, positive downward."""
    (m1, m2), (l1, _), (i1, i2) = MASSES, LENGTHS, INERTIAS
    c1, c2 = LENGTHS[0] / 2.0, LENGTHS[1] / 2.0
    cos2, sin2 = np.cos(q[..., 1]), np.sin(q[..., 1])
    m22 = i2 + m2 * c2**2
    m12 = m22 + m2 * l1 * c2 * cos2
    m11 = i1 + m1 * c1**2 + m2 * l1**2 + m22 + 2.0 * m2 * l1 * c2 * cos2
    bend = m2 * l1 * c2 * sin2
    g2 = -m2 * G * c2 * np.cos(q[..., 0] + q[..., 1])
    g1 = -(m1 * c1 + m2 * l1) * G * np.cos(q[..., 0]) + g2
    one = m11 * a[..., 0] + m12 * a[..., 1] - bend * (2.0 * v[..., 0] * v[..., 1] + v[..., 1] ** 2) + g1
    two = m12 * a[..., 0] + m22 * a[..., 1] + bend * v[..., 0] ** 2 + g2
    return np.stack([one, two], axis=-1)


def of(urdf: str, joints: tuple[str, ...], **others: object) -> TorqueLimits:
    return TorqueLimits(urdf, joints, **others)  # type: ignore[arg-type]


def random_motion(seed: int, dof: int, degree: int = 5, pieces: int = 3) -> Trajectory:
    rng = np.random.default_rng(seed)
    size = 2.0 / np.arange(1, degree + 2) ** 1.5
    return Trajectory(rng.uniform(0.1, 0.6, pieces), rng.normal(size=(pieces, dof, degree + 1)) * size)


@given(st.integers(0, 10**6))
@settings(max_examples=30, deadline=None)
def test_two_links_obey_the_equations_written_here(seed: int) -> None:
    q, v, a = np.random.default_rng(seed).normal(size=(3, 4, 2)) * 2.0
    found = dynamics_of(of(two_links(), ("one", "two"))).torques(q, v, a)
    np.testing.assert_allclose(found, by_hand(q, v, a), rtol=1e-10, atol=1e-10)


def test_joints_in_another_order_and_locked_ones() -> None:
    q, v, a = np.random.default_rng(1).normal(size=(3, 5, 2))
    turned = dynamics_of(of(two_links(), ("two", "one"))).torques(q[:, ::-1], v[:, ::-1], a[:, ::-1])
    np.testing.assert_allclose(turned[:, ::-1], by_hand(q, v, a), atol=1e-10)
    still = np.zeros((5, 2))
    alone = [np.stack([x[:, 0], still[:, 0]], axis=1) for x in (q, v, a)]
    locked = dynamics_of(of(two_links(), ("one",))).torques(*(x[:, :1] for x in (q, v, a)))
    np.testing.assert_allclose(locked[:, 0], by_hand(*alone)[:, 0], atol=1e-10)


@pytest.mark.parametrize("kind", ["revolute", "continuous"])
def test_damping_payload_and_gravity(kind: str) -> None:
    q, v, a = np.random.default_rng(2).normal(size=(3, 6, 1))
    urdf = pendulum(damping=0.7, friction=1.5, kind=kind)
    payload = Payload(1.2, (0.8, 0.0, 0.0), "rod")
    arm = dynamics_of(of(urdf, ("hinge",), payload=payload, gravity=(0.0, 0.0, -1.62)))
    inertia = 0.1 + 2.0 * 0.5**2 + 1.2 * 0.8**2
    weight = -1.62 * np.cos(q) * (2.0 * 0.5 + 1.2 * 0.8)
    np.testing.assert_allclose(arm.torques(q, v, a), inertia * a + weight + 0.7 * v, atol=1e-12)
    np.testing.assert_allclose(arm.available, 8.0 - 1.5)


def test_prismatic_axis_lifts_its_weight() -> None:
    arm = dynamics_of(of(pendulum(VERTICAL, kind="prismatic"), ("hinge",)))
    np.testing.assert_allclose(arm.torques(*np.full((3, 1, 1), 0.3)), 2.0 * (0.3 + G))


@given(st.integers(0, 10**6))
@settings(max_examples=20, deadline=None)
def test_symbols_and_pinocchio_agree(seed: int) -> None:
    q, v, a = np.random.default_rng(seed).normal(size=(3, 6)) * 3.0
    arm = dynamics_of(of(six_axes(), SIX, payload=Payload(2.0, (0.0, 0.1, 0.05))))
    shares = np.asarray(symbolic_torques(arm)(q, v, a)).ravel()
    np.testing.assert_allclose(shares * arm.available, arm.torques(q, v, a), rtol=1e-9, atol=1e-9)


@given(st.integers(0, 10**6))
@settings(max_examples=25, deadline=None)
def test_second_derivatives_stay_below_their_bounds(seed: int) -> None:
    arm = dynamics_of(of(six_axes(), SIX))
    motion = random_motion(seed, 6, pieces=1)
    times = np.linspace(0.0, motion.seconds, 4001)
    torques = arm.torques(*(motion.at(times, order) for order in range(3)))
    bends = np.abs(np.diff(torques, 2, axis=0)) / times[1] ** 2
    reach = np.stack([np.abs(motion.at(times, order)).max(axis=0) for order in range(5)])
    bound = growth(arm, reach[:, None])[0]
    assert (bends.max(axis=0) <= bound * (1.0 + 1e-3)).all()


@given(st.integers(0, 10**6))
@settings(max_examples=25, deadline=None)
def test_no_sample_exceeds_the_greatest_torque(seed: int) -> None:
    arm = dynamics_of(of(six_axes(), SIX))
    motion = random_motion(seed, 6)
    found = torque_extremes(arm, motion)
    times = np.linspace(0.0, motion.seconds, 20001)
    torques = np.abs(arm.torques(*(motion.at(times, order) for order in range(3))))
    assert (torques.max(axis=0) <= found.greatest + RESOLUTION * arm.available * 1.01).all()
    reached = (
        [motion.at(found.times - 1e-12, k) for k in range(3)],
        [motion.at(found.times, k) for k in range(3)],
    )
    sides = np.abs(np.stack([arm.torques(*states) for states in reached]))
    np.testing.assert_allclose(
        np.abs(sides - found.greatest).min(axis=0).diagonal(), 0.0, atol=1e-6 * found.greatest.max()
    )


def test_a_violation_between_samples_is_found() -> None:
    limits = Limits.of(velocity=10.0, acceleration=1e4, jerk=1e9, dof=1)
    inertia = 0.1 + 2.0 * 0.5**2
    torque = of(pendulum(VERTICAL, effort=4.0), ("hinge",))
    # a jerk up and down for 2 ms each: between samples at 100 Hz nothing is to be seen of it
    d, j = 0.002, 4000.0
    jerks, durations = (
        [5.0, -5.0, 0.0, j, -j, -j, j, 0.0, -5.0, 5.0],
        [0.4, 0.4, 0.203, d, d, d, d, 0.199, 0.4, 0.4],
    )
    state, pieces = np.zeros(3), []
    for jerk, h in zip(jerks, durations, strict=True):
        pieces.append([[state[0], state[1], state[2] / 2.0, jerk / 6.0]])
        state = np.array(
            [
                state[0] + h * (state[1] + h * (state[2] / 2.0 + h * jerk / 6.0)),
                state[1] + h * (state[2] + h * jerk / 2.0),
                state[2] + h * jerk,
            ]
        )
    motion = Trajectory(np.array(durations), np.array(pieces), np.array([0.0, sum(durations)]))
    problem = Problem([[0.0], [state[0]]], limits, conditions=Conditions(torque=torque))
    coarse = motion.at(np.arange(0.0, motion.seconds, 0.01), 2) * inertia
    assert np.abs(coarse).max() < 4.0
    verdict = check(problem, motion)
    assert [fault for fault in verdict.faults if "torque of joint 1" in fault]
    peak = next(peak for peak in verdict.peaks if peak.quantity == "torque")
    assert abs(peak.value) == pytest.approx(inertia * j * d, rel=1e-6)
    assert peak.stretch == pytest.approx(np.sqrt(peak.factor), rel=1e-6)
    assert "N m" in str(peak)
    kept = check(problem, motion.stretched(verdict.stretch * (1.0 + 1e-9)))
    assert not [fault for fault in kept.faults if "torque" in fault]


@given(st.floats(-9.0, 9.0), st.floats(-9.0, 9.0), st.floats(-90.0, 90.0))
def test_stretch_is_the_least_factor(held: float, damped: float, driven: float) -> None:
    limit = np.array([8.0])
    factor = float(stretch_of(np.array([held]), np.array([damped]), np.array([driven]), limit)[0])

    def torque(s: np.ndarray) -> np.ndarray:
        return np.abs(held + damped / s + driven / s**2)

    if abs(held) >= 8.0:
        assert factor == np.inf
        return
    slower = (factor + 1e-12) * np.geomspace(1.0 + 1e-9, 100.0, 500)
    assert (torque(slower) <= 8.0 * (1.0 + 1e-6)).all()
    if factor > 1e-3:
        assert torque(np.array(factor * (1.0 - 1e-6))) > 8.0 * (1.0 - 1e-4)


def test_what_cannot_be_is_refused_in_one_line() -> None:
    urdf = two_links()
    for torque, words in [
        (of(urdf, ("one", "tow")), "no joint 'tow'"),
        (of(pendulum(effort=0.0), ("hinge",)), "effort 0 is no limit"),
        (of(pendulum(friction=9.0), ("hinge",)), "friction 9 N m leaves nothing"),
        (of(pendulum(mass=0.0, inertia=0.0), ("hinge",)), "no link that moves has a mass"),
        (of(urdf, ("one", "two"), payload=Payload(1.0, link="l9")), "no link 'l9'"),
        (of(urdf, ("one", "two"), payload=Payload(1.0, link="base")), "not moved"),
    ]:
        with pytest.raises(InputError) as caught:
            dynamics_of(torque)
        assert words.strip("'") in str(caught.value).replace('"', "'"), caught.value
        assert "\n" not in str(caught.value)
    with pytest.raises(InputError, match="joint one: -1 N m is not positive"):
        of(urdf, ("one", "two"), limits=(-1.0, 2.0))
    with pytest.raises(InputError, match="expected 2 limits"):
        of(urdf, ("one", "two"), limits=(1.0,))
    with pytest.raises(InputError, match="mass 0 kg"):
        Payload(0.0)
    with pytest.raises(InputError, match="2 joints, the problem has 1"):
        Problem(
            [[0.0], [1.0]], {"velocity": 1.0}, conditions=Conditions(torque=of(urdf, ("one", "two")))
        )


def test_limits_are_those_of_the_urdf_unless_given() -> None:
    torque = of(two_links(axis=LEVEL), ("two", "one"))
    np.testing.assert_allclose(dynamics_of(torque).limits, [25.0, 60.0])
    halved = torque.scaled(0.5, dynamics_of(torque).limits)
    np.testing.assert_allclose(dynamics_of(halved).limits, [12.5, 30.0])
