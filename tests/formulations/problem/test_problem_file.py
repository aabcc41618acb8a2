"""Problem files: every mistake is one clear line; whatever else is written is a problem."""

from __future__ import annotations

import math
import re
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import CASES, FAMILIES, InputError, Limits, Problem, load, parse

DEG = math.pi / 180.0

GOOD = """
name = "two joints"
unit = "rad"
waypoints = [[0.0, 1.0], [0.5, 1.5], [1.0, 1.0], [2.0, 0.0]]

[limits]
velocity = [1.0, 2.0]
acceleration = 3.0
jerk = [4, 5]
position = [[-1.0, 3.0], [-2.0, 2.0]]
"""


def message(text: str) -> str:
    """The one line with which a text is refused."""
    with pytest.raises(InputError) as caught:
        parse(text, where="FILE")
    line = str(caught.value)
    assert len(line.splitlines()) == 1, line
    assert line.startswith("FILE: ")
    return line


def swapped(old: str, new: str) -> str:
    """The good file with one piece of text replaced."""
    assert GOOD.count(old) == 1
    return GOOD.replace(old, new)


def test_the_good_file_means_what_it_says() -> None:
    problem = parse(GOOD)
    assert (problem.name, problem.title, problem.display_unit) == ("two joints", "two joints", "rad")
    assert (problem.dof, problem.n_segments, problem.family) == (2, 3, "3-5-3")
    assert problem.waypoints.tolist() == [[0.0, 1.0], [0.5, 1.5], [1.0, 1.0], [2.0, 0.0]]
    assert problem.limits.velocity.tolist() == [1.0, 2.0]
    assert problem.limits.acceleration.tolist() == [3.0, 3.0]
    assert problem.limits.jerk.tolist() == [4.0, 5.0]
    assert problem.limits.position.tolist() == [[-1.0, 3.0], [-2.0, 2.0]]


def test_limits_left_out_are_unlimited() -> None:
    problem = parse("waypoints = [[0], [1]]\n[limits]\nvelocity = 1")
    assert not problem.limits.has_acceleration
    assert not problem.limits.has_jerk
    assert not problem.limits.has_position
    assert np.isinf(problem.limits.acceleration).all()
    assert np.isinf(problem.limits.jerk).all()


@pytest.mark.parametrize(("rows", "family"), [(2, "4-3-4"), (3, "4-3-4"), (4, "3-5-3"), (5, "4-3-4")])
def test_the_family_left_out_follows_from_the_number_of_waypoints(rows: int, family: str) -> None:
    points = ", ".join(f"[{row}]" for row in range(rows))
    assert parse(f"waypoints = [{points}]\n[limits]\nvelocity = 1").family == family


def test_degrees_apply_to_waypoints_and_to_every_limit() -> None:
    problem = parse(swapped('unit = "rad"', 'unit = "deg"'))
    np.testing.assert_allclose(problem.waypoints[1], [0.5 * DEG, 1.5 * DEG], rtol=1e-15)
    np.testing.assert_allclose(problem.limits.velocity, [1.0 * DEG, 2.0 * DEG], rtol=1e-15)
    np.testing.assert_allclose(problem.limits.acceleration, 3.0 * DEG, rtol=1e-15)
    np.testing.assert_allclose(problem.limits.jerk, [4.0 * DEG, 5.0 * DEG], rtol=1e-15)
    np.testing.assert_allclose(problem.limits.position[1], [-2.0 * DEG, 2.0 * DEG], rtol=1e-15)


@pytest.mark.parametrize(("outer", "inner"), [("rad", "deg"), ("deg", "rad")])
def test_the_unit_of_the_limits_overrides_that_of_the_file(outer: str, inner: str) -> None:
    text = f"""unit = "{outer}"
waypoints = [[0.001], [0.002]]
[limits]
unit = "{inner}"
velocity = 2.0
position = [[-1.0, 1.0]]"""
    problem = parse(text)
    scale = {"rad": 1.0, "deg": DEG}
    assert problem.waypoints[1, 0] == pytest.approx(0.002 * scale[outer], rel=1e-15)
    assert problem.limits.velocity[0] == pytest.approx(2.0 * scale[inner], rel=1e-15)
    assert problem.limits.position[0, 1] == pytest.approx(scale[inner], rel=1e-15)
    assert problem.display_unit == inner


# --- one mistake at a time; the words each message must hold --------------------------------------

MISTAKES = {
    "an unknown key": (GOOD.replace("name", "nmae"), ["nmae", "unknown key"]),
    "an unknown key of limits": (swapped("jerk", "jrek"), ["limits", "jrek", "unknown key"]),
    "waypoints missing": ("[limits]\nvelocity = 1", ["waypoints", "missing"]),
    "limits missing": ("waypoints = [[0], [1]]", ["limits", "missing"]),
    "velocity missing": ("waypoints = [[0], [1]]\n[limits]", ["limits.velocity", "missing"]),
    "an empty file": ("", ["missing"]),
    "not TOML": ("waypoints = [[0, 1", ["TOML"]),
    "YAML": ("waypoints:\n  - [0, 1]", ["TOML"]),
    "a key twice": (GOOD + "velocity = 1\n", ["TOML"]),
    "nested without end": ("waypoints = " + "[" * 100_000, ["TOML"]),
    "name a number": (swapped('"two joints"', "3"), ["name", "3", "text"]),
    "title a list": ("title = [1]\n" + GOOD, ["title", "[1]", "text"]),
    "source a date": ("source = 1979-05-27\n" + GOOD, ["source", "1979", "text"]),
    "an unknown unit": (swapped('"rad"', '"grad"'), ["unit", "grad", "rad", "deg"]),
    "a unit that is no text": (swapped('"rad"', "1"), ["unit", "1", "rad", "deg"]),
    "an unknown unit of limits": (GOOD + 'unit = "turn"', ["limits.unit", "turn"]),
    "an unknown family": ('family = "5-3-5"\n' + GOOD, ["family", "5-3-5", *FAMILIES]),
    "a family that is no text": ("family = 353\n" + GOOD, ["family", "353"]),
    "3-5-3 for two segments": (
        'family = "3-5-3"\nwaypoints = [[0], [1], [2]]\n[limits]\nvelocity = 1',
        ["family", "3-5-3", "3 segments", "has 2"],
    ),
    "4-3-4 for one segment": (
        'family = "4-3-4"\nwaypoints = [[0], [1]]\n[limits]\nvelocity = 1',
        ["family", "4-3-4", "2 segments"],
    ),
    "waypoints a number": ("waypoints = 1\n[limits]\nvelocity = 1", ["waypoints", "rows"]),
    "waypoints a flat list": ("waypoints = [1, 2]\n[limits]\nvelocity = 1", ["waypoints", "rows"]),
    "waypoints a table": ("waypoints = {a = 1}\n[limits]\nvelocity = 1", ["waypoints", "rows"]),
    "no waypoint": ("waypoints = []\n[limits]\nvelocity = 1", ["waypoints"]),
    "empty rows": ("waypoints = [[], []]\n[limits]\nvelocity = 1", ["waypoints", "row 1", "empty"]),
    "one waypoint": ("waypoints = [[1, 2]]\n[limits]\nvelocity = 1", ["waypoints", "two", "1"]),
    "a short row": (swapped("[0.5, 1.5]", "[0.5]"), ["waypoints", "row 2", "1", "2"]),
    "a long row": (swapped("[2.0, 0.0]", "[2.0, 0.0, 7.0]"), ["waypoints", "row 4", "3", "2"]),
    "NaN in a waypoint": (swapped("1.5]", "nan]"), ["waypoints", "row 2", "joint 2", "nan"]),
    "an infinite waypoint": (swapped("1.5]", "-inf]"), ["waypoints", "row 2", "joint 2", "-inf"]),
    "text in a waypoint": (swapped("1.5]", '"1.5"]'), ["waypoints", "row 2", "joint 2", "'1.5'"]),
    "true in a waypoint": (swapped("1.5]", "true]"), ["waypoints", "row 2", "joint 2", "True"]),
    "a waypoint too large": (
        swapped("1.5]", "1" * 400 + "]"),
        ["waypoints", "row 2", "joint 2", "large"],
    ),
    "a table of limits too many": (
        "waypoints = [[0], [1]]\n[[limits]]\nvelocity = 1",
        ["limits", "table"],
    ),
    "too few velocities": (swapped("[1.0, 2.0]", "[1.0]"), ["limits.velocity", "1 values", "2 joints"]),
    "too many jerks": (swapped("[4, 5]", "[4, 5, 6]"), ["limits.jerk", "3 values", "2 joints"]),
    "no acceleration": (swapped("n = 3.0", "n = []"), ["limits.acceleration", "0 values", "2 joints"]),
    "a limit of zero": (swapped("[1.0, 2.0]", "[1.0, 0]"), ["limits.velocity", "joint 2", "0"]),
    "a negative limit": (swapped("[4, 5]", "[-4, 5]"), ["limits.jerk", "joint 1", "-4"]),
    "a negative limit for all": (swapped("n = 3.0", "n = -3.0"), ["limits.acceleration", "-3"]),
    "a limit of NaN": (swapped("n = 3.0", "n = nan"), ["limits.acceleration", "nan"]),
    "an infinite limit": (swapped("[4, 5]", "[4, inf]"), ["limits.jerk", "joint 2", "inf"]),
    "a true limit": (swapped("n = 3.0", "n = true"), ["limits.acceleration", "True", "number"]),
    "a limit in text": (swapped("[4, 5]", '["4", 5]'), ["limits.jerk", "joint 1", "'4'", "number"]),
    "a limit too large": (swapped("n = 3.0", "n = 1" + "0" * 400), ["limits.acceleration", "large"]),
    "a limit that underflows": (
        'unit = "deg"\nwaypoints = [[0], [1]]\n[limits]\nvelocity = 5e-324',
        ["limits.velocity", "joint 1", "0"],
    ),
    "position for too few joints": (swapped(", [-2.0, 2.0]", ""), ["limits.position", "2 joints"]),
    "position without an upper end": (
        swapped(", [-2.0, 2.0]", ", [1]"),
        ["limits.position", "joint 2"],
    ),
    "position with three ends": (
        swapped("[[-1.0, 3.0], [-2.0, 2.0]]", "[[-1, 1, 2], [-1, 1, 2]]"),
        ["limits.position", "low, high"],
    ),
    "position the wrong way round": (
        swapped("[-2.0, 2.0]", "[2.0, -2.0]"),
        ["limits.position", "joint 2", "2", "-2"],
    ),
    "an empty position range": (
        swapped("[-2.0, 2.0]", "[1.0, 1.0]"),
        ["limits.position", "joint 2", "1"],
    ),
    "NaN in a position limit": (swapped("[-2.0, 2.0]", "[nan, 2.0]"), ["limits.position", "nan"]),
    "text in a position limit": (swapped("[-2.0, 2.0]", '[-2.0, "2"]'), ["limits.position", "'2'"]),
    "a waypoint outside its position limits": (
        swapped("1.5]", "2.5]"),
        ["waypoints", "joint 2", "joint 2", "2.5", "limits.position"],
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_one_line_that_names_key_joint_and_value(mistake: str) -> None:
    text, words = MISTAKES[mistake]
    line = message(text)
    for word in words:
        assert word in line, line


@pytest.mark.parametrize(("entry", "value"), [("[nan, 2.0]", "nan"), ("[-2.0, inf]", "inf")])
def test_a_bad_position_limit_is_blamed_on_its_joint(entry: str, value: str) -> None:
    line = message(swapped("[-2.0, 2.0]", entry))
    assert "joint 2" in line, line
    assert "joint 1" not in line, line
    assert value in line


@pytest.mark.parametrize("digits", [400, 4299, 4301, 20_000])
def test_huge_whole_numbers_are_refused_in_one_line(digits: int) -> None:
    for text in (
        swapped("n = 3.0", "n = " + "7" * digits),
        swapped("1.5]", "7" * digits + "]"),
    ):
        line = message(text)
        assert len(line) < 400


@pytest.mark.parametrize(
    "place",
    [
        ("n = 3.0", "n = HUGE"),
        ("1.5]", "HUGE]"),
        ('"two joints"', "HUGE"),
        ('"rad"', "HUGE"),
        ("[[-1.0, 3.0], [-2.0, 2.0]]", "HUGE"),
        ("[4, 5]", "[[HUGE]]"),
        ("[1.0, 2.0]", "{ a = HUGE }"),
    ],
    ids=["limit", "waypoint", "name", "unit", "position", "list in a limit", "table in a limit"],
)
def test_huge_hexadecimal_numbers_are_refused_in_one_line(place: tuple[str, str]) -> None:
    old, new = place
    assert len(message(swapped(old, new.replace("HUGE", "0x" + "f" * 5000)))) < 400


@pytest.mark.parametrize("key", ["name", "limits", "waypoints"])
def test_a_long_wrong_value_does_not_flood_the_line(key: str) -> None:
    text = f"{key} = [{', '.join(['1'] * 20_000)}]\n"
    rest = {"waypoints": "waypoints = [[0], [1]]\n", "limits": "[limits]\nvelocity = 1\n"}
    text += "".join(value for name, value in rest.items() if name != key)
    assert len(message(text)) < 400


@pytest.mark.parametrize(
    ("text", "nearest"),
    [
        (GOOD.replace("name", "nmae"), "name"),
        (swapped("waypoints", "waypoint"), "waypoints"),
        (swapped("jerk", "jrek"), "jerk"),
        (swapped("velocity", "velocities"), "velocity"),
        (
            'arm = "ur5"\n[limits]\nvelocity = 1\n[[pose]]\npositon = [0, 0, 1]\nrpy = [0, 0, 0]',
            "position",
        ),
    ],
)
def test_an_unknown_key_is_refused_at_every_depth_with_the_nearest_known_one(
    text: str, nearest: str
) -> None:
    assert f"did you mean {nearest}?" in message(text)


def test_an_unknown_key_that_is_near_to_none_gets_the_list() -> None:
    line = message("quux = 1\n" + GOOD)
    assert "did you mean" not in line
    assert "known: name, title" in line


# --- position limits and what print rounds away ---------------------------------------------------


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_waypoint_within_a_tenth_of_a_milliradian_outside_is_accepted(side: float) -> None:
    limits = Limits.of(1.0, position=[[-1.0, 1.0]], dof=1)
    problem = Problem.of([[0.0], [side * (1.0 + 0.99e-4)]], limits)
    # the limits in force are widened to the waypoint, on that side alone
    assert problem.position_bounds[0].tolist() == sorted([-side, side * (1.0 + 0.99e-4)])
    with pytest.raises(InputError, match=r"row 2, joint 1.*limits\.position"):
        Problem.of([[0.0], [side * (1.0 + 1.01e-4)]], limits)


def test_the_tolerance_of_position_limits_is_in_radians_even_in_a_file_of_degrees() -> None:
    text = 'unit = "deg"\nwaypoints = [[0], [{}]]\n[limits]\nvelocity = 1\nposition = [[-90, 90]]'
    parse(text.format(90.0 + 0.99e-4 / DEG))
    assert "joint 1" in message(text.format(90.0 + 1.01e-4 / DEG))


# --- files ----------------------------------------------------------------------------------------


def refused(path: Any) -> str:
    with pytest.raises(InputError) as caught:
        load(path)
    line = str(caught.value)
    assert len(line.splitlines()) == 1, line
    return line


def test_a_file_is_read_and_its_name_opens_every_error(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(GOOD, "utf-8")
    for path in (file, str(file)):
        assert load(path).waypoints.tolist() == parse(GOOD).waypoints.tolist()
    file.write_text("nonsense", "utf-8")
    assert refused(file).startswith(str(file))


def test_line_ends_of_windows_are_read(tmp_path: Path) -> None:
    file = tmp_path / "windows.toml"
    file.write_bytes(GOOD.replace("\n", "\r\n").encode())
    assert load(file).waypoints.tolist() == parse(GOOD).waypoints.tolist()


def test_what_is_no_problem_file_is_refused_in_one_line(tmp_path: Path) -> None:
    missing = refused(tmp_path / "missing.toml")
    assert "missing.toml" in missing
    assert "no such file" in missing
    assert all(case in missing for case in CASES)
    assert str(tmp_path) in refused(tmp_path)
    assert "." in refused("")
    (tmp_path / "binary").write_bytes(bytes(range(256)) * 40)
    assert "binary" in refused(tmp_path / "binary")
    (tmp_path / "zeros").write_bytes(b"\0" * 100)
    assert "zeros" in refused(tmp_path / "zeros")
    (tmp_path / "utf16").write_text(GOOD, "utf-16")
    assert "utf16" in refused(tmp_path / "utf16")
    refused("x" * 5000)
    refused("nul\0byte")
    (tmp_path / "file").write_text(GOOD, "utf-8")
    refused(tmp_path / "file" / "below")
    with (tmp_path / "large").open("wb") as large:
        large.truncate(1 << 40)  # a terabyte that takes no room: must not be read
    assert "larger" in refused(tmp_path / "large")


@pytest.mark.parametrize("name", ["two\nlines", "carriage\rreturn", "line\u2028separator"])
def test_a_name_with_a_line_break_still_gives_one_line(name: str, tmp_path: Path) -> None:
    refused(name)
    file = tmp_path / name
    file.write_text("nonsense", "utf-8")
    refused(file)


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


# --- the same rules without a file ----------------------------------------------------------------


@pytest.mark.parametrize(
    "value", [0.0, -1.0, math.nan, [1.0, math.nan], [1.0], [[1.0, 2.0]], "x", None]
)
def test_limits_made_in_code_keep_the_same_rules(value: Any) -> None:
    for name in ("velocity", "acceleration", "jerk"):
        with pytest.raises(InputError, match=rf"^limits\.{name}.*"):
            Limits.of(**{"velocity": 1.0, name: value}, dof=2)


@pytest.mark.parametrize(
    "points",
    [
        [[0.0, 1.0], [math.nan, 1.0]],
        [[0.0, 1.0], [math.inf, 1.0]],
        [[0.0, 1.0]],
        [0.0, 1.0],
        [[0.0], [1.0]],
        [[], []],
        [[0.0, 1.0], [1.0]],
        [["a", "b"], ["c", "d"]],
    ],
)
def test_waypoints_made_in_code_keep_the_same_rules(points: Any) -> None:
    with pytest.raises(InputError) as caught:
        Problem.of(points, Limits.of(1.0, dof=2))
    assert len(str(caught.value).splitlines()) == 1


# --- whatever is written: a problem, or one line --------------------------------------------------


def problem_or_one_line(text: str) -> None:
    line = "FILE: "
    try:
        problem = parse(text, where="FILE")
    except InputError as error:
        line = str(error)
    assert len(line.splitlines()) == 1, repr(line)
    assert line.startswith("FILE: ")
    if line != "FILE: ":
        return
    assert problem.waypoints.shape == (problem.n_segments + 1, problem.dof)
    assert problem.n_segments >= 1
    assert np.isfinite(problem.waypoints).all()
    limits = problem.limits
    for values in (limits.velocity, limits.acceleration, limits.jerk):
        assert values.shape == (problem.dof,)
        assert (values > 0.0).all()
    assert (limits.position[:, 0] < limits.position[:, 1]).all()
    assert problem.family in FAMILIES


SCALARS = st.one_of(
    st.integers(-(10**6), 10**6).map(str),
    st.sampled_from([30, 400, 4400]).map(lambda n: "9" * n),
    st.sampled_from([30, 400, 4400]).map(lambda n: "0x" + "e" * n),
    st.floats().map(repr),
    st.sampled_from(
        ["true", '""', '"rad"', '"deg"', '"3-5-3"', '"4-3-4"', "''", "07:32:00", "1979-05-27"]
    ),
    st.text(max_size=8).map(
        lambda s: '"' + "".join(f"\\U{ord(c):08x}" for c in s if not 0xD800 <= ord(c) < 0xE000) + '"'
    ),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=5).map(lambda xs: "[" + ", ".join(xs) + "]"),
        inner.map(lambda x: "{ velocity = " + x + " }"),
    ),
    max_leaves=12,
)
LIMIT_KEYS = ["unit", "velocity", "acceleration", "jerk", "position", "jrek"]
KEYS = st.one_of(
    st.sampled_from(["name", "title", "source", "unit", "family", "waypoints", "limits", "nmae"]),
    st.sampled_from(LIMIT_KEYS).map("limits.{}".format),
    st.just('"a\\nb"'),
)
NUMBERS = st.floats(-2.0, 2.0, width=32).map(repr)


@st.composite
def nearly_right(draw: st.DrawFn) -> str:
    """Random keys with random values over a skeleton that is right."""
    rows, columns = draw(st.integers(1, 5)), draw(st.integers(1, 3))
    table = {
        "waypoints": "["
        + ", ".join("[" + ", ".join(draw(NUMBERS) for _ in range(columns)) + "]" for _ in range(rows))
        + "]",
        "limits.velocity": draw(st.sampled_from(["1", "0.5", "[1, 1]"])),
    }
    table |= draw(st.dictionaries(KEYS, VALUES, max_size=3))
    return "\n".join(f"{key} = {value}" for key, value in table.items())


@given(text=nearly_right())
@settings(max_examples=400)
def test_random_tables_give_a_problem_or_one_line(text: str) -> None:
    problem_or_one_line(text)


SHIPPED = [(files("formulations.problem.cases") / f"{case}.toml").read_text("utf-8") for case in CASES]
TOKENS = st.one_of(
    st.sampled_from(list("[]{}=,.\"'#\n\t -+_0123456789einfa\\\0\u2028")),
    st.sampled_from(["nan", "inf", "-1", "1e400", "[limits]", "true", "0x" + "f" * 4400, "9" * 4400]),
)


@given(data=st.data())
@settings(max_examples=400)
def test_mutated_shipped_cases_give_a_problem_or_one_line(data: st.DataObject) -> None:
    text = data.draw(st.sampled_from(SHIPPED))
    for _ in range(data.draw(st.integers(1, 4))):
        # numbers and keys are hit as often as the long prose
        spots = [match.start() for match in re.finditer(r"[-\w.\[\]]+", text)]
        at = data.draw(st.sampled_from(spots or [0]))
        length = data.draw(st.sampled_from([0, 1, 1, 2, 7, 40]))
        text = text[:at] + data.draw(TOKENS) + text[at + length :]
    problem_or_one_line(text)


@given(text=st.text(max_size=200))
def test_random_text_gives_a_problem_or_one_line(text: str) -> None:
    problem_or_one_line(text)
