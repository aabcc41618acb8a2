"""Torque limits in problem files and on the command line: read, written, and refused in one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from small_arms import two_links

from formulations import InputError, load
from formulations.problem.toml_file.problem_file import parse
from formulations.problem.toml_file.problem_text import problem_text
from formulations.problem.torque import EARTH, Payload

pytest.importorskip("yourdfpy", reason="yourdfpy is not installed (extra robot)")

FILE = """
robot = "arm.urdf"
waypoints = [[-1.0, 0.2], [0.4, 0.9]]
[limits]
acceleration = 9
jerk = 90
[conditions]
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "arm.urdf").write_text(two_links())
    return tmp_path


def read(folder: Path, lines: str):  # type: ignore[no-untyped-def]
    (folder / "task.toml").write_text(FILE + lines)
    return load(folder / "task.toml")


def test_every_form_is_read(folder: Path) -> None:
    assert read(folder, "torque = true").conditions.torque.limits is None
    assert read(folder, "torque = 9").conditions.torque.limits == (9.0, 9.0)
    assert read(folder, "torque = [9, 3.5]").conditions.torque.limits == (9.0, 3.5)
    named = read(
        folder, "torque = {two = 3, one = 8}\npayload = 2\ngravity = [0, 0, -1.6]"
    ).conditions.torque
    assert named.limits == (8.0, 3.0)
    assert (named.payload, named.gravity, named.joints) == (
        Payload(2.0),
        (0.0, 0.0, -1.6),
        ("one", "two"),
    )
    whole = read(
        folder, 'torque = true\npayload = {mass = 1, com = [0, 0, 0.1], link = "l1"}'
    ).conditions.torque
    assert (whole.payload, whole.gravity) == (Payload(1.0, (0.0, 0.0, 0.1), "l1"), EARTH)
    assert read(folder, "torque = false").conditions.none


def test_a_saved_problem_holds_its_arm(folder: Path) -> None:
    problem = read(folder, 'torque = [9, 3.5]\npayload = {mass = 1, com = [0, 0, 0.1], link = "l1"}')
    again = parse(problem_text(problem))
    assert again == problem
    np.testing.assert_array_equal(again.waypoints, problem.waypoints)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("torque = [9]", "1 values for 2 joints"),
        ("torque = {one = 9}", "joint two: missing"),
        ("torque = -1", "joint one: -1 N m is not positive"),
        ("payload = 1", "conditions.payload: has no meaning without torque"),
        ("torque = true\npayload = {com = [0, 0, 0]}", "conditions.payload.mass: missing"),
        ("torque = true\ngravity = 9.81", "expected three numbers, got 9.81"),
        ("torque = true\npayload = {mass = 1, con = 2}", "con"),
    ],
)
def test_what_cannot_be_is_refused(folder: Path, lines: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        read(folder, lines)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_torques_need_a_robot() -> None:
    with pytest.raises(InputError, match=r"conditions\.torque: needs a robot"):
        parse("waypoints = [[0.0], [1.0]]\n[limits]\nvelocity = 1\n[conditions]\ntorque = 3\n")
