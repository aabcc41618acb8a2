"""Accelerations at the waypoints bounded by the durations: by oracles, and with faults planted."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from every_motion_helpers import (
    exact,
    problem_of,
    splined,
    stopping,
    through_states,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from compare.check_certificate.answers import Refused
from compare.check_certificate.balls import R
from compare.check_certificate.families.every_motion import accelerations
from compare.check_certificate.verify import verify
from formulations import Problem, check, free_form, free_form_bound
from formulations.problem.arrays import Array
from formulations.proofs.every_motion.relaxation import propagation
from formulations.proofs.every_motion.relaxation.boxes import Boxes
from formulations.proofs.every_motion.relaxation.propagation import propagate
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem


def around(problem: Problem, durations: Array, width: float) -> Boxes:
    relaxed = RelaxedProblem.of(problem, 10.0 * float(durations.sum()))
    return propagate(relaxed, Boxes.around(relaxed, durations / width, durations * width))


@given(
    seed=st.integers(0, 10**6),
    step=st.floats(-6.0, -1.0),
    n=st.integers(2, 7),
    dof=st.integers(1, 6),
    width=st.sampled_from([1.0, 1.01, 1.5, 4.0]),
    jerk_alone=st.booleans(),
)
@settings(max_examples=40, deadline=None)
def test_no_motion_is_lost(
    seed: int, step: float, n: int, dof: int, width: float, jerk_alone: bool
) -> None:
    """Motions with any states at the waypoints, where jerk matters alone or with the other limits."""
    rng = np.random.default_rng(seed)
    J = 50.0
    limits = (
        (1e3, 1e4, J) if jerk_alone else (0.5 * 10.0 ** (step / 2.0), 5.0 * 10.0 ** (step / 3.0), J)
    )
    steps = 10.0**step * rng.uniform(0.1, 1.0, (n, dof)) * rng.choice([-1.0, 1.0], (n, dof))
    problem = problem_of(np.cumsum(np.vstack([np.zeros(dof), steps]), axis=0), *limits)
    # scaled so that random states are of the size that short segments leave
    slow = replace(
        problem, limits=replace(problem.limits, velocity=np.full(dof, 10.0 ** (step * 2 / 3)))
    )
    for raw in (stopping(problem), through_states(slow, rng)):
        motion = exact(problem, raw)
        if not check(problem, motion).feasible:
            continue
        boxes = around(problem, np.diff(motion.passage_times), width)
        a = motion.at(motion.passage_times, 2)
        a[[0, -1]] = 0.0
        size = 1e-9 * np.abs(boxes.accelerations).max()
        assert not boxes.empty
        assert (boxes.accelerations[..., 0] <= a + size).all()
        assert (a <= boxes.accelerations[..., 1] + size).all()


def steepest(d: float, e: float, T: float, U: float, J: float, n: int = 60) -> float:
    """Greatest acceleration where two segments of fixed durations meet, by jerks constant on a grid.

    Unknowns: v, a at the waypoint, and jerks in n steps after and, with time reversed, before it.
    """

    def covered(length: float) -> Array:
        h = length / n
        start = h * np.arange(n)
        return ((length - start) ** 3 - (length - start - h) ** 3) / 6.0

    none = np.zeros(n)
    rows = [[U, U**2 / 2.0, *covered(U), *none], [T, -(T**2) / 2.0, *none, *covered(T)]]
    bounds = [(None, None), (None, None), *[(-J, J)] * (2 * n)]
    found = linprog([0.0, -1.0, *none, *none], A_eq=rows, b_eq=[e, d], bounds=bounds)
    assert found.status == 0
    return float(found.x[1])


@pytest.mark.parametrize("seed", range(6))
def test_the_box_of_fixed_durations_is_the_steepest_motion(seed: int) -> None:
    rng = np.random.default_rng(seed)
    d, e = rng.uniform(-1.0, 1.0, 2)
    T, U, J = *rng.uniform(0.5, 2.0, 2), 30.0
    problem = problem_of([[0.0], [0.5], [0.5 + d], [0.5 + d + e], [0.2]], 1e3, 1e4, J)
    durations = np.array([3.0, T, U, 3.0])
    box = around(problem, durations, 1.0).accelerations[2, 0]
    assert box[1] == pytest.approx(steepest(d, e, T, U, J), rel=1e-9)
    assert box[0] == pytest.approx(-steepest(-d, -e, T, U, J), rel=1e-9)
    # a wide box holds those of all durations in it
    wide = around(problem, durations, 1.3).accelerations[2, 0]
    for _ in range(10):
        T_, U_ = np.array([T, U]) * 1.3 ** rng.uniform(-1.0, 1.0, 2)
        assert wide[0] <= -steepest(-d, -e, T_, U_, J)
        assert steepest(d, e, T_, U_, J) <= wide[1]


@given(
    ways=st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)),
    low=st.tuples(st.floats(0.1, 2.0), st.floats(0.1, 2.0)),
    wider=st.tuples(st.floats(1.0, 9.0), st.floats(1.0, 9.0)),
)
@settings(max_examples=60, deadline=None)
def test_the_checker_derives_the_same_box(
    ways: tuple[float, float], low: tuple[float, float], wider: tuple[float, float]
) -> None:
    (d, e), J = ways, 7.0
    durations = np.array([low, np.multiply(low, wider)]).T
    ours = propagation._upper_sides(np.array([[d]]), np.array([[e]]), np.array([[J], [J]]), durations)[
        0, 0
    ]
    T, U = ((R(float(a)), R(float(b))) for a, b in durations)
    theirs = float(accelerations.greatest(R(d), R(e), (R(J), R(J)), accelerations.weights(T, U)))
    size = J + max(abs(d), abs(e)) / min(low) ** 2
    assert theirs <= ours <= theirs + 1e-13 * size


@pytest.mark.parametrize("factor", [1.0, 0.9])
def test_a_jerk_term_too_small_loses_a_motion(monkeypatch: pytest.MonkeyPatch, factor: float) -> None:
    """The fault that the tests above must notice: with it the steepest motion is outside its box."""
    true = propagation._upper_sides
    monkeypatch.setattr(propagation, "_upper_sides", lambda d, e, J, T: true(d, e, factor * J, T))
    problem = problem_of([[0.0], [1.0], [0.0], [1.0]], 1e3, 1e4, 30.0)
    durations = np.array([1.0, 1.2, 1.0])
    lost = (
        around(problem, durations, 1.0).accelerations[1, 0, 1]
        < steepest(1.0, -1.0, 1.0, 1.2, 30.0) - 1e-9
    )
    assert lost == (factor < 1.0)


@pytest.mark.long
def test_the_checker_refuses_a_proof_with_boxes_too_narrow(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = problem_of([[0.0], [0.7], [0.9], [0.1]], 1e6, 1e6, 1.0)
    honest = free_form_bound(problem, gap=1e-3, time_limit=10.0, record=True)
    assert "takes" in verify(honest.certificate)
    true = propagation._upper_sides
    monkeypatch.setattr(propagation, "_upper_sides", lambda d, e, J, T: true(d, e, 0.3 * J, T))
    wrong = free_form_bound(problem, gap=1e-3, upper=honest.upper, time_limit=10.0, record=True)
    assert wrong.seconds > honest.upper  # a bound above a verified motion
    with pytest.raises(Refused):
        verify(wrong.certificate)


def test_one_joint_that_turns_once_is_known_exactly() -> None:
    """There and back with jerk alone: jerk J, then -J until the joint is back at rest but for a, and again.

    In unit time v = 0 at the end of J on [0, p] and -J on [p, 1] where 2 p^2 - 4 p + 1 = 0. The way is then
    J (1 - 2 (1 - p)^3) / 6.
    """
    step, J = 1e-6, 50.0
    p = 1.0 - math.sqrt(0.5)
    half = (step / (J * (1.0 - 2.0 * (1.0 - p) ** 3) / 6.0)) ** (1.0 / 3.0)
    bound = free_form_bound(problem_of([[0.0], [step], [0.0]], 1e3, 1e4, J), gap=1e-4, time_limit=20.0)
    assert 2.0 * half * (1.0 - 1.1e-4) <= bound.seconds <= 2.0 * half * (1.0 + 1e-9)


@pytest.mark.parametrize("step", [0.1, 1e-3, 1e-6])
def test_with_jerk_alone_time_is_the_cube_root_of_the_size(step: float) -> None:
    """And the gap closes whatever the size."""
    shape = np.array([[0.0, 0.0], [1.0, -0.4], [0.3, 0.5]])
    unit = free_form(problem_of(shape, 1e4, 1e6, 50.0), tolerance=1e-6).seconds
    scaled = problem_of(step * shape, 1e3, 1e5, 50.0)
    found = free_form(scaled, tolerance=1e-6).seconds
    assert found == pytest.approx(unit * step ** (1.0 / 3.0), rel=1e-5)
    bound = free_form_bound(scaled, gap=1e-4, upper=found, time_limit=60.0)
    assert bound.gap is not None
    assert bound.gap <= 1e-4


@pytest.mark.long
@given(
    seed=st.integers(0, 10**6),
    step=st.floats(-6.0, -1.0),
    n=st.integers(1, 7),
    dof=st.integers(1, 6),
    jerk=st.sampled_from([5.0, 50.0, 5e4]),
)
@settings(max_examples=12, deadline=None)
def test_no_verified_motion_is_faster_than_the_bound(
    seed: int, step: float, n: int, dof: int, jerk: float
) -> None:
    """Short segments, where jerk is the only limit that counts and where it is one of three."""
    rng = np.random.default_rng(seed)
    steps = 10.0**step * rng.uniform(0.1, 1.0, (n, dof)) * rng.choice([-1.0, 1.0], (n, dof))
    problem = problem_of(np.cumsum(np.vstack([np.zeros(dof), steps]), axis=0), 0.5, 2.0, jerk)
    found = free_form(problem, tolerance=1e-5)
    bound = free_form_bound(problem, gap=1e-4, upper=found.seconds, time_limit=1.0)
    motions = [found.trajectory, stopping(problem)]
    motions += [splined(problem, family, rng) for family in ("quintic", "b-spline-5")]
    for motion in motions:
        assert motion is not None
        verdict = check(problem, motion)
        assert not verdict.feasible or bound.least_verified <= verdict.seconds


@pytest.mark.parametrize("size", [1e-130, 1e-100, 1e-60, 1e60, 1e130])
def test_numbers_that_underflow_or_overflow_lose_no_motion(size: float) -> None:
    """The steepest acceleration of two equal segments is J T / 3 + (e - d) / T^2, whatever the unit."""
    T = size ** (1.0 / 3.0)
    durations = np.array([[T, T], [T, T]])
    with np.errstate(all="ignore"):
        top = propagation._upper_sides(
            np.array([[size]]), np.array([[-size]]), np.full((2, 1), 30.0), durations
        )[0, 0]
    assert not top < (-2.0 + 10.0) * T * (1.0 - 1e-13)
