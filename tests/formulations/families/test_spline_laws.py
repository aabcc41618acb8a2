"""Laws that hold for every spline family, every problem and all durations."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import powers_of_ten
from hypothesis import given, settings
from hypothesis import strategies as st
from spline_oracles import (
    B_SPLINES,
    NAMES,
    at,
    candidates,
    degrees_of,
    derivative,
    pieces,
    rounding,
)

from formulations import FAMILIES, Limits, Problem, check


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
@settings(max_examples=150)
def test_splines_interpolate_are_c2_and_rest_at_both_ends(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family))
    lengths, c = pieces(problem, t)
    degrees = degrees_of(family, problem.n_segments)
    assert FAMILIES[family].degrees(problem.n_segments) == degrees
    assert len(c) == len(lengths) == len(degrees)
    for k, degree in enumerate(degrees):
        assert not c[k, :, degree + 1 :].any()
    if family in B_SPLINES:
        assert lengths.sum() == pytest.approx(t.sum(), rel=1e-14)
    else:
        np.testing.assert_array_equal(lengths, t)
    # the waypoints: breakpoints or, of B-splines, inside of the pieces
    passed = np.concatenate([[0.0], np.cumsum(t)])
    breaks = np.concatenate([[0.0], np.cumsum(lengths)])
    piece = np.searchsorted(breaks[1:-1], passed, side="right")
    if family not in B_SPLINES:
        piece = np.append(np.arange(len(t)), len(t) - 1)
        ends = c.sum(axis=-1)
        assert (np.abs(ends - problem.waypoints[1:]) <= 1e-13 * rounding(c)).all()
    s = (passed - breaks[piece]) / lengths[piece]
    found = np.stack([at(c[k], place)[:, 0] for k, place in zip(piece, s, strict=True)])
    # a spline through many knots passes each to within the rounding of its largest excursion
    size = rounding(c).max(axis=0) if family in B_SPLINES else rounding(c)[piece]
    assert (np.abs(found - problem.waypoints) <= 1e-13 * size).all()
    # coefficients are differences of terms as large as the piece's way, however small they come out
    way = rounding(c[..., 1:])
    for order in range(3):
        d = derivative(c, order)
        unit = lengths[:, None] ** order
        starts, ends = d[..., 0] / unit, d.sum(axis=-1) / unit
        # both sides carry the rounding of the whole chain of pieces
        allowed = 1e-13 * np.maximum(rounding(d), way) / unit
        whole = allowed.max(axis=0)
        assert (np.abs(ends[:-1] - starts[1:]) <= whole).all()
        if order > 0:
            assert (np.abs(starts[0]) <= whole).all()
            assert (np.abs(ends[-1]) <= whole).all()


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
def test_the_trajectory_is_the_same_spline_in_seconds(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family, -2.0, 2.0))
    lengths, c = pieces(problem, t)
    motion = FAMILIES[family].trajectory(problem, t)
    assert motion.seconds == pytest.approx(t.sum(), rel=1e-14)
    np.testing.assert_allclose(motion.passage_times, np.append(0.0, np.cumsum(t)), rtol=1e-14)
    assert motion.passage_times[-1] == motion.seconds
    starts = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    for s in (0.0, 0.2, 0.7):
        for order in range(4):
            unit = lengths[:, None] ** order
            expected = at(derivative(c, order), s)[..., 0] / unit
            allowed = 1e-11 * (rounding(derivative(c, order)) / unit + 1e-30)
            # reading at a time rounds it: one derivative more per rounding of the clock
            next_one = rounding(derivative(c, order + 1)) / (unit * lengths[:, None])
            allowed += 1e-13 * t.sum() * next_one
            found = motion.at(starts + (s + 1e-13) * lengths, order)
            assert (np.abs(found - expected) <= allowed).all()


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data(), factor=powers_of_ten(-3.0, 3.0))
def test_scaling_durations_divides_peaks_by_powers_of_the_factor(
    family: str, data: st.DataObject, factor: float
) -> None:
    problem, t = data.draw(candidates(family))
    peaks = FAMILIES[family].peaks(problem, np.stack([t, t * factor]))
    for order in (1, 2, 3):
        np.testing.assert_allclose(
            peaks[1, :, order - 1] * factor**order, peaks[0, :, order - 1], rtol=1e-9, atol=0.0
        )


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
def test_the_reversed_problem_has_the_mirrored_motion(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family, -1.5, 1.5, reach=(-3.0, 2.0)))
    mirror = Problem.of(problem.waypoints[::-1], problem.limits, family=family)
    there = FAMILIES[family].coefficients(problem, t[None])[0]
    back = FAMILIES[family].coefficients(mirror, t[None, ::-1])[0]
    s = np.linspace(0.0, 1.0, 101)
    for order in range(4):
        first, second = derivative(there, order), derivative(back, order)[::-1]
        np.testing.assert_allclose(
            at(first, s),
            (-1.0) ** order * at(second, 1.0 - s),
            rtol=0.0,
            atol=1e-11 * max(rounding(first).max(), 1e-300),
        )
    assert FAMILIES[family].stretch(mirror, t[None, ::-1])[0] == pytest.approx(
        FAMILIES[family].stretch(problem, t[None])[0], rel=1e-9
    )


@pytest.mark.parametrize("family", NAMES)
@pytest.mark.parametrize("tiny", [1e-3, 1e-6, 1e-9])
def test_a_vanishing_segment_is_as_exact_at_the_end_as_at_the_start(family: str, tiny: float) -> None:
    """Equal waypoints at an end pull their segment to nothing: no digits may go with it."""
    points = np.array([[0.0, 1.0], [1.0, 0.5], [1.5, 2.0], [1.5, 2.0]])
    t = np.array([[2.0, 3.0, tiny]])
    limits = Limits.of(1.0, 2.0, 5.0, dof=2)
    there, back = (Problem.of(x, limits, family=family) for x in (points, points[::-1]))
    chosen = FAMILIES[family]
    np.testing.assert_allclose(chosen.peaks(there, t), chosen.peaks(back, t[:, ::-1]), rtol=1e-9)
    assert check(there, chosen.trajectory(there, t[0] * chosen.stretch(there, t))).feasible


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
def test_the_sign_of_a_joint_does_not_matter(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family))
    flipped = Problem.of(-problem.waypoints, problem.limits, family=family)
    one, other = (FAMILIES[family].coefficients(p, t[None]) for p in (problem, flipped))
    np.testing.assert_array_equal(one, -other)
    np.testing.assert_array_equal(
        FAMILIES[family].peaks(problem, t[None]), FAMILIES[family].peaks(flipped, t[None])
    )
    assert FAMILIES[family].stretch(problem, t[None]) == FAMILIES[family].stretch(flipped, t[None])


# --- joints and waypoints that do not move --------------------------------------------------------


@pytest.mark.parametrize("family", NAMES)
@given(data=st.data())
def test_a_joint_that_never_moves_stays_put_and_costs_nothing(family: str, data: st.DataObject) -> None:
    problem, t = data.draw(candidates(family, max_dof=2))
    still = data.draw(st.floats(-3.0, 3.0))
    wide = Problem.of(
        np.column_stack([problem.waypoints, np.full(problem.n_segments + 1, still)]),
        Limits(
            *(np.append(row, 1e-6) for row in problem.limits.derivatives),
            np.vstack([problem.limits.position, [-np.inf, np.inf]]),
        ),
        family=family,
    )
    chosen = FAMILIES[family]
    c = chosen.coefficients(wide, t[None])[0, :, -1]
    assert (c[:, 0] == still).all()
    assert not c[:, 1:].any()
    assert not chosen.peaks(wide, t[None])[0, -1].any()
    assert chosen.stretch(wide, t[None])[0] == pytest.approx(
        chosen.stretch(problem, t[None])[0], rel=1e-13
    )


@pytest.mark.parametrize("family", NAMES)
def test_nothing_that_moves_needs_no_time(family: str) -> None:
    problem = Problem.of(np.full((4, 2), 0.3), Limits.of(1.0, 1.0, 1.0, dof=2), family=family)
    assert FAMILIES[family].stretch(problem, np.array([[1.0, 2.0, 3.0], [1e-9, 1e9, 1.0]])).max() == 0.0
