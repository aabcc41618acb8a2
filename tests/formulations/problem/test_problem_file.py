"""Problem files: what a good one means, and every mistake is one clear line."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from problem_texts import GOOD, message, swapped

from formulations import CASES, FAMILIES, InputError, load, parse

DEG = math.pi / 180.0


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
    assert "at most" in refused(tmp_path / "large")


@pytest.mark.parametrize("name", ["two\nlines", "carriage\rreturn", "line\u2028separator"])
def test_a_name_with_a_line_break_still_gives_one_line(name: str, tmp_path: Path) -> None:
    refused(name)
    file = tmp_path / name
    file.write_text("nonsense", "utf-8")
    refused(file)
