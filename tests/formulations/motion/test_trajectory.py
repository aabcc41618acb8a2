"""Exact extremes, and the check that judges every number: what it must find, and what it must not."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from conftest import Array, durations, powers_of_ten, problems
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from formulations import FAMILIES, InputError, Limits, Problem, Trajectory, check, load

SAMPLES = np.linspace(0.0, 1.0, 20_001)
HERMITE = np.array([0.0, 0.0, 0.0, 10.0, -15.0, 6.0])  # 0 to 1, rest to rest, in 1 s
HERMITE_PEAKS = (15.0 / 8.0, 10.0 / math.sqrt(3.0), 60.0)
THIRD = 0.5 - math.sqrt(3.0) / 6.0  # where its acceleration peaks


def one_piece(*coefficients: float, duration: float = 1.0) -> Trajectory:
    """One joint, one polynomial in local time."""
    return Trajectory(np.array([duration]), np.array([[coefficients]], dtype=np.float64))


def rest_to_rest(waypoints: Array, times: Array) -> Trajectory:
    """Quintics that rest at every waypoint."""
    steps = np.diff(waypoints, axis=0)
    powers = times[:, None, None] ** np.arange(6)
    coefficients = steps[:, :, None] * HERMITE / powers
    coefficients[:, :, 0] = waypoints[:-1]
    return Trajectory(times, coefficients)


def at(c: Array, order: int) -> Array:
    """Samples (..., SAMPLES) of a derivative of ascending coefficients on [0, 1]."""
    for _ in range(order):
        c = c[..., 1:] * np.arange(1, c.shape[-1]) if c.shape[-1] > 1 else np.zeros_like(c)
    return np.asarray(np.polynomial.polynomial.polyval(SAMPLES, np.moveaxis(c, -1, 0)))


# --- exact extremes: closed forms -----------------------------------------------------------------


@pytest.mark.parametrize("duration", [1e-3, 1.0, 17.0])
def test_the_rest_to_rest_quintic_has_its_textbook_extremes(duration: float) -> None:
    motion = rest_to_rest(np.array([[0.0], [2.0]]), np.array([duration]))
    velocity, acceleration, jerk = (motion.extremes(order) for order in (1, 2, 3))
    peaks = [2.0 * peak / duration**order for order, peak in enumerate(HERMITE_PEAKS, 1)]
    assert velocity.high[0, 0] == pytest.approx(peaks[0], rel=1e-14)
    assert velocity.time_high[0, 0] == pytest.approx(duration / 2.0, rel=1e-7)
    assert velocity.low[0, 0] == pytest.approx(0.0, abs=1e-14 * peaks[0])
    assert acceleration.high[0, 0] == pytest.approx(peaks[1], rel=1e-14)
    assert acceleration.low[0, 0] == pytest.approx(-peaks[1], rel=1e-13)
    assert acceleration.time_high[0, 0] == pytest.approx(duration * THIRD, rel=1e-7)
    assert acceleration.time_low[0, 0] == pytest.approx(duration * (1.0 - THIRD), rel=1e-7)
    assert jerk.high[0, 0] == pytest.approx(peaks[2], rel=1e-13)
    assert jerk.low[0, 0] == pytest.approx(-peaks[2] / 2.0, rel=1e-13)
    assert jerk.time_low[0, 0] == pytest.approx(duration / 2.0, rel=1e-7)
    position = motion.extremes(0)
    assert position.low[0, 0] == pytest.approx(0.0, abs=1e-15)
    assert position.high[0, 0] == pytest.approx(2.0, rel=1e-14)


@pytest.mark.parametrize("degree", range(1, 8))
def test_chebyshev_polynomials_swing_between_minus_one_and_one(degree: int) -> None:
    shifted = np.polynomial.Chebyshev.basis(degree, domain=[0.0, 3.0])
    c = shifted.convert(kind=np.polynomial.Polynomial, domain=[-1, 1], window=[-1, 1]).coef
    found = one_piece(*c, duration=3.0).extremes(0)
    assert found.high[0, 0] == pytest.approx(1.0, abs=1e-11)
    assert found.low[0, 0] == pytest.approx(-1.0, abs=1e-11)
    for time, value in ((found.time_high, 1.0), (found.time_low, -1.0)):
        assert shifted(time[0, 0]) == pytest.approx(value, abs=1e-11)


def test_extremes_are_told_apart_by_piece_and_joint() -> None:
    waypoints = np.array([[0.0, 0.0], [1.0, -3.0], [1.0, 5.0]])
    times = np.array([2.0, 0.5])
    found = rest_to_rest(waypoints, times).extremes(1)
    expected = 15.0 / 8.0 * np.diff(waypoints, axis=0) / times[:, None]
    np.testing.assert_allclose(found.high, np.maximum(expected, 0.0), atol=1e-14)
    np.testing.assert_allclose(found.low, np.minimum(expected, 0.0), atol=1e-14)
    assert found.time_low[0, 1] == pytest.approx(1.0)
    assert found.time_high[1, 1] == pytest.approx(2.25)


def test_derivatives_beyond_the_degree_are_zero() -> None:
    for coefficients in ((3.0,), (3.0, 2.0), (3.0, 2.0, 1.0)):
        found = one_piece(*coefficients).extremes(3)
        assert found.low[0, 0] == 0.0
        assert found.high[0, 0] == 0.0


# --- exact extremes: against dense samples, whatever the polynomial -------------------------------

COEFFICIENTS = st.one_of(
    st.floats(-10.0, 10.0),
    st.sampled_from([0.0, 1.0, -1.0, 1e-14, -1e-14, 3e-15, 1e-16, 1e-300]),
)


@st.composite
def polynomials(draw: st.DrawFn) -> Array:
    """Coefficients of degree 1 to 7: any, with leading dust, zero, or with chosen double roots."""
    kind = draw(st.sampled_from(["any", "dust", "zero", "turns"]))
    degree = draw(st.integers(1, 7))
    c = np.zeros(8)
    if kind == "turns":
        # a derivative with chosen roots, often twice the same and at the very ends
        roots = draw(st.lists(st.sampled_from([0.0, 0.25, 0.3, 0.5, 1.0, 1.5]), max_size=degree - 1))
        p = np.polynomial.Polynomial.fromroots(roots).integ() if roots else [0.0, 1.0]
        c[: len(np.atleast_1d(getattr(p, "coef", p)))] = getattr(p, "coef", p)
        return c * draw(st.sampled_from([1.0, -20.0, 1e-9]))
    if kind != "zero":
        c[: degree + 1] = draw(st.lists(COEFFICIENTS, min_size=degree + 1, max_size=degree + 1))
    if kind == "dust":
        c[degree] = draw(st.sampled_from([1e-14, -1e-14, 1e-13, -3e-15, 1e-15, 1e-16]))
    return c


@given(
    rows=st.lists(polynomials(), min_size=1, max_size=4),
    duration=powers_of_ten(-2.0, 2.0),
    order=st.integers(0, 3),
)
@settings(max_examples=300)
def test_extremes_agree_with_dense_samples(rows: list[Array], duration: float, order: int) -> None:
    c = np.array(rows)[None]
    motion = Trajectory(np.array([duration]), c / duration ** np.arange(8))
    found = motion.extremes(order)
    values = at(c[0], order) / duration**order
    size = np.abs(c[0]).sum(axis=-1) * 7.0**order / duration**order + 1e-290
    high, low = values.max(axis=-1), values.min(axis=-1)
    assert (found.high[0] >= high - 1e-14 * size).all()
    assert (found.low[0] <= low + 1e-14 * size).all()
    # samples lie within curvature * step^2 / 8 of the extremes
    assert (found.high[0] <= high + 1e-7 * size).all()
    assert (found.low[0] >= low - 1e-7 * size).all()
    # and they occur when they are said to
    for value, time in ((found.high, found.time_high), (found.low, found.time_low)):
        assert ((time >= 0.0) & (time <= duration * (1.0 + 1e-15))).all()
        for joint in range(len(rows)):
            there = motion.at(min(time[0, joint], duration), order)[joint]
            assert there == pytest.approx(value[0, joint], rel=1e-9, abs=1e-9 * size[joint])


@given(
    inside=st.lists(st.floats(0.02, 0.98), min_size=1, max_size=3),
    far=powers_of_ten(1.0, 15.0),
    sign=st.sampled_from([-1.0, 1.0]),
)
@settings(max_examples=200)
def test_turning_points_are_found_beside_a_root_that_is_far_away(
    inside: list[float], far: float, sign: float
) -> None:
    """A factor 1 - s / far leaves a leading coefficient of 1 / far: tiny, but not to be trusted."""
    gaps = np.diff(sorted(inside))
    assume(len(gaps) == 0 or gaps.min() > 0.01)
    slope = np.polynomial.Polynomial.fromroots(inside) * np.polynomial.Polynomial([1.0, -sign / far])
    p = slope.integ()
    found = one_piece(*p.coef).extremes(0)
    values = p(np.array([0.0, 1.0, *inside]))
    assert found.high[0, 0] == pytest.approx(values.max(), abs=1e-12)
    assert found.low[0, 0] == pytest.approx(values.min(), abs=1e-12)


@given(
    rows=st.lists(polynomials(), min_size=6, max_size=6),
    times=durations(3, -1.0, 1.0),
)
def test_pieces_of_unlike_degrees_do_not_disturb_each_other(rows: list[Array], times: Array) -> None:
    c = np.array(rows).reshape(3, 2, 8) / times[:, None, None] ** np.arange(8)
    together = Trajectory(times, c)
    for order in range(4):
        found = together.extremes(order)
        for piece in range(3):
            for joint in range(2):
                alone = Trajectory(times[piece : piece + 1], c[piece : piece + 1, joint : joint + 1])
                one = alone.extremes(order)
                size = float(np.abs(rows[2 * piece + joint]).sum()) * (7.0 / times[piece]) ** order
                for a, b in ((found.low, one.low), (found.high, one.high)):
                    assert a[piece, joint] == pytest.approx(b[0, 0], rel=1e-12, abs=1e-13 * size)


# --- a motion that is right -----------------------------------------------------------------------


@given(problem=problems(segments=st.integers(1, 5), reach=(-4.0, 2.0)), data=st.data())
def test_a_motion_stretched_by_its_verdict_is_feasible_and_no_slower_than_needed(
    problem: Problem, data: st.DataObject
) -> None:
    times = data.draw(durations(problem.n_segments, -2.0, 2.0))
    motion = rest_to_rest(problem.waypoints, times)
    verdict = check(problem, motion)
    d = np.abs(problem.displacements)
    ratios = [
        (HERMITE_PEAKS[order - 1] * d / times[:, None] ** order / limit) ** (1.0 / order)
        for order, limit in enumerate(problem.limits.derivatives, 1)
    ]
    assert verdict.stretch == pytest.approx(np.max(ratios), rel=1e-9)
    if not problem.moving_joints:
        assert verdict.stretch == 0.0
        assert verdict.feasible
        return
    fitted = check(problem, motion.stretched(verdict.stretch))
    assert fitted.faults == ()
    assert fitted.feasible
    assert fitted.stretch == pytest.approx(1.0, rel=1e-12)
    assert fitted.worst is not None
    assert fitted.worst.factor == pytest.approx(1.0, rel=1e-11)
    assert fitted.seconds == pytest.approx(times.sum() * verdict.stretch, rel=1e-13)
    faster = check(problem, motion.stretched(verdict.stretch * (1.0 - 1e-7)))
    assert not faster.feasible
    assert all("over the limit" in fault for fault in faster.faults)


@pytest.mark.parametrize("family", list(FAMILIES))
@given(data=st.data())
def test_the_check_and_the_families_agree_on_the_stretch(family: str, data: st.DataObject) -> None:
    """Two ways to the same number that share no code."""
    segments = 3 if family == "3-5-3" else data.draw(st.integers(2, 6))
    problem = data.draw(problems(segments=segments, family=family, reach=(-4.0, 2.0)))
    # between durations far apart a B-spline swings out to 1e7 times its waypoints, which it then
    # passes to within the rounding of the swing, not of the waypoints
    wide = 1.0 if family.startswith("b-spline") else 2.0
    times = data.draw(durations(segments, -wide, wide))
    chosen = FAMILIES[family]
    stretch = float(chosen.stretch(problem, times[None])[0])
    assert check(problem, chosen.trajectory(problem, times)).stretch == pytest.approx(stretch, rel=1e-9)
    if stretch > 0.0:
        verdict = check(problem, chosen.trajectory(problem, times * stretch))
        assert verdict.feasible, verdict.faults


def test_peaks_are_sorted_worst_first() -> None:
    problem = Problem.of([[0.0], [1.0]], Limits.of(10.0, 1.0, 1e5, dof=1))
    verdict = check(problem, rest_to_rest(problem.waypoints, np.array([1.0])))
    assert [peak.quantity for peak in verdict.peaks] == ["acceleration", "velocity", "jerk"]
    assert verdict.worst is verdict.peaks[0]
    assert verdict.peaks[0].stretch == pytest.approx(math.sqrt(10.0 / math.sqrt(3.0)))


def test_a_motion_without_any_limit_in_force_has_no_worst_peak_but_passes() -> None:
    problem = Problem.of([[1.0], [1.0]], Limits.of(1.0, dof=1))
    verdict = check(problem, rest_to_rest(problem.waypoints, np.array([1.0])))
    assert verdict.feasible
    assert verdict.stretch == 0.0


# --- planted faults -------------------------------------------------------------------------------

WAYPOINTS = np.array([[0.0, 0.2], [0.5, -0.3], [0.9, 0.4], [2.0, 0.1]])
TIMES = np.array([1.0, 1.5, 1.2])
WIDE = {"velocity": 50.0, "acceleration": 500.0}


def problem_of(jerk: float = np.inf, waypoints: Array = WAYPOINTS) -> Problem:
    return Problem.of(waypoints, Limits.of(**WIDE, jerk=jerk, dof=2))


def spline() -> Trajectory:
    return FAMILIES["3-5-3"].trajectory(problem_of(), TIMES)


def bumped(motion: Trajectory, piece: int, joint: int, bump: np.polynomial.Polynomial) -> Trajectory:
    """A motion plus a polynomial of local time on one piece of one joint."""
    c = motion.coefficients.copy()
    c[piece, joint, : len(bump.coef)] += bump.coef
    return replace(motion, coefficients=c)


def kick(order: int, size: float, duration: float) -> np.polynomial.Polynomial:
    """A bump whose derivative of one order is ``size`` at its start; all else is zero at both ends."""
    t = np.polynomial.Polynomial([0.0, 1.0])
    rest = 1.0 - t / duration
    if order == 0:
        s = t / duration
        return size * rest**3 * (1.0 + 3.0 * s + 6.0 * s**2)
    if order == 1:
        return size * t * rest**3 * (1.0 + 3.0 * t / duration)
    return 0.5 * size * t**2 * rest**3


def test_the_motion_without_a_fault_passes() -> None:
    for jerk in (np.inf, 1e4):
        verdict = check(problem_of(jerk), spline())
        assert verdict.faults == ()
        assert verdict.feasible


@pytest.mark.parametrize("row", range(4))
@pytest.mark.parametrize("joint", range(2))
def test_a_missed_waypoint_is_named(row: int, joint: int) -> None:
    moved = WAYPOINTS.copy()
    moved[row, joint] += 1e-6
    verdict = check(problem_of(waypoints=moved), spline())
    assert not verdict.feasible
    assert verdict.faults == (f"misses waypoint {row + 1}, joint {joint + 1} by 1e-06 rad",)


def test_a_waypoint_count_that_differs_is_a_fault() -> None:
    problem = problem_of(waypoints=WAYPOINTS[:3])
    verdict = check(problem, spline())
    assert not verdict.feasible
    assert "4 passage times for 3 waypoints" in verdict.faults[0]


def test_a_jump_of_position_is_found() -> None:
    verdict = check(problem_of(), bumped(spline(), 1, 1, kick(0, 1e-5, TIMES[1])))
    assert not verdict.feasible
    assert any("position of joint 2 jumps by 1e-05" in fault for fault in verdict.faults)


@pytest.mark.parametrize("piece", [1, 2])
@pytest.mark.parametrize("joint", [0, 1])
def test_a_jump_of_velocity_at_a_knot_is_found(piece: int, joint: int) -> None:
    motion = bumped(spline(), piece, joint, kick(1, 1e-5, TIMES[piece]))
    verdict = check(problem_of(), motion)
    assert not verdict.feasible
    assert verdict.faults == (f"velocity of joint {joint + 1} jumps by 1e-05",)


@pytest.mark.parametrize("piece", [1, 2])
def test_a_jump_of_acceleration_is_found_where_jerk_is_limited_and_accepted_where_not(
    piece: int,
) -> None:
    motion = bumped(spline(), piece, 1, kick(2, 1e-3, TIMES[piece]))
    verdict = check(problem_of(jerk=1e4), motion)
    assert not verdict.feasible
    assert verdict.faults == ("acceleration of joint 2 jumps by 0.001",)
    assert check(problem_of(), motion).feasible


def test_a_jump_of_acceleration_is_found_where_jerk_alone_is_limited() -> None:
    """Full throttle, full brake: feasible without a jerk limit, infinitely jerky with one."""
    motion = Trajectory(np.array([1.0, 1.0]), np.array([[[0.0, 0.0, 0.5]], [[0.5, 1.0, -0.5]]]))
    motion = replace(motion, passages=np.array([0.0, 2.0]))
    for limits, feasible in (
        (Limits.of(2.0, 2.0, dof=1), True),
        (Limits.of(2.0, 2.0, 1e3, dof=1), False),
        (Limits.of(2.0, np.inf, 1e3, dof=1), False),
    ):
        verdict = check(Problem.of([[0.0], [1.0]], limits), motion)
        assert verdict.feasible is feasible
        if not feasible:
            assert "acceleration of joint 1 jumps by 2" in verdict.faults
            assert "acceleration of joint 1 is 1 at an end" in verdict.faults


def test_a_jump_is_blamed_on_the_joint_it_is_forbidden_to() -> None:
    """Joint 1 has no jerk limit and may jump by more."""
    motion = bumped(spline(), 1, 0, kick(2, 5e-3, TIMES[1]))
    motion = bumped(motion, 1, 1, kick(2, 1e-3, TIMES[1]))
    limits = Limits.of(50.0, 500.0, [np.inf, 1e4], dof=2)
    verdict = check(Problem.of(WAYPOINTS, limits), motion)
    assert verdict.faults == ("acceleration of joint 2 jumps by 0.001",)


def test_a_jump_of_velocity_is_found_without_a_velocity_limit() -> None:
    try:
        limits = Limits.of(np.inf, 5.0, dof=1)
    except InputError:
        return  # then nothing can be unlimited in velocity
    assert judged_infeasible(Problem.of([[0.0], [1.0]], limits), one_piece(0.0, 1.0))


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize("joint", [0, 1])
def test_a_motion_that_does_not_rest_at_an_end_is_found(end: str, joint: int) -> None:
    for order, jerk in ((1, np.inf), (2, 1e4)):
        piece = 0 if end == "start" else 2
        bump = kick(order, 1e-3, TIMES[piece])
        if end == "end":
            bump = bump(np.polynomial.Polynomial([TIMES[piece], -1.0]))
        motion = bumped(spline(), piece, joint, bump)
        verdict = check(problem_of(jerk), motion)
        name = ("", "velocity", "acceleration")[order]
        assert not verdict.feasible
        assert verdict.faults == (f"{name} of joint {joint + 1} is 0.001 at an end",)
        if order == 2:  # without a jerk limit the acceleration is free to jump from rest
            assert check(problem_of(), motion).feasible


def three_joints(joint: int, segment: int) -> tuple[Array, Array, Trajectory]:
    """A motion whose chosen joint moves most, and most in the chosen segment."""
    times = np.array([0.8, 1.0, 1.3, 0.9])
    steps = np.full((4, 3), 0.2)
    steps[segment, joint] = -1.0
    steps *= times[:, None] ** 3  # no segment is quicker than another but by its step
    waypoints = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    return times, waypoints, rest_to_rest(waypoints, times)


@pytest.mark.parametrize("segment", range(4))
@pytest.mark.parametrize("joint", range(3))
@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_limit_broken_by_a_millionth_is_named_with_joint_segment_time_and_factor(
    order: int, joint: int, segment: int
) -> None:
    times, waypoints, motion = three_joints(joint, segment)
    step, time = abs(waypoints[segment + 1, joint] - waypoints[segment, joint]), times[segment]
    limits = [np.full(3, 1e4) for _ in range(3)]
    peak = HERMITE_PEAKS[order - 1] * step / time**order
    for factor, feasible in ((1.0 + 1e-6, False), (1.0 + 1e-12, True), (1.0 - 1e-6, True)):
        limits[order - 1][joint] = peak / factor
        problem = Problem.of(waypoints, Limits.of(*limits, dof=3))
        verdict = check(problem, motion)
        assert verdict.stretch == pytest.approx(factor ** (1.0 / order), rel=1e-12)
        assert verdict.feasible is feasible, verdict.faults
        worst = verdict.worst
        assert worst is not None
        assert worst.quantity == ("velocity", "acceleration", "jerk")[order - 1]
        assert (worst.joint, worst.segment) == (joint, segment)
        assert worst.factor == pytest.approx(factor, rel=1e-12)
        assert abs(worst.value) == pytest.approx(peak, rel=1e-12)
        assert worst.limit == peak / factor
        places = {1: [0.5], 2: [THIRD, 1.0 - THIRD], 3: [0.0, 1.0]}[order]
        local = (worst.time - times[:segment].sum()) / time
        assert min(abs(local - place) for place in places) < 1e-6
        if not feasible:
            assert len(verdict.faults) == 1
            assert f"joint {joint + 1} in segment {segment + 1}" in verdict.faults[0]
            assert "over the limit" in verdict.faults[0]


# --- violations between samples -------------------------------------------------------------------


def sampled_velocity(motion: Trajectory, per_segment: int = 100) -> float:
    """What a check by samples sees, as the papers make it."""
    times = motion.passage_times
    grid = [np.linspace(a, b, per_segment) for a, b in pairwise(times)]
    return float(np.abs(motion.at(np.concatenate(grid), 1)).max())


def test_a_peak_between_samples_is_found() -> None:
    """The quintic's 15/8 lies at the middle of a segment, where no sample of a hundred falls."""
    motion = rest_to_rest(np.array([[0.0], [1.0]]), np.array([1.0]))
    limit = 15.0 / 8.0 * (1.0 - 1e-4)
    assert sampled_velocity(motion) < limit
    verdict = check(Problem.of([[0.0], [1.0]], Limits.of(limit, dof=1)), motion)
    assert not verdict.feasible
    assert verdict.worst is not None
    assert verdict.worst.time == pytest.approx(0.5, abs=1e-7)
    assert verdict.worst.factor == pytest.approx(1.0 / (1.0 - 1e-4), rel=1e-12)


def test_a_narrow_spike_of_velocity_between_samples_is_found() -> None:
    """Cruise at 1 rad/s with a hat of 0.3 rad/s and 2 ms, between the samples 1/99 s apart."""
    width = 1e-3
    before = 49.5 / 99.0 - width  # the middle of a gap in a segment of one second
    durations = np.array([1.0, before, width, width, 1.0 - before - 2.0 * width, 1.0])
    pieces = [
        [0.0, 0.0, 1.5, -2.0 / 3.0],  # velocity 3 t - 2 t^2: 0 to 1
        [0.0, 1.0],
        [0.0, 1.0, 0.15 / width],
        [0.0, 1.3, -0.15 / width],
        [0.0, 1.0],
        [0.0, 1.0, 0.5, -2.0 / 3.0],  # velocity 1 + t - 2 t^2: 1 to 0
    ]
    c = np.zeros((6, 1, 4))
    position = 0.0
    for k, (piece, h) in enumerate(zip(pieces, durations, strict=True)):
        c[k, 0, : len(piece)] = piece
        c[k, 0, 0] = position
        position = float(np.polynomial.polynomial.polyval(h, c[k, 0]))
    breaks = np.concatenate([[0.0], np.cumsum(durations)])
    motion = Trajectory(durations, c, breaks[[0, 1, 5, 6]])
    waypoints = motion.at(motion.passage_times)
    limit = 1.2
    assert sampled_velocity(motion) < limit
    verdict = check(Problem.of(waypoints, Limits.of(limit, dof=1)), motion)
    assert not verdict.feasible
    worst = verdict.worst
    assert worst is not None
    assert (worst.quantity, worst.joint, worst.segment) == ("velocity", 0, 1)
    assert worst.time == pytest.approx(1.5, abs=1e-9)
    assert worst.value == pytest.approx(1.3, rel=1e-12)
    assert len(verdict.faults) == 1
    # it is the spike alone that is wrong
    assert check(Problem.of(waypoints, Limits.of(1.3001, dof=1)), motion).feasible


# --- position limits ------------------------------------------------------------------------------


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_swing_beyond_the_position_limits_between_waypoints_is_found(side: float) -> None:
    """0 to 1 to 1 to 0 overshoots: x = 1 + 3 s (1 - s) + ... between the middle waypoints."""
    points = side * np.array([[0.0], [1.0], [1.0], [0.0]])
    times = np.ones(3)
    free = Problem.of(points, Limits.of(100.0, dof=1))
    motion = FAMILIES["3-5-3"].trajectory(free, times)
    top = float(np.abs(at(motion.coefficients[1, 0], 0)).max())
    assert top > 1.5
    for room, feasible in ((top - 1e-6, False), (top + 1e-6, True)):
        bounds = sorted([-side, side * room])
        problem = Problem.of(points, Limits.of(100.0, position=[bounds], dof=1))
        verdict = check(problem, motion)
        assert verdict.feasible is feasible
        assert verdict.position_kept is feasible
        assert verdict.stretch < 1.0  # the derivatives are kept either way
        assert not check(problem, motion.stretched(10.0)).feasible or feasible
        if not feasible:
            assert len(verdict.faults) == 1
            assert "position of joint 1 in segment 2" in verdict.faults[0]
            peak = next(peak for peak in verdict.peaks if peak.quantity == "position")
            assert peak.time == pytest.approx(1.5, abs=1e-6)
            assert peak.value == pytest.approx(side * top, rel=1e-7)
            assert peak.limit == pytest.approx(side * room, rel=1e-12)
            assert peak.factor > 1.0
            assert peak.stretch == math.inf


def test_a_joint_that_sits_on_its_limit_within_rounding_is_accepted() -> None:
    problem = load("sr4c")
    family = FAMILIES["3-5-3"]
    for times in ([1.5, 2.0, 1.2], [4.0, 4.0, 4.0], [0.3, 0.4, 0.2]):
        stretch = family.stretch(problem, np.array([times]))[0]
        verdict = check(problem, family.trajectory(problem, np.array(times) * stretch))
        assert verdict.faults == ()
        assert verdict.position_kept


def test_a_joint_that_dips_below_its_starting_limit_is_not_accepted() -> None:
    problem = load("sr4c")
    motion = FAMILIES["3-5-3"].trajectory(problem, [4.0, 4.0, 4.0])
    t = np.polynomial.Polynomial([0.0, 1.0])
    rise = problem.waypoints[1, 4] - problem.waypoints[0, 4]
    for size, kept in ((0.5, True), (2.0, False)):  # it starts as (rise - size) times a cube
        dip = -size * rise * (t / 4.0) ** 3 * (1.0 - t / 4.0) ** 2
        verdict = check(problem, bumped(motion, 0, 4, dip))
        assert verdict.position_kept is kept
        fault = any("position of joint 5 in segment 1" in fault for fault in verdict.faults)
        assert fault is not kept


def test_position_limits_on_one_side_alone_are_judged_on_that_side() -> None:
    points = np.array([[0.0], [1.0], [1.0], [0.0]])
    motion = FAMILIES["3-5-3"].trajectory(Problem.of(points, Limits.of(100.0, dof=1)), np.ones(3))
    for bounds, feasible in (([-np.inf, 1.0], False), ([0.0, np.inf], True), ([-1.0, np.inf], True)):
        problem = Problem.of(points, Limits.of(100.0, position=[bounds], dof=1))
        assert check(problem, motion).feasible is feasible


# --- motions that are no motions ------------------------------------------------------------------


def judged_infeasible(problem: Problem, motion: Trajectory) -> bool:
    """Refused as input, or found wanting; anything but accepted."""
    try:
        verdict = check(problem, motion)
    except InputError:
        return True
    return not verdict.feasible


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("power", range(6))
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_coefficient_that_is_no_number_is_never_feasible(value: float, power: int) -> None:
    for piece in range(3):
        c = spline().coefficients.copy()
        c[piece, 1, power] = value
        try:
            motion = Trajectory(TIMES, c)
        except InputError:
            continue
        assert judged_infeasible(problem_of(), motion)
        assert judged_infeasible(problem_of(1e4), motion)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_passage_time_that_is_no_number_is_never_feasible() -> None:
    for value in (np.nan, np.inf):
        try:
            motion = replace(spline(), passages=np.array([0.0, 1.0, value, TIMES.sum()]))
        except InputError:
            continue
        assert judged_infeasible(problem_of(), motion)


def test_a_motion_that_goes_on_after_the_last_waypoint_is_never_feasible() -> None:
    """There and back again: it passes the last waypoint and ends elsewhere."""
    motion = rest_to_rest(np.array([[0.0], [1.0], [0.0]]), np.array([1.0, 1.0]))
    problem = Problem.of([[0.0], [1.0]], Limits.of(10.0, dof=1))
    assert judged_infeasible(problem, replace(motion, passages=np.array([0.0, 1.0])))
    assert judged_infeasible(
        Problem.of([[1.0], [0.0]], problem.limits), replace(motion, passages=np.array([1.0, 2.0]))
    )


def test_waypoints_passed_in_another_order_are_never_feasible() -> None:
    motion = rest_to_rest(np.array([[0.0], [1.0], [0.0]]), np.array([1.0, 1.0]))
    problem = Problem.of([[0.0], [1.0], [0.5], [0.0]], Limits.of(10.0, dof=1))
    assert check(problem, replace(motion, passages=np.array([0.0, 1.0, 1.5, 2.0]))).feasible
    assert judged_infeasible(problem, replace(motion, passages=np.array([0.0, 1.0, 0.5, 2.0])))


def test_waypoints_beyond_the_end_of_the_motion_are_never_passed() -> None:
    """t^3/2 - 3/4 t^2 rests at 0 and at 1 s, at -1/4; only at 2 s, were it to go on, is it 1."""
    motion = one_piece(0.0, 0.0, -0.75, 0.5)
    limits = Limits.of(10.0, dof=1)
    assert check(Problem.of([[0.0], [-0.25]], limits), motion).feasible
    beyond = replace(motion, passages=np.array([0.0, 2.0]))
    assert judged_infeasible(Problem.of([[0.0], [1.0]], limits), beyond)
    before = replace(motion, passages=np.array([-1.0, 1.0]))
    assert judged_infeasible(Problem.of([[-1.25], [-0.25]], limits), before)


def test_wrong_shapes_and_durations_are_refused() -> None:
    c = np.zeros((2, 1, 4))
    for times in ([1.0], [1.0, 0.0], [1.0, -1.0], [1.0, np.nan], [1.0, np.inf]):
        with pytest.raises(InputError, match="trajectory"):
            Trajectory(np.array(times), c)
    with pytest.raises(InputError, match="trajectory"):
        Trajectory(np.array([1.0, 1.0]), np.zeros((2, 4)))
    with pytest.raises(InputError, match="1 joints, the problem has 2"):
        check(problem_of(), Trajectory(np.array([1.0, 1.0]), c))


# --- stretching and sampling ----------------------------------------------------------------------


@given(times=durations(3, -1.0, 1.0), factor=powers_of_ten(-2.0, 2.0), passages=st.booleans())
def test_a_stretched_motion_is_the_same_path_at_another_pace(
    times: Array, factor: float, passages: bool
) -> None:
    motion = FAMILIES["3-5-3"].trajectory(problem_of(), times)
    if passages:
        motion = replace(motion, passages=motion.breaks[[0, 3]])
    slow = motion.stretched(factor)
    assert slow.seconds == pytest.approx(motion.seconds * factor, rel=1e-14)
    np.testing.assert_allclose(slow.passage_times, motion.passage_times * factor, rtol=1e-14)
    for order in range(4):
        for end in ("low", "high"):
            np.testing.assert_allclose(
                getattr(slow.extremes(order), end) * factor**order,
                getattr(motion.extremes(order), end),
                rtol=1e-10,
                atol=1e-12 * (1.0 + motion.extremes(order).high.max()),
            )
    t = np.linspace(0.0, motion.seconds, 57)
    np.testing.assert_allclose(slow.at(t * factor), motion.at(t), rtol=0.0, atol=1e-9)
    twice = slow.stretched(3.0)
    once = motion.stretched(3.0 * factor)
    np.testing.assert_allclose(twice.coefficients, once.coefficients, rtol=1e-12)
    np.testing.assert_allclose(twice.durations, once.durations, rtol=1e-14)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("factor", [0.0, -1.0, np.nan, np.inf])
def test_a_stretch_that_is_no_stretch_is_refused(factor: float) -> None:
    with pytest.raises(InputError):
        spline().stretched(factor)


@given(times=durations(3, -1.0, 0.5), rate=powers_of_ten(0.0, 3.0))
def test_samples_start_at_the_start_rise_and_end_at_the_end(times: Array, rate: float) -> None:
    motion = FAMILIES["3-5-3"].trajectory(problem_of(), times)
    t, values = motion.sample(rate)
    assert t[0] == 0.0
    assert t[-1] == motion.seconds
    assert (np.diff(t) > 0.0).all()
    assert np.diff(t).max() <= 1.0 / rate * (1.0 + 1e-9)
    assert values.shape == (4, len(t), 2)
    np.testing.assert_allclose(values[0, 0], WAYPOINTS[0], atol=1e-12)
    np.testing.assert_allclose(values[0, -1], WAYPOINTS[-1], atol=1e-12)
    for order in range(4):
        np.testing.assert_array_equal(values[order], motion.at(t, order))


def test_sampled_derivatives_are_those_of_the_samples() -> None:
    t, values = spline().sample(1e4)
    for order in range(3):
        slope = np.diff(values[order], axis=0) / np.diff(t)[:, None]
        middle = 0.5 * (values[order + 1, 1:] + values[order + 1, :-1])
        inner = slice(10, -10)
        away = np.abs(t[1:, None] - np.cumsum(TIMES)).min(axis=1)[inner] > 1e-3  # jerk jumps at knots
        assert np.abs(slope - middle)[inner][away].max() < 1e-3 * np.abs(values[order + 1]).max()


@pytest.mark.parametrize(
    ("seconds", "rate"), [(59.0 / 7.0, 7.0), (118.0 / 7.0, 7.0), (125.0 / 7.0, 7.0)]
)
def test_sample_times_never_repeat_where_the_end_is_a_multiple_of_the_step(
    seconds: float, rate: float
) -> None:
    motion = rest_to_rest(np.array([[0.0], [1.0]]), np.array([seconds]))
    t, _ = motion.sample(rate)
    assert t[-1] == seconds
    assert (np.diff(t) > 1e-9).all()


@pytest.mark.parametrize("rate", [0.0, -1.0, np.nan])
def test_a_rate_that_is_no_rate_is_refused(rate: float) -> None:
    with pytest.raises(InputError):
        spline().sample(rate)
