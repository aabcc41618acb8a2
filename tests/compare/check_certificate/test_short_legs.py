"""Legs that may take no time: rows without a quotient are exact on them, and prove closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from few_demands import demands
from handmade_certificates import certificate, with_multiplier

from compare.check_certificate.answers import Refused
from compare.check_certificate.claim import Claim
from compare.check_certificate.families.every_motion.relaxation import Relaxation
from compare.check_certificate.verify import verify


def distance(joint: int, segment: int, sign: int, y: float) -> list[Any]:
    """The displacement of a joint on a segment is at most that at top speed."""
    return with_multiplier(["D", joint, segment, sign, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0], y)


def proves(data: dict[str, Any], least: float) -> None:
    """Assert that a certificate proves a bound, and not more."""
    verify({**data, "seconds": (least * (1.0 - 1e-12)).hex()})
    with pytest.raises(Refused, match="not above the bound"):
        verify({**data, "seconds": (least * (1.0 + 1e-12)).hex()})


# --- closed forms ---------------------------------------------------------------------------------


def test_a_way_through_a_zone_at_both_ends_of_it() -> None:
    """From 0 through a zone about it to -1: the legs alone take 0 s and 0.9 s, together 1 s."""
    asked = demands([[[0.0, 0.0]], [[-0.1, 1.1]], [[-1.0, -1.0]]], [1.0, 1.0])
    proves(certificate(asked, 1.0, 9.0, [["F", []]]), 0.9)
    rows = [distance(0, k, -1, 1.0) for k in (0, 1)]
    proves(certificate(asked, 1.0, 9.0, [["F", rows]]), 1.0)


def test_where_to_change_the_segment() -> None:
    """The middle segment is twice as fast, so it is used as far as both zones let it: from 0 to 2."""
    asked = demands(
        [[[0.0, 0.0]], [[-0.2, 1.0]], [[0.5, 2.0]], [[3.0, 3.0]]],
        [1.0, 2.0, 1.0],
    )
    rows = [distance(0, 0, 1, 0.5), distance(0, 1, 1, 0.5), distance(0, 2, 1, 1.0)]
    data = certificate(asked, 1.0, 9.0, [["F", rows]])
    proves(data, 2.0)
    with pytest.raises(Refused, match="not above"):  # without the zone that is entered early
        verify({**data, "seconds": (1.99).hex(), "without": [1], "events": [["F", [rows[2]]]]})


def test_a_cycle_of_which_each_leg_may_take_no_time() -> None:
    """Three boxes meet in pairs, but x is at least 1 in the second and at most 0.9 in the third."""
    boxes = [[[-1.0, 1.0], [0.5, 2.5]], [[1.0, 3.0], [0.5, 2.5]], [[0.0, 0.9], [-1.5, 0.5]]]
    asked = demands([*boxes, boxes[0]], [1.0] * 3)
    asked["cyclic"] = True
    data = certificate(asked, 1.0, 9.0, [["F", [distance(0, 1, -1, 1.0)]]])
    proves(data, 0.1)
    there_and_back = [distance(0, k, sign, 1.0) for k, sign in ((0, 1), (1, -1), (2, 1))]
    proves({**data, "events": [["F", there_and_back]]}, 0.2)


def test_all_legs_may_take_no_time() -> None:
    """Zones that meet one after the other: only sums of rows prove anything."""
    asked = demands([[[0.0, 1.0]], [[0.5, 1.5]], [[1.2, 2.0]], [[1.9, 2.5]]], [1.0, 0.5, 1.0])
    data = certificate(asked, 0.1, 9.0, [["F", []]])
    with pytest.raises(Refused, match="not above"):
        verify(data)
    # from 1 to 1.9: 0.5 rad of it at 1 rad/s at first, 0.4 rad at last, nothing on the slow segment
    rows = [distance(0, 0, 1, 1.0), distance(0, 1, 1, 1.0), distance(0, 2, 1, 1.0)]
    proves({**data, "events": [["F", rows]]}, 0.9)


def test_a_position_in_a_zone_is_narrowed() -> None:
    """In 0.25 s a joint of 1 rad/s gets from 0 no farther than 0.25 rad."""
    asked = demands([[[0.0, 0.0]], [[-1.0, 1.0]], [[0.0, 0.0]]], [1.0, 1.0])
    asked["durations"][0] = [0.0, 0.25]
    up = ["N", "x", 1, 0, 1, [distance(0, 0, 1, 1.0)]]
    checker = Relaxation(Claim(certificate(asked, 1e-9, 9.0, [up, ["R"], ["F", []]])))
    with pytest.raises(Refused):
        checker.replay()
    assert [float(x) for x in checker.boxes["e", 1, 0]] == pytest.approx([-1.0, 0.25])


def test_a_velocity_is_narrowed() -> None:
    """From rest with 2 rad/s^2, at most 0.5 rad/s after 0.25 s."""
    asked = demands([[[0.0, 0.0]], [[-1.0, 1.0]], [[0.0, 0.0]]], [1.0, 1.0], steep=2.0)
    asked["durations"][0] = [0.0, 0.25]
    asked["end_velocity"][0] = 0.0
    row = with_multiplier(["a", 0, 0, 1, 0.0, 1.0], 1.0)
    events = [["N", "v", 1, 0, 1, [row]], ["P"], ["F", []]]
    checker = Relaxation(Claim(certificate(asked, 1e-9, 9.0, events)))
    with pytest.raises(Refused):
        checker.replay()
    assert [float(x) for x in checker.boxes["v", 1, 0]] == pytest.approx([-1.0, 0.5])


# --- legs over several others ---------------------------------------------------------------------


def test_a_leg_over_all_others_has_the_sum_of_their_times() -> None:
    """From 0 to -1 as a whole takes 1 s, wherever in its zone the waypoint between is passed."""
    asked = demands([[[0.0, 0.0]], [[-0.1, 1.1]], [[-1.0, -1.0]]], [1.0, 1.0])
    whole = [0, 2]
    tie = with_multiplier(["e", whole, 1], 1.0)
    proves(certificate(asked, 1.0, 9.0, [["F", [tie]]]), 1.0)  # from its box alone
    with_room = with_multiplier(["D", 0, whole, -1, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0], 1.0)
    proves(certificate(asked, 1.0, 9.0, [["F", [tie, with_room]]]), 1.0)
    narrowed = ["N", "T", whole, 0, [with_room]]
    proves(certificate(asked, 1.0, 9.0, [narrowed, ["R"], ["F", [tie]]]), 1.0)
    loosened = with_multiplier(["e", whole, -1], 1.0)
    with pytest.raises(Refused, match="not above"):
        verify(certificate(asked, 0.95, 9.0, [["F", [loosened]]]))


def test_the_loosest_limits_hold_on_a_leg_over_several_others() -> None:
    asked = demands([[[0.0, 0.0]], [[-0.1, 1.1]], [[-1.0, -1.0]]], [1.0, 2.0])
    proves(certificate(asked, 1.0, 9.0, [["F", [with_multiplier(["e", [0, 2], 1], 1.0)]]]), 0.5)


def test_its_box_lies_within_the_sums_of_the_others() -> None:
    asked = demands([[[0.0, 0.0]], [[0.5, 0.5]], [[1.0, 1.0]], [[2.0, 2.0]]], [1.0] * 3)
    asked["durations"][:2, 1] = 0.7, 0.8
    narrow = ["N", "T", 1, 0, [distance(0, 1, 1, 1.0)]]
    events = [["N", "T", [0, 2], 0, []], narrow, ["R"], ["F", []]]
    checker = Relaxation(Claim(certificate(asked, 1e-9, 2.3, events)))
    checker.replay()
    # 1 s at top speed; 1.3 s are left when the last segment takes 1 s
    assert [float(x) for x in checker.boxes["T", (0, 2)]] == pytest.approx([1.0, 1.3])


@pytest.mark.parametrize(
    ("leg", "waits", "without", "reason"),
    [
        ([0, 1], [], [], "none between"),
        ([2, 0], [], [], "none between"),
        ([0, 2], [1], [], "a wait on"),
        ([0, 2], [], [2], "left out"),
        ([0, 2], [], [1], "none between"),
        ([0, 2], [], [], ""),
        ([1, 3], [1], [], ""),
    ],
)
def test_which_legs_over_several_others_there_are(
    leg: list[int], waits: list[int], without: list[int], reason: str
) -> None:
    asked = demands([[[0.0, 0.0]], [[0.5, 0.5]], [[1.0, 1.0]], [[2.0, 2.0]]], [1.0] * 3)
    asked["waits"][waits] = 0.5
    rows = [with_multiplier(["T", leg, 0.1], 1e-12)]
    data = certificate(asked, 1e-9, 9.0, [["F", rows]], frozenset(without))
    if reason:
        with pytest.raises(Refused, match=reason):
            verify(data)
    else:
        assert f"T{leg[0] + 1}..{leg[1]}^2" in verify(data, show=True)


# --- what a leg that may take no time does not have -----------------------------------------------


QUOTIENTS = (
    ["s", 0],
    ["t", 0, 0.5],
    ["c", 0, 0.5],
    ["m", 0, 0, 1, 0],
    ["d", 0, 0, 1, 0.0, 0.1, 0.2, 0.8, 0.9, 1.0],
    ["k", 0, 0, 1, 0.0, 0.1, 0.2, 0.8, 0.9, 1.0],
    ["r", 0, 0, 1, -1, 0.1, 0.2],
)


@pytest.mark.parametrize("raw", QUOTIENTS, ids=lambda raw: raw[0])
@pytest.mark.parametrize("least", [0.0, 1e-3])
def test_a_row_divides_by_a_duration_only_where_that_is_positive(raw: list[Any], least: float) -> None:
    asked = demands([[[0.0, 0.0]], [[-0.5, 0.5]], [[2.0, 2.0]]], [1.0, 1.0], 2.0, 9.0)
    asked["durations"][0, 0] = least
    asked["position"] = np.broadcast_to([-3.0, 3.0], (2, 1, 2))
    data = certificate(asked, 1e-9, 9.0, [["F", [with_multiplier(raw, 1e-12)]]])
    if least:
        verify(data)
    else:
        with pytest.raises(Refused, match="divides by a duration from waypoint 1 on"):
            verify(data)


def test_accelerations_are_narrowed_from_durations_that_are_positive() -> None:
    """Between two legs that may take no time, only the jerk limit bounds the change of an acceleration."""
    asked = demands([[[0.0, 0.0]], [[-0.5, 0.5]], [[0.2, 0.2]]], [1.0, 1.0], 20.0, 9.0)
    asked["durations"][:] = [0.0, 0.1]
    asked["end_acceleration"][0] = 0.0
    checker = Relaxation(Claim(certificate(asked, 1e-9, 9.0, [["P"], ["F", []]])))
    with pytest.raises(Refused):
        checker.replay()
    assert [float(x) for x in checker.boxes["a", 1, 0]] == pytest.approx([-0.9, 0.9])


@pytest.mark.parametrize(
    "raw",
    [
        ["K", 0, 0, 1, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
        ["D", 0, 0, 1, 0.0, 0.0, 0.1, 1.0, 1.0, 1.0],
        ["a", 0, 0, 1, 0.0, 1.0],
        ["g", 0, 0, 0, 0],
        ["x", 0, 0, 0, 0],
        ["V", 0, 1, 1, 0.5],
    ],
    ids=str,
)
def test_a_velocity_that_may_jump_is_in_no_row(raw: list[Any]) -> None:
    asked = demands([[[0.0, 0.0]], [[-0.1, 1.1]], [[-1.0, -1.0]]], [1.0, 1.0])
    with pytest.raises(Refused):
        verify(certificate(asked, 1e-9, 9.0, [["F", [with_multiplier(raw, 1e-9)]]]))
    events = [["N", "v", 1, 0, 0, []], ["R"], ["F", []]]
    with pytest.raises(Refused, match="without a box"):
        verify(certificate(asked, 1e-9, 9.0, events))


@pytest.mark.parametrize(("sign", "f"), [(1, 3.0), (-1, 3.0), (1, -3.0), (-1, -3.0)])
@pytest.mark.parametrize("least", [0.0, 1.0])
def test_a_peak_needs_the_time_in_which_the_acceleration_fades(
    sign: int, f: float, least: float
) -> None:
    """With free ends: after the waypoint where f > 0, before it where f < 0; 9 rad/s^2 take 1 s."""
    asked = demands([[[0.0, 0.0]], [[-0.5, 0.5]], [[0.2, 0.2]]], [1.0, 1.0], 9.0, 9.0)
    asked["end_velocity"], asked["end_acceleration"] = [[[-1.0, 1.0]]] * 2, [[[-9.0, 9.0]]] * 2
    asked["durations"][int(f > 0), 0] = least
    checker = Relaxation(Claim(certificate(asked, 1e-9, 9.0, [])))
    raw = with_multiplier(["V", 0, 1, sign, f], 1.0)
    if least:
        row, upper = checker.row(raw)
        assert {key: float(x) for key, x in row.items()} == {
            ("v", 1, 0): sign,
            ("a", 1, 0): sign * f / 9.0,
        }
        assert float(upper) == pytest.approx(1.0 + f * f / 18.0)
    else:
        with pytest.raises(Refused, match="need not fade"):
            checker.row(raw)
