"""Rounding, propagated: digits, enclosures, peaks and proofs hold for every reading of the print."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from compare.audit.motion.minima import impossible, minimum
from compare.audit.motion.peaks import peaks
from compare.audit.motion.ranged import Ranged, Undecided
from compare.audit.paper.digits import printed
from formulations import FAMILIES, InputError, Limits, Problem, load


@given(
    st.lists(st.floats(0.1, 3.0), min_size=3, max_size=3),
    st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3),
    st.floats(1e-6, 1e-2),
)
def test_an_enclosure_holds_every_reading(centre: list[float], e: list[float], half: float) -> None:
    def formula(x, y, z):
        return 3.0 * (x - y * z) / (x + z) * y - 2.0 / z + (1.5 - x) * (-y)

    enclosed = formula(*(Ranged.printed(c, half, i, 3) for i, c in enumerate(centre)))
    value = formula(*(c + half * d for c, d in zip(centre, e, strict=True)))
    assert enclosed.lo <= value <= enclosed.hi
    assert enclosed.value[0] <= formula(*centre) <= enclosed.value[1]
    # and is sharp to first order: the corners reach nearly as far
    corners = [
        formula(*(c + half * s for c, s in zip(centre, signs, strict=True)))
        for signs in np.ndindex(2, 2, 2)
        for signs in [2 * np.array(signs) - 1]
    ]
    assert enclosed.hi - max(corners) <= 1e3 * half**2 * (1.0 + max(abs(v) for v in corners))


def test_what_the_digits_leave_open_is_not_decided() -> None:
    x = Ranged.printed(0.1, 0.2, 0, 1)
    with pytest.raises(Undecided):
        1.0 / x
    with pytest.raises(Undecided):
        bool(x > 0.0)
    assert x > -0.5
    assert not x > 0.5


@pytest.mark.parametrize("family", FAMILIES)
def test_peaks_lie_where_the_digits_leave_them(family: str) -> None:
    rng = np.random.default_rng(3)
    segments = 3 if family == "3-5-3" else 4
    for _ in range(4):
        # no turns, whose rule of velocities the digits could change
        w = np.cumsum(rng.uniform(0.2, 1.0, (segments + 1, 2)), axis=0).round(4)
        t = rng.uniform(0.3, 1.5, segments).round(3)
        problem = Problem.of(w, Limits.of(1.0, dof=2), family=family)
        halves, time_halves = np.full(w.shape, 5e-5), np.full(segments, 5e-4)
        found = peaks(problem, 1, halves, t, time_halves)
        seen = np.array(
            [
                FAMILIES[family].peaks(
                    replace(problem, waypoints=w + halves * rng.choice([-1.0, 1.0], w.shape)),
                    (t + time_halves * rng.choice([-1.0, 1.0], segments))[None],
                )[0, 1]
                for _ in range(300)
            ]
        )
        exact = FAMILIES[family].peaks(problem, t[None])[0, 1]
        np.testing.assert_allclose(found.printed, exact, rtol=1e-9)
        assert (found.low <= seen.min(axis=0)).all()
        assert (found.high >= seen.max(axis=0)).all()
        # the lower bound, on which accusations rest, gives little away
        assert (exact - found.low <= 0.01 * exact).all()


@pytest.mark.parametrize(
    ("raw", "value", "half"),
    [
        ("0.8660", 0.866, 5e-5),
        ("1.78", 1.78, 5e-3),
        ("-25.2188", -25.2188, 5e-5),
        ("940", 940.0, 0.5),
        (90, 90.0, 0.0),
    ],
)
def test_digits_say_how_far_a_number_is_known(raw: str | int, value: float, half: float) -> None:
    number = printed("x", raw)
    assert (number.value, number.half) == (value, pytest.approx(half))


@pytest.mark.parametrize("raw", ["one", "", "nan", True, None, [1]])
def test_what_is_no_number_is_refused(raw: object) -> None:
    with pytest.raises(InputError, match=r"^x: "):
        printed("x", raw)


def test_a_proof_for_all_that_print_alike_covers_each_of_them() -> None:
    rng = np.random.default_rng(5)
    problem = load("sr4c").joint(0)
    halves = np.full(problem.waypoints.shape, 2e-3)
    times = [
        minimum(
            replace(problem, waypoints=problem.waypoints + halves * rng.uniform(-1, 1, halves.shape))
        ).upper
        for _ in range(6)
    ]
    assert not impossible(problem, halves, min(times))
    assert impossible(problem, halves, 0.98 * min(times))
    assert impossible(problem, 0.0 * halves, 0.9999 * minimum(problem).upper)
    assert not impossible(problem, halves, 0.9999 * minimum(problem).upper)
