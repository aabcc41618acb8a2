"""Arms: forward kinematics against the papers' own points, inverse kinematics against forward."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import InputError, load, parse
from formulations.arms import (
    ARMS,
    Arm,
    branches,
    distance_in_pose,
    distance_to,
    load_arm,
    nearest,
    pose_of,
    random_joints,
    rpy_of,
    workspace,
)
from formulations.arms.kinematics import error_of
from formulations.problem.errors import OutOfReach

DEG = np.pi / 180.0

# Wang 2025, Table 4 [m, rad]; Li 2022, Fig. 4 [mm]; Zhou 2025, sec. 5.1 [mm]; Zhang 2025, Table 2 [mm]
SR4C = [
    (0.2239, 0.0531, 0.4956, 1.8709, -0.5077, -0.7550),
    (0.2364, 0.1262, 0.5953, 2.7407, -0.3731, -1.5064),
    (-0.0535, 0.0148, 0.9318, 1.3126, 0.2472, -2.8149),
    (-0.0590, -0.2379, 0.8973, 1.0536, 0.0, -1.8179),
]
POINTS = {
    "sr4c": np.array(SR4C)[:, :3] * 1e3,
    "bagging": np.array(
        [
            (940, 0, 1175), (1234, 16, 570), (1234, -223, 570), (1234, -223, 560),
            (1115, 44, 849), (1115, 44, 1280), (1017, 294, 1232),
        ],
        dtype=float,
    ),
    "ur5-corrected": np.array(
        [(-700, 200, 800), (-300, 125, 1000), (435, 785, 1025), (800, -601, 600)], dtype=float
    ),
    "cobot": np.array(
        [
            (296.505, -251.400, 379.065), (508.0, -110.5, 291.308),
            (589.434, 145.763, 284.681), (458.156, 430.521, -92.822),
        ]
    ),
}  # fmt: skip
MISSES = {  # mm, rounded to the last digit shown
    "sr4c": [0.05, 0.05, 0.05, 0.07],
    "bagging": [2.55, 0.59, 0.39, 0.39, 0.56, 0.55, 0.47],
    "ur5-corrected": [68.77, 37.08, 348.05, 177.93],
    "cobot": [0.04, 0.00, 0.00, 0.00],
}


def arm_of(case: str) -> Arm:
    return load_arm(case.removesuffix("-corrected"))


@pytest.mark.parametrize("case", POINTS)
def test_printed_joints_miss_printed_points_by_as_much_as_was_found(case: str) -> None:
    tool = arm_of(case).chain.forward(load(case).waypoints)[:, :3, 3] * 1e3
    np.testing.assert_allclose(np.linalg.norm(tool - POINTS[case], axis=1), MISSES[case], atol=0.0051)


def test_sr4c_angles_are_roll_pitch_yaw() -> None:
    tool = load_arm("sr4c").chain.forward(load("sr4c").waypoints)
    off = (rpy_of(tool) - np.array(SR4C)[:, 3:]) / DEG
    assert np.abs(off).max() < 0.015


def test_bagging_stands_too_high_at_a_in_print_alone() -> None:
    tool = load_arm("bagging").chain.forward(load("bagging").waypoints)[:, :3, 3] * 1e3
    off = tool - POINTS["bagging"]
    assert tool[0, 2] == pytest.approx(1172.5, abs=0.01)
    off[0, 2] = 0.0
    assert np.abs(off).max() < 0.52  # half a unit of the print


def test_the_printed_table_of_cobot_fits_no_point() -> None:
    tool = load_arm("cobot").printed.forward(load("cobot").waypoints)[:, :3, 3] * 1e3
    assert np.linalg.norm(tool - POINTS["cobot"], axis=1).max() > 350.0


@pytest.mark.parametrize("name", ["sr4c", "bagging", "ur5", "z1"])
def test_printed_and_resolved_lengths_agree_but_for_the_swapped_digits(name: str) -> None:
    arm = load_arm(name)
    np.testing.assert_array_equal(arm.printed.a, arm.chain.a)
    off = np.abs(arm.printed.d - arm.chain.d)
    assert off[1:].max() == 0.0
    assert off[0] == pytest.approx(0.027 if name == "z1" else 0.0)


def elementary(axis: int, angle: float) -> np.ndarray:
    """A rotation about a coordinate axis, (4, 4)."""
    turn, (i, j) = np.eye(4), [(1, 2), (2, 0), (0, 1)][axis]
    turn[i, i] = turn[j, j] = np.cos(angle)
    turn[j, i], turn[i, j] = np.sin(angle), -np.sin(angle)
    return turn


def shift(x: float, y: float, z: float) -> np.ndarray:
    move = np.eye(4)
    move[:3, 3] = x, y, z
    return move


@pytest.mark.parametrize("name", ARMS)
def test_forward_kinematics_is_the_product_of_elementary_motions(name: str) -> None:
    arm = load_arm(name)
    for q in random_joints(arm, 20, seed=1):
        pose = np.eye(4)
        chain = arm.chain
        table = np.stack([chain.sign * q + chain.offset, chain.d, chain.a, chain.alpha])
        for theta, d, a, alpha in table.T:
            pose = pose @ elementary(2, theta) @ shift(0, 0, d) @ shift(a, 0, 0) @ elementary(0, alpha)
        np.testing.assert_allclose(arm.chain.forward(q), pose, atol=1e-13)


def test_z1_is_the_arm_of_its_public_description() -> None:
    # joint origins and axes of that file; its 0.07 m to joint 5 is 0.072 m in the paper's table
    origins = [
        (0, 0, 0.0585), (0, 0, 0.045), (-0.35, 0, 0), (0.218, 0, 0.057), (0.072, 0, 0), (0.0492, 0, 0),
    ]  # fmt: skip
    axes = [2, 1, 1, 1, 2, 0]
    arm = load_arm("z1")
    for q in random_joints(arm, 50):
        pose = np.eye(4)
        for origin, axis, angle in zip(origins, axes, q, strict=True):
            pose = pose @ shift(*origin) @ elementary(axis, angle)
        tool = (pose @ shift(0.0982 - 0.0492, 0, 0))[:3, 3]
        np.testing.assert_allclose(arm.chain.forward(q)[:3, 3], tool, atol=5e-5)


@pytest.mark.parametrize("name", ARMS)
def test_the_jacobian_is_the_difference_quotient(name: str) -> None:
    arm = load_arm(name)
    q, h = random_joints(arm, 1, seed=3)[0], 1e-6
    for j, step in enumerate(h * np.eye(arm.dof)):
        quotient = error_of(arm.chain.forward(q + step), arm.chain.forward(q - step)) / (2.0 * h)
        np.testing.assert_allclose(arm.chain.jacobian(q)[:, j], quotient, atol=1e-8)


@given(st.lists(st.floats(-3.1, 3.1), min_size=3, max_size=3))
@settings(max_examples=30)
def test_roll_pitch_yaw_come_back(rpy: list[float]) -> None:
    pose = pose_of([0.1, 0.2, 0.3], rpy)
    turn = elementary(2, rpy[2]) @ elementary(1, rpy[1]) @ elementary(0, rpy[0])
    np.testing.assert_allclose(pose[:3, :3], turn[:3, :3], atol=1e-14)
    np.testing.assert_allclose(pose_of([0.1, 0.2, 0.3], rpy_of(pose)), pose, atol=1e-12)


def test_pitch_at_a_right_angle_comes_back_too() -> None:
    for pitch in (0.5 * np.pi, -0.5 * np.pi):
        pose = pose_of([0, 0, 0], [0.3, pitch, 0.4])
        np.testing.assert_allclose(pose_of([0, 0, 0], rpy_of(pose)), pose, atol=1e-12)


def test_half_a_turn_is_an_error_of_pi() -> None:
    for axis in range(3):
        error = error_of(elementary(axis, np.pi), np.eye(4))
        assert np.abs(error[3:]) == pytest.approx(np.pi * np.eye(3)[axis])


def off_by(found: np.ndarray, q: np.ndarray) -> float:
    """Largest angle between the nearest branch and a joint vector, whole turns apart."""
    return float(np.abs((found - q + np.pi) % (2.0 * np.pi) - np.pi).max(axis=1).min())


@pytest.mark.parametrize("case", ["sr4c", "bagging", "ur5", "ur5-corrected", "cobot", "z1"])
def test_every_printed_joint_vector_is_among_the_branches(case: str) -> None:
    arm = arm_of(case)
    for q in load(case).waypoints:
        pose = arm.chain.forward(q)
        found = branches(arm, pose)
        assert off_by(found, q) < 1e-9
        for solution in found:
            assert np.abs(error_of(pose, arm.chain.forward(solution))).max() < 1e-9
        np.testing.assert_allclose(nearest(arm, pose, q + 0.01), q, atol=1e-9)


@pytest.mark.parametrize("name", ARMS)
def test_random_poses_come_back(name: str) -> None:
    arm = load_arm(name)
    for q in random_joints(arm, 5, seed=7):
        assert off_by(branches(arm, arm.chain.forward(q)), q) < 1e-8


def test_a_singular_wrist_follows_the_last_waypoint() -> None:
    # joints 4 and 6 turn about one axis: any split of their sum will do, the nearest is wanted
    for name, fifth in (("bagging", 0.0), ("cobot", 0.0), ("sr4c", 0.5 * np.pi), ("ur5", 0.0)):
        arm = load_arm(name)
        q = np.array([0.5, 0.4, -0.3, 1.0, fifth, 0.7])
        pose = arm.chain.forward(q)
        moved = q + np.array([0.01, -0.01, 0.0, 0.3, 0.0, 0.2])
        found = nearest(arm, pose, moved)
        assert np.abs(error_of(pose, arm.chain.forward(found))).max() < 1e-9
        # no other member of the continuum is nearer
        for step in (-1e-3, 1e-3):
            other = _along(arm, found, step)
            assert np.linalg.norm(found - moved) <= np.linalg.norm(other - moved) + 1e-9


def _along(arm: Arm, q: np.ndarray, step: float) -> np.ndarray:
    """Beside q on the continuum that keeps the pose: one step along what the tool does not feel."""
    return q + step * np.linalg.svd(arm.chain.jacobian(q))[2][-1]


def test_the_points_of_ur5_are_refused_with_their_distances() -> None:
    arm = load_arm("ur5")
    for point, q, free, kept in zip(
        POINTS["ur5-corrected"] * 1e-3,
        load("ur5-corrected").waypoints,
        [67.553, 17.135, 346.688, 173.528],
        [68.769, 37.082, 348.049, 177.926],
        strict=True,
    ):
        pose = arm.chain.forward(q)
        pose[:3, 3] = point
        assert 1e3 * distance_to(arm, point)[0] == pytest.approx(free, abs=0.01)
        if kept < 50.0:
            # the printed joints are where the tool, so turned, is nearest: a solver gave up there
            assert 1e3 * distance_in_pose(arm, pose) == pytest.approx(kept, abs=0.01)
        with pytest.raises(OutOfReach, match=f"out of reach of ur5 in any.* {free:.1f} mm") as refused:
            nearest(arm, pose, q)
        assert refused.value.distance == pytest.approx(free * 1e-3, abs=1e-5)


@pytest.mark.parametrize(("name", "aside"), [("ur5", 109.3 - 82.5), ("cobot", 110.5 - 82.0)])
def test_the_axis_of_the_base_is_as_far_as_the_wrist_stands_aside(name: str, aside: float) -> None:
    # d4 moves the wrist out of the plane through the base's axis; at most d6 brings the tool back
    assert 1e3 * distance_to(load_arm(name), np.array([0.0, 0.0, 0.4]))[0] == pytest.approx(aside)


def test_what_only_the_limits_forbid_says_so() -> None:
    arm = load_arm("z1")
    q = np.array([0.3, 1.0, -1.0, 0.2, 0.3, 0.1])
    pose = arm.chain.forward(q)
    pose[:3, :3] = elementary(0, np.pi)[:3, :3] @ pose[:3, :3]
    with pytest.raises(OutOfReach, match=r"solutions leave the joint limits of z1|this orientation"):
        nearest(arm, pose, q)


def test_the_workspace_is_within_the_arms_reach() -> None:
    arm = load_arm("z1")
    points = workspace(arm, 4000)
    # from the shoulder the tool is at most the sum of the links away
    assert np.linalg.norm(points - [0, 0, 0.1035], axis=1).max() < 0.35 + 0.2253 + 0.072 + 0.0982
    assert np.ptp(points, axis=0).min() > 0.7
    np.testing.assert_array_equal(points, workspace(arm, 4000))


POSED = """
name = "by pose"
arm = "sr4c"
unit = "rad"
family = "3-5-3"
near = [0.4, 0.1, -0.8, -0.6, -0.5, 0.0]
{poses}
[limits]
velocity = 1.5
"""


def posed(rows: list[tuple[float, ...]], scale: float = 1.0) -> str:
    tables = [
        f"[[pose]]\nposition = {[scale * x for x in row[:3]]}\nrpy = {list(row[3:])}" for row in rows
    ]
    return POSED.format(poses="\n".join(tables))


def test_poses_in_a_problem_file_become_the_papers_joints() -> None:
    problem = parse(posed(SR4C))
    # Table 4 prints four digits: the joints of Table 5 come back to a few of its units
    assert np.abs(problem.waypoints - load("sr4c").waypoints).max() < 1e-3
    np.testing.assert_array_equal(problem.limits.position, load_arm("sr4c").position)
    in_mm = parse('length = "mm"\n' + posed(SR4C, 1e3))
    np.testing.assert_allclose(in_mm.waypoints, problem.waypoints, atol=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('arm = "sr4c"', "", "waypoints: missing"),
        ('arm = "sr4c"', "waypoints = [[0], [1]]\npose_ = 1", "unknown key 'pose_'"),
        ('arm = "sr4c"', "waypoints = [[0], [1]]", "pose: needs an arm"),
        ('arm = "sr4c"', 'arm = "sr5c"', "arm: 'sr5c' is not known (known: bagging, cobot"),
        ('arm = "sr4c"', "arm = 4", "arm: expected a name, got 4"),
        ('arm = "sr4c"', 'arm = "sr4c"\nwaypoints = [[0], [1]]', "waypoints: given beside arm"),
        ('arm = "sr4c"', 'arm = "sr4c"\nlength = "inch"', "length: 'inch' is not one of m, mm"),
        ("near = [0.4,", "near = [0.4, 1,", "near: 7 values for 6 joints"),
        ("position = [0.2239,", "position = [3.2239,", "pose 1: position [3.2239, 0.0531, 0.4956] m"),
        ("position = [0.2239,", "position = [", "pose 1: position: 2 values where 3 are expected"),
        ("position = [0.2239,", "place = [0.2239,", "pose 1: unknown key 'place'"),
        ("rpy = [1.8709,", "rpy = [true,", "pose 1: rpy: row 1, value 1: expected a number"),
    ],
)
def test_a_mistake_in_poses_is_one_line(old: str, new: str, message: str) -> None:
    text = posed(SR4C)
    assert text.count(old) == 1
    with pytest.raises(InputError) as caught:
        parse(text.replace(old, new))
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_without_the_package_its_name_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    from formulations.arms import inverse

    inverse._solver.cache_clear()
    monkeypatch.setitem(sys.modules, "eaik.IK_DH", None)
    with pytest.raises(InputError, match=r"eaik: pip install 'timebound\[arms\]'"):
        parse(posed(SR4C))
