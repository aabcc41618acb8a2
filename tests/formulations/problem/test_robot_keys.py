"""Problem files that name a robot's files: what they mean, and every mistake is one line."""

from __future__ import annotations

import math
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from small_robot import ARM, CSV, FILE, YAML

from formulations import InputError, load, parse


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "robots").mkdir()
    (tmp_path / "robots" / "arm.urdf").write_text(ARM)
    (tmp_path / "robots" / "joint_limits.yaml").write_text(YAML)
    (tmp_path / "path.csv").write_text(CSV)
    return tmp_path


def write(folder: Path, text: str) -> Path:
    file = folder / "mine.toml"
    file.write_text(text, "utf-8")
    return file


def refused(folder: Path, text: str) -> str:
    with pytest.raises(InputError) as caught:
        load(write(folder, text))
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


def test_a_file_names_robot_limits_and_waypoints_beside_it(folder: Path) -> None:
    problem = load(write(folder, FILE))
    assert problem.names == ("turn", "bend", "slide")
    assert problem.units == ("rad", "rad", "m")
    assert problem.display_unit == "deg"
    expected = [[0, math.radians(10), 0], [math.pi / 4, math.radians(-20), 0.1]]
    np.testing.assert_allclose(problem.waypoints[:2], expected)
    np.testing.assert_allclose(problem.limits.velocity, [2, 1, 0.5])
    np.testing.assert_allclose(problem.limits.jerk, [40, 30, 20])
    np.testing.assert_allclose(problem.limits.position, [[-3, 3], [-2, 2], [0, 0.2]])
    assert load(write(folder, FILE)) == problem


def test_the_limits_of_the_file_override_by_joint_by_list_and_for_all(folder: Path) -> None:
    more = (
        "[limits]\nvelocity = {turn = 45}\nacceleration = [90, 180, 1]\nposition = {slide = [0, 0.3]}\n"
    )
    limits = load(write(folder, FILE + more)).limits
    np.testing.assert_allclose(
        limits.velocity, [math.pi / 4, 1, 0.5]
    )  # bend and slide: as the URDF says
    np.testing.assert_allclose(limits.acceleration, [math.pi / 2, math.pi, 1])
    np.testing.assert_allclose(limits.jerk, [40, 30, 20])
    np.testing.assert_allclose(limits.position, [[-3, 3], [-2, 2], [0, 0.3]])


def test_joints_are_chosen_and_ordered_and_waypoints_stand_in_the_file(folder: Path) -> None:
    text = """robot = "robots/arm.urdf"
joints = ["slide", "turn"]
waypoints = [[0.0, 1.0], [0.1, 2.0]]
limits_file = ["robots/joint_limits.yaml"]
velocity_scaling = 0.5
"""
    problem = load(write(folder, text))
    assert problem.names == ("slide", "turn")
    np.testing.assert_allclose(problem.limits.velocity, [0.25, 1.0])
    np.testing.assert_allclose(problem.waypoints, [[0, 1], [0.1, 2]])


def test_a_missing_limit_is_asked_for(folder: Path) -> None:
    text = FILE.replace('limits_file = "robots/joint_limits.yaml"\n', "")
    assert "limits are missing: acceleration of turn, bend, slide; jerk of" in refused(folder, text)
    free = load(write(folder, text + 'unlimited = "jerk"\n[limits]\nacceleration = 90\n'))
    assert not free.limits.has_jerk
    np.testing.assert_allclose(free.limits.acceleration, [math.pi / 2, math.pi / 2, 90])


MISTAKES = {
    "robto": (FILE.replace("robot =", "robto ="), ["unknown key 'robto'", "did you mean robot?"]),
    "waypoint_file": (FILE.replace("waypoints_file", "waypoint_file"), ["did you mean waypoints_file?"]),
    "no such urdf": (FILE.replace("arm.urdf", "leg.urdf"), ["leg.urdf: no such file"]),
    "a number as robot": (FILE.replace('"robots/arm.urdf"', "3"), ["robot: expected text, got 3"]),
    "a number in joints": (FILE + "joints = [1]\n", ["joints: expected a text or a list of texts"]),
    "an unknown joint": (FILE + 'joints = ["trun"]\n', ["'trun'", "nearest known one is 'turn'"]),
    "both waypoints": ("waypoints = [[0, 0, 0]]\n" + FILE, ["waypoints: given beside waypoints_file"]),
    "no waypoints": (FILE.replace('waypoints_file = "path.csv"', ""), ["waypoints: missing"]),
    "files without a robot": (
        'waypoints_file = "path.csv"\n[limits]\nvelocity = 1\n',
        ["waypoints_file: needs a robot"],
    ),
    "an arm beside": ('arm = "ur5"\n' + FILE, ["arm: given beside robot"]),
    "columns": (
        FILE.replace('waypoints_file = "path.csv"', "waypoints = [[0, 1], [1, 1]]"),
        ["waypoints: 2 columns for 3 joints (turn, bend, slide)"],
    ),
    "a joint of limits": (
        FILE + "[limits]\nvelocity = {trun = 1}\n",
        ["limits.velocity: unknown key 'trun'", "did you mean turn?"],
    ),
    "negative": (
        FILE + "[limits]\nvelocity = {turn = -90}\n",
        ["limits.velocity: joint turn: -90 deg/s is not positive"],
    ),
    "empty": (
        FILE + "[limits]\nposition = {slide = [0.2, 0.1]}\n",
        ["limits.position: joint slide: [0.2, 0.1] m is empty"],
    ),
    "an infinite limit": (FILE + "[limits]\nvelocity = {turn = inf}\n", ["joint turn: inf"]),
    "outside": (
        FILE.replace('waypoints_file = "path.csv"', "waypoints = [[0, 0, 0], [0, 150, 0]]"),
        ["row 2, joint bend: 150 deg lies outside limits.position [-114.592, 114.592] deg"],
    ),
    "prismatic": ('prismatic = ["slide"]\n' + FILE, ["prismatic: given beside robot"]),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_one_line(mistake: str, folder: Path) -> None:
    text, words = MISTAKES[mistake]
    line = refused(folder, text)
    assert line.startswith(str(folder / "mine.toml"))
    for word in words:
        assert word in line, line


def test_names_and_prismatic_joints_without_a_robot() -> None:
    text = """unit = "deg"
joints = ["arm", "lift"]
prismatic = ["lift"]
waypoints = [[0, 0.1], [90, 0.2]]
[limits]
velocity = {arm = 90, lift = 0.5}
position = {lift = [0, 0.3]}
"""
    problem = parse(text)
    np.testing.assert_allclose(problem.waypoints[1], [math.pi / 2, 0.2])
    np.testing.assert_allclose(problem.limits.velocity, [math.pi / 2, 0.5])
    assert problem.units == ("rad", "m")
    assert np.isinf(problem.limits.position[0]).all()
    with pytest.raises(InputError, match=r"prismatic: no joint 'lfit'; did you mean lift\?"):
        parse(text.replace('["lift"]', '["lfit"]'))
    with pytest.raises(InputError, match=r"limits\.velocity: joint lift: inf is not finite"):
        parse(text.replace(", lift = 0.5", ""))


# --- what ended in a traceback, in silence or in a riddle ------------------------------------------

SMALL = "waypoints = [[0], [1]]\n[limits]\nvelocity = 1\n"


def test_a_byte_order_mark_is_no_fault(tmp_path: Path) -> None:
    (tmp_path / "bom.toml").write_bytes(b"\xef\xbb\xbf" + SMALL.encode())
    assert load(tmp_path / "bom.toml") == parse("\ufeff" + SMALL) == parse(SMALL)


def test_a_waypoint_beyond_all_robots_is_refused() -> None:
    with pytest.raises(InputError, match=r"row 2, joint 1: 1e\+300 rad is beyond 1e\+06"):
        parse(SMALL.replace("[1]]", "[1e300]]"))
    with pytest.raises(InputError, match=r"row 2, joint 1: 1e\+300 deg is beyond 5\.73e\+07"):
        parse('unit = "deg"\n' + SMALL.replace("[1]]", "[1e300]]"))


def test_too_many_waypoints_are_refused_at_once() -> None:
    text = "waypoints = [" + "[0.1, 0.2], " * 80_000 + "]\n[limits]\nvelocity = 1\n"
    began = time.perf_counter()
    with pytest.raises(InputError, match="80000 waypoints; at most 2000 are planned"):
        parse(text)
    assert time.perf_counter() - began < 20.0


def test_a_missing_extra_is_named(folder: Path) -> None:
    code = (
        "import sys; sys.modules['yaml'] = None\n"
        "import formulations as f\n"
        f"try: f.load({str(write(folder, FILE))!r})\n"
        "except f.InputError as e: print(e)"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install 'timebound[robot]'" in said.stdout


def test_no_reader_of_robots_is_loaded_before_a_file_names_one() -> None:
    code = (
        "import sys, formulations as f; f.load('sr4c')\n"
        "print([m for m in ('lxml', 'yourdfpy') if m in sys.modules])"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "[]"
