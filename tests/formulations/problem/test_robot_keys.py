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


def test_pairs_and_conditions_lie_over_the_limits_of_the_robot(folder: Path) -> None:
    more = (
        "[limits]\nvelocity = {turn = [-45, 30]}\n[conditions]\ntolerance = {bend = 3}\n"
        "[[conditions.segment]]\nfrom = 0\nlimits = {velocity = {slide = [-0.1, 0.2]}}\n"
    )
    problem = load(write(folder, FILE + more))
    speeds, steepest = problem.limits.intervals
    np.testing.assert_allclose(speeds, [[-math.pi / 4, math.pi / 6], [-1, 1], [-0.5, 0.5]])
    np.testing.assert_allclose(problem.limits.velocity, [math.pi / 4, 1, 0.5])
    np.testing.assert_allclose(steepest[:, 1], load(write(folder, FILE)).limits.acceleration)
    np.testing.assert_allclose(problem.conditions.tolerance[1], [0, math.radians(3), 0])
    np.testing.assert_allclose(
        problem.conditions.segment_limits[0].intervals[0],
        [[-math.pi / 4, math.pi / 6], [-1, 1], [-0.1, 0.2]],
    )
    assert "joint turn: [1, 2] deg/s does not hold 0 inside" in refused(
        folder, FILE + "[limits]\nvelocity = {turn = [1, 2]}\n"
    )


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


ALONE = """unit = "deg"
limits_file = "robots/joint_limits.yaml"
waypoints_file = "path.csv"
prismatic = "slide"
unlimited = "position"
[limits]
velocity = {turn = 90, bend = 45, slide = 0.5}
"""


def test_limits_and_waypoints_need_no_robot_where_the_joints_are_named(folder: Path) -> None:
    problem = load(write(folder, ALONE))
    assert problem.names == ("bend", "turn", "slide")  # the header of the CSV
    assert problem.units == ("rad", "rad", "m")
    np.testing.assert_allclose(problem.waypoints[1], [math.radians(-20), math.pi / 4, 0.1])
    np.testing.assert_allclose(problem.limits.velocity, [math.pi / 4, math.pi / 2, 0.5])
    np.testing.assert_allclose(problem.limits.acceleration, [3, 4, 2])
    np.testing.assert_allclose(problem.limits.jerk, [30, 40, 20])
    assert np.isinf(problem.limits.position).all()
    ordered = load(write(folder, 'joints = ["slide", "turn", "bend"]\n' + ALONE))
    assert ordered.names == ("slide", "turn", "bend")
    np.testing.assert_allclose(ordered.waypoints[:, ::-1][:, [0, 1]], problem.waypoints[:, :2])


def test_without_names_in_the_waypoints_the_limits_file_names_the_joints(folder: Path) -> None:
    here = ALONE.replace('waypoints_file = "path.csv"', "waypoints = [[0, 10, 0], [45, -20, 0.1]]")
    problem = load(write(folder, here))
    assert problem.names == ("turn", "bend", "slide")  # the order of the YAML
    np.testing.assert_allclose(problem.waypoints[1], [math.pi / 4, math.radians(-20), 0.1])
    (folder / "path.csv").write_text("0,10,0\n45,-20,0.1\n")
    bare = load(write(folder, ALONE))
    assert bare.names == problem.names
    np.testing.assert_array_equal(bare.waypoints, problem.waypoints)


def test_waypoints_of_a_file_and_limits_of_the_table_alone(folder: Path) -> None:
    text = 'unit = "deg"\nwaypoints_file = "path.csv"\nprismatic = "slide"\n[limits]\n'
    problem = load(write(folder, text + "velocity = {bend = 90, turn = 45, slide = 1}\n"))
    assert problem.names == ("bend", "turn", "slide")
    np.testing.assert_allclose(problem.limits.velocity, [math.pi / 2, math.pi / 4, 1])
    assert not problem.limits.has_acceleration  # left out: unlimited, as in any table
    message = refused(folder, text + "velocity = {bend = 90}\n")
    assert "limits are missing: velocity of turn, slide" in message
    (folder / "path.json").write_text(
        '{"joint_names": ["turn"], "points": [{"positions": [0]}, {"positions": [1]}]}'
    )
    rotary = 'waypoints_file = "path.json"\n[limits]\nvelocity = 2\n'
    assert load(write(folder, rotary)).names == ("turn",)


ALONE_MISTAKES = {
    "a joint": (
        'joints = ["turn", "bend", "slied"]\n' + ALONE,
        ["joints: no limits file has joint 'slied'", "nearest known one is 'slide'"],
    ),
    "twice": ('joints = ["turn", "turn"]\n' + ALONE, ["joints: joint 'turn' is given twice"]),
    "prismatic": (ALONE.replace('"slide"', '"lside"'), ["prismatic: no joint 'lside'", "'slide'"]),
    "position": (
        ALONE.replace('unlimited = "position"\n', ""),
        ["limits are missing: position of bend, turn, slide", "unlimited=['position']"],
    ),
    "srdf": ('srdf = "arm.srdf"\n' + ALONE, ["srdf: needs a robot (key robot"]),
    "scaling": ('velocity_scaling = 2\n' + ALONE, ["velocity_scaling: 2.0 is not a factor"]),
    "arm": ('arm = "ur5"\n' + ALONE, ["arm: given beside limits_file"]),
    "no names": (
        ALONE.replace('limits_file = "robots/joint_limits.yaml"\n', "").replace("path", "bare"),
        ["joints: missing: neither they nor a file names the joints"],
    ),
    "poses": (
        ALONE.replace('waypoints_file = "path.csv"\n', "")
        + "[[pose]]\nposition = [1, 0, 0]\nrpy = [0, 0, 0]\n",
        ["has no URDF, hence no kinematics"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("mistake", ALONE_MISTAKES)
def test_a_mistake_without_a_robot_is_one_line(mistake: str, folder: Path) -> None:
    (folder / "bare.csv").write_text("0,0,0\n1,1,0.1\n")
    text, words = ALONE_MISTAKES[mistake]
    line = refused(folder, text)
    for word in words:
        assert word in line, line


# the hand of the small arm: turn about z, bend about y, slide along the bent z axis
POSED = """robot = "robots/arm.urdf"
limits_file = "robots/joint_limits.yaml"
unit = "deg"
length = "mm"
near = {turn = 10, bend = 20, slide = 0.1}
"""


def hand(turn: float, bend: float, slide: float) -> tuple[list[float], list[float]]:
    """Position [mm] and roll, pitch, yaw [deg] by trigonometry."""
    a, b = math.radians(turn), math.radians(bend)
    along = [math.cos(a) * math.sin(b), math.sin(a) * math.sin(b), math.cos(b)]
    return [1000.0 * slide * x for x in along], [0.0, bend, turn]


def test_poses_in_the_file_are_solved_by_the_kinematics_of_the_urdf(folder: Path) -> None:
    wanted = [(10.0, 20.0, 0.1), (40.0, 60.0, 0.15), (-30.0, -50.0, 0.05)]
    tables = ""
    for joints in wanted:
        position, rpy = hand(*joints)
        tables += f"[[pose]]\nposition = {position}\nrpy = {rpy}\n"
    problem = load(write(folder, POSED + tables))
    truth = [[math.radians(a), math.radians(b), slide] for a, b, slide in wanted]
    np.testing.assert_allclose(problem.waypoints, truth, atol=1e-6)
    # the same poses in a file beside it, by the same solver
    rows = [",".join(map(str, (*p, *r))) for p, r in (hand(*joints) for joints in wanted)]
    (folder / "poses.csv").write_text("\n".join(["x,y,z,roll,pitch,yaw", *rows]))
    text = POSED.replace("near = {turn = 10, bend = 20, slide = 0.1}\n", "")
    beside = load(write(folder, text + 'waypoints_file = "poses.csv"\n'))
    np.testing.assert_allclose(beside.waypoints, problem.waypoints, atol=1e-6)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[[pose]]\npositoin = [0, 0, 100]\nrpy = [0, 0, 0]", "unknown key 'positoin'; did you mean pos"),
        ("[[pose]]\nposition = [0, 0, 900]\nrpy = [0, 0, 0]", "the best leaves that of joint 'slide' by 0.7 m"),
        ("waypoints = [[0, 0, 0]]\n[[pose]]\nposition = [0, 0, 1]", "waypoints: given beside pose"),
        ("pose = 3", "pose: expected tables"),
    ],
)  # fmt: skip
def test_a_mistake_in_a_pose_is_one_line(text: str, words: str, folder: Path) -> None:
    assert words in refused(folder, POSED + text)
    wrong = POSED.replace("bend = 20", "bnd = 20") + "[[pose]]\nposition = [0, 0, 100]\nrpy = [0, 0, 0]"
    assert "near: no joint 'bnd'; the nearest known one is 'bend'" in refused(folder, wrong)


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
