"""Hints: a fault planted in a sound paper is named, and a sound paper gets no hint."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from arm_sheets import DEG, Sheet, optima, sound
from printed_papers import synthetic

from compare.audit import audit, load_papers, parse_papers
from compare.audit.hints import QUESTIONS, Hint

Plant = Callable[[Sheet], None]


def hints(sheet: Sheet) -> list[Hint]:
    """Hints of a paper with a planted fault; every count in them is that of the audit."""
    found = sheet.audited()
    wrong = [(f.kind, f.where) for f in found.faults]
    assert wrong
    for hint in found.hints:
        assert hint.kind in QUESTIONS
        assert hint.of == len(wrong)
        assert hint.removes == sum(where in hint.explains for _, where in wrong)
        assert f"remove {hint.removes} of {hint.of} fault" in hint.text or not hint.removes
    return list(found.hints)


def limits_in_rad(s: Sheet) -> None:
    s.limits["Table 3"] = [row * DEG for row in s.limits["Table 3"]]


def velocity_in_rad(s: Sheet) -> None:
    s.limits["Table 3"][0] *= DEG


def acceleration_in_rad(s: Sheet) -> None:
    s.limits["Table 3"][1] *= DEG


def said_rad(s: Sheet) -> None:
    s.units["Table 3"] = "rad"


def position_in_rad(s: Sheet) -> None:
    s.position["Table 3"] = [[-3.1416, 3.1416]] * 3


def waypoints_said_rad(s: Sheet) -> None:
    s.waypoint_unit = "rad"


def waypoints_in_rad(s: Sheet) -> None:
    s.waypoints *= DEG


def one_waypoint_in_rad(s: Sheet) -> None:
    s.waypoints[2] *= DEG


def one_joint_in_rad(s: Sheet) -> None:
    s.waypoints[:, 1] *= DEG


def orientations_said_rad(s: Sheet) -> None:
    s.angle = "rad"


def times_in_minutes(s: Sheet) -> None:
    s.times = [t / 60.0 for t in s.times]
    s.totals = [float(t.round(4).sum()) for t in s.times]


def times_alone_in_minutes(s: Sheet) -> None:
    s.times = [t / 60.0 for t in s.times]


def times_in_milliseconds(s: Sheet) -> None:
    s.times = [t * 1e3 for t in s.times]
    s.totals = [float(t.round(4).sum()) for t in s.times]


def totals_in_milliseconds(s: Sheet) -> None:
    s.totals = [total * 1e3 for total in s.totals]


def points_in_m(s: Sheet) -> None:
    s.points = [p * 1e-3 for p in s.points]


def points_said_m(s: Sheet) -> None:
    s.length = "m"


def joints_swapped(s: Sheet) -> None:
    s.waypoints[:, [0, 2]] = s.waypoints[:, [2, 0]]


def waypoints_swapped(s: Sheet) -> None:
    s.waypoints[[1, 2]] = s.waypoints[[2, 1]]


def limits_swapped(s: Sheet) -> None:
    s.limits["Table 3"] = [row[[1, 0, 2]] for row in s.limits["Table 3"]]


def velocities_swapped(s: Sheet) -> None:
    s.limits["Table 3"][0][:2] = [s.limits["Table 3"][0][1], s.limits["Table 3"][0][0]]


def times_swapped(s: Sheet) -> None:
    s.times[:2], s.totals[:2] = [s.times[1], s.times[0]], [s.totals[1], s.totals[0]]


def points_swapped(s: Sheet) -> None:
    s.points[0], s.points[2] = s.points[2], s.points[0]
    s.rpy[0], s.rpy[2] = s.rpy[2], s.rpy[0]


def coordinates_swapped(s: Sheet) -> None:
    s.points = [p[[1, 0, 2]] for p in s.points]


def sign_of_a_coordinate(s: Sheet) -> None:
    s.points[1][1] *= -1.0


def made_under_higher_limits(s: Sheet) -> None:
    s.times = optima("Table 4")
    s.totals = [float(t.round(4).sum()) for t in s.times]


def made_under_lower_limits(s: Sheet) -> None:
    s.under = "Table 4"


@pytest.mark.parametrize(
    ("plant", "kind", "tried"),
    [
        (limits_in_rad, "angle unit", "the limits of Table 3 in rad (stated: deg)"),
        (velocity_in_rad, "angle unit", "the velocity limits of Table 3 in rad (stated: deg)"),
        (acceleration_in_rad, "angle unit", "the acceleration limits of Table 3 in rad (stated: deg)"),
        (said_rad, "angle unit", "the limits of Table 3 in deg (stated: rad)"),
        (position_in_rad, "angle unit", "the position limits of Table 3 in rad (stated: deg)"),
        (waypoints_said_rad, "angle unit", "all waypoints in deg (stated: rad)"),
        (waypoints_in_rad, "angle unit", "all waypoints in rad (stated: deg)"),
        (one_waypoint_in_rad, "angle unit", "waypoint 3 in rad (stated: deg)"),
        (one_joint_in_rad, "angle unit", "joint 2 of the waypoints in rad (stated: deg)"),
        (orientations_said_rad, "angle unit", "the orientations of the points in deg (stated: rad)"),
        (times_in_minutes, "time unit", "the times and totals of Table 5 in min (read: s)"),
        (times_alone_in_minutes, "time unit", "the times of Table 5 in min (read: s)"),
        (times_in_milliseconds, "time unit", "the times and totals of Table 5 in ms (read: s)"),
        (totals_in_milliseconds, "time unit", "the totals of Table 5 in ms (read: s)"),
        (points_in_m, "length unit", "the position of all points in m (stated: mm)"),
        (points_said_m, "length unit", "the position of all points in mm (stated: m)"),
        (joints_swapped, "swap", "joints 1 and 3 of the waypoints swapped"),
        (waypoints_swapped, "swap", "waypoints 2 and 3 of the waypoints swapped"),
        (limits_swapped, "swap", "joints 1 and 2 of the limits of Table 3 swapped"),
        (velocities_swapped, "swap", "joints 1 and 2 of the velocity limits of Table 3 swapped"),
        (times_swapped, "swap", "the times of Table 5, joint 1 and Table 5, joint 2 swapped"),
        (points_swapped, "swap", "P1 and P3 swapped"),
        (coordinates_swapped, "swap", "x and y of the points swapped"),
        (sign_of_a_coordinate, "sign", "y of P2 with the other sign"),
        (made_under_higher_limits, "other table", "Table 5 under the limits of Table 4 (stated: Table 3)"),
        (made_under_lower_limits, "other table", "Table 5 under the limits of Table 3 (stated: Table 4)"),
    ],
)  # fmt: skip
def test_a_planted_fault_is_named_and_all_of_it_explained(plant: Plant, kind: str, tried: str) -> None:
    sheet = sound()
    plant(sheet)
    first = hints(sheet)[0]
    assert first.kind == kind
    # where acceleration alone decides, the units of all limits or of that alone explain the same
    assert tried in (first.tried, *first.others[:1])
    assert tried in first.text
    assert first.removes == first.of


@pytest.mark.parametrize(("waypoint", "joint"), list(np.ndindex(4, 3)))
def test_the_one_wrong_sign_is_named(waypoint: int, joint: int) -> None:
    sheet = sound()
    sheet.waypoints[waypoint, joint] *= -1.0
    first = hints(sheet)[0]
    assert first.tried == f"joint {joint + 1} of waypoint {waypoint + 1} with the other sign"
    assert first.removes == first.of


def test_the_sign_is_named_without_points_too() -> None:
    sheet = sound()
    sheet.waypoints[2, 1] *= -1.0
    text = sheet.text()
    text = text[: text.index("[[point]]")]
    (first, *_) = audit(parse_papers(text, "sheet")[0]).hints
    assert first.tried == "joint 2 of waypoint 3 with the other sign"
    assert first.explains == ("Table 5, joint 2",)
    # the truth uses its limits fully; another sign may explain the times, but with less use of them
    assert first.text.endswith("the stretch of the motions there is then 1")


def test_a_sound_paper_gets_no_hint() -> None:
    found = sound().audited()
    assert found.faults == []
    assert found.hints == ()


@pytest.mark.parametrize("seed", range(6))
def test_what_no_single_change_explains_gets_no_hint(seed: int) -> None:
    """Sound papers of other waypoints and slower motions, and the same with a percentage that is wrong."""
    rng = np.random.default_rng(seed)
    sheet = sound(waypoints=np.cumsum(rng.uniform(-45.0, 45.0, (4, 3)), axis=0).round(4))
    slower = rng.uniform(
        1.0, 1.015
    )  # more would fit lower limits than the stated ones, as a finding says
    sheet.times = [(slower * t).round(4) + 1e-4 for t in sheet.times]
    sheet.totals = [float(t.sum()) for t in sheet.times]
    for claim, where in (("50.0", []), ("51.0", ["abstract"])):
        sheet.claim = claim
        found = sheet.audited()
        assert [f.where for f in found.faults] == where
        assert found.hints == ()


def test_the_rule_of_the_longest_times_is_no_reason_for_a_hint() -> None:
    (paper,) = parse_papers(synthetic(), "p")
    found = audit(paper)
    assert {f.where for f in found.faults} == {"Table 2, last row"}
    assert found.hints == ()


def test_limits_that_are_far_away_explain_nothing() -> None:
    # 90 deg/s where 95 are reached: in rad/s the limit would be 57 times as high
    sheet = sound()
    sheet.times = [0.95 * t for t in sheet.times]
    sheet.totals = [float(t.round(4).sum()) for t in sheet.times]
    found = hints(sheet)
    assert "angle unit" not in {hint.kind for hint in found}
    assert "time unit" not in {hint.kind for hint in found}


def test_a_limit_of_position_that_is_a_little_too_low_is_no_mixed_unit() -> None:
    sheet = sound()
    sheet.position["Table 3"] = [[-180.0, 90.0]] * 3
    found = sheet.audited()
    assert [(f.kind, f.where) for f in found.faults] == [("limits", "waypoint 4")]
    assert "joint 1 is at 95 deg, the limit of Table 3 is 90 deg" in found.faults[0].text
    assert found.hints == ()


def test_a_point_that_is_simply_wrong_gets_no_hint() -> None:
    sheet = sound()
    sheet.points[2] += 3.0
    assert hints(sheet) == []


def test_the_limits_of_lu_and_wang_are_in_degrees() -> None:
    (hint,) = audit(load_papers("z1")[0]).hints
    assert hint.tried == "the limits of Table 2 in deg (stated: rad)"
    assert (hint.removes, hint.of) == (2, 2)
