"""joint_limits.yaml: what is written is what is read; MoveIt's rules; faults by name, line and nearest key."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import powers_of_ten
from hypothesis import given
from hypothesis import strategies as st
from robot_files import joint, planar, urdf, written

from formulations import InputError
from formulations.robot import Joint, JointKind, Robot
from formulations.robot.joint_limits import check_names, laid_over, parse_limits
from formulations.robot.joints import UNLIMITED

BARE = Joint("j", JointKind.REVOLUTE)
KNOWN = Joint("j", JointKind.REVOLUTE, 1.0, 2.0, 3.0, (-1.0, 1.0))
NAMES = st.from_regex(r"[A-Za-z_][A-Za-z0-9_/.-]{0,12}", fullmatch=True).filter(
    lambda name: name.lower() not in ("null", "true", "false", "yes", "no", "on", "off")
)


def _over(known: Joint, body: str) -> Joint:
    return laid_over(known, [parse_limits(f"joint_limits:\n  j: {{{body}}}\n", "x.yaml")])


@st.composite
def _entry(draw: st.DrawFn) -> dict[str, float]:
    found = {f"max_{q}": draw(powers_of_ten(-3, 4)) for q in ("velocity", "acceleration", "jerk")}
    low = draw(st.floats(-10.0, 10.0))
    found |= {"min_position": low, "max_position": low + draw(powers_of_ten(-2, 2))}
    kept = draw(st.sets(st.sampled_from(sorted(found)))) | {"max_velocity"}
    return {key: value for key, value in found.items() if key in kept}


@st.composite
def _file(draw: st.DrawFn) -> tuple[dict[str, dict[str, float]], str]:
    """Numbers of joints, and a file that says them in one of the ways there are."""
    limits = draw(st.dictionaries(NAMES, _entry(), min_size=1, max_size=4))
    style = draw(st.sampled_from(["block", "flow", "quoted"]))
    spell = draw(st.sampled_from([repr, "{:.17g}".format, "{:.16e}".format]))
    lines = ["joint_limits:"]
    for name, values in limits.items():
        rows = [f"{key}: {spell(value)}" for key, value in values.items()]
        rows += [
            f"has_{key[4:]}_limits: {draw(st.sampled_from(['true', 'True', 'yes']))}"
            for key in values
            if draw(st.booleans()) and "position" not in key
        ]
        rows = draw(st.permutations(rows))
        shown = f"'{name}'" if style == "quoted" else name
        if style == "flow":
            lines.append(f"  {shown}: {{{', '.join(rows)}}}")
        else:
            lines += [f"  {shown}:", *(f"    {row}  # as the maker says" for row in rows)]
    wrapped = draw(st.sampled_from([(), ("robot_description_planning",), ("/**", "ros__parameters")]))
    for depth, key in enumerate(wrapped):
        lines[depth:] = [f"{'  ' * depth}{key}:", *("  " + line for line in lines[depth:])]
    mark = draw(st.sampled_from(["", "---\n", "# limits\n\n"]))
    return limits, mark + "\n".join(lines) + draw(st.sampled_from(["", "\n", "\n---\n"]))


@given(case=_file())
def test_what_is_written_is_what_is_read(case: tuple[dict[str, dict[str, float]], str]) -> None:
    limits, text = case
    found = parse_limits(text, "x.yaml")
    assert set(found.joints) == set(limits)
    for name, values in limits.items():
        mine = laid_over(Joint(name, JointKind.REVOLUTE), [found])
        for quantity in ("velocity", "acceleration", "jerk"):
            assert getattr(mine, quantity) == values.get(f"max_{quantity}")
        both = (values.get("min_position"), values.get("max_position"))
        assert mine.position == (None if None in both else both)


@given(
    velocity=powers_of_ten(-2, 0),
    acceleration=powers_of_ten(-2, 0),
    jerk=powers_of_ten(-2, 0),
    default=powers_of_ten(-2, 0),
    given_too=st.booleans(),
)
def test_scaling_factors_multiply_and_an_argument_replaces_the_default_of_the_file(
    tmp_path_factory: pytest.TempPathFactory,
    velocity: float,
    acceleration: float,
    jerk: float,
    default: float,
    given_too: bool,
) -> None:
    folder = tmp_path_factory.mktemp("scaled")
    arm = written(folder, "arm.urdf", planar(1.0, 0.5))
    limits = written(
        folder,
        "limits.yaml",
        f"default_velocity_scaling_factor: {default!r}\ndefault_acceleration_scaling_factor: {default!r}\n"
        "joint_limits:\n  joint1: {max_velocity: 4, max_acceleration: 8, max_jerk: 16}\n"
        "  joint2: {max_acceleration: 9, max_jerk: 27}\n",
    )
    factors = {"velocity_scaling": velocity, "acceleration_scaling": acceleration} if given_too else {}
    robot = Robot.from_urdf(arm, limits=limits, jerk_scaling=jerk, **factors)
    v, a = (velocity, acceleration) if given_too else (default, default)
    np.testing.assert_allclose(robot.limits.velocity, [4 * v, 2 * v], rtol=1e-15)
    np.testing.assert_allclose(robot.limits.acceleration, [8 * a, 9 * a], rtol=1e-15)
    np.testing.assert_allclose(robot.limits.jerk, [16 * jerk, 27 * jerk], rtol=1e-15)


@pytest.mark.parametrize(
    ("known", "body", "expected"),
    [
        (KNOWN, "max_velocity: 5", {"velocity": 5.0}),  # wider than the URDF, as MoveIt does
        (KNOWN, "max_velocity: 1e-3", {"velocity": 1e-3}),
        (KNOWN, "max_jerk: 7, has_jerk_limits: true", {"jerk": 7.0}),
        (KNOWN, "has_acceleration_limits: true", {}),
        (KNOWN, "has_acceleration_limits: false, max_acceleration: 0", {"acceleration": None}),
        (KNOWN, "has_velocity_limits: false", {"velocity": None}),
        (KNOWN, "has_position_limits: false", {"position": None}),
        (KNOWN, "min_position: -0.5", {"position": (-0.5, 1.0)}),
        (KNOWN, "max_position: 9", {"position": (-1.0, 9.0)}),
        (BARE, "max_position: 9", {"position": None}),
        (KNOWN, "max_deceleration: 1.5", {"acceleration": 1.5}),
        (KNOWN, "max_acceleration: 6, max_deceleration: -5", {"acceleration": 5.0}),  # Pilz's sign
        (KNOWN, "max_acceleration: 6, max_deceleration: 7", {"acceleration": 6.0}),
        (KNOWN, "has_deceleration_limits: false, max_deceleration: 0", {}),
        (BARE, "max_deceleration: 5", {}),  # the acceleration is still asked for
        (KNOWN, "soft_lower_limit: -0.2, soft_upper_limit: 5", {"position": (-0.2, 1.0)}),
        (KNOWN, "has_soft_limits: false, soft_lower_limit: -0.2", {}),
        (KNOWN, "max_effort: 80, has_effort_limits: true, k_velocity: 1, k_position: 2", {}),
        (KNOWN, "angle_wraparound: false", {}),
        (KNOWN, "max_velocity: !degrees 90", {"velocity": math.pi / 2}),
        (KNOWN, "max_velocity: !radians 2", {"velocity": 2.0}),
        (
            replace(KNOWN, kind=JointKind.CONTINUOUS, position=UNLIMITED),
            "has_position_limits: false",
            {"position": UNLIMITED},
        ),
        (
            replace(KNOWN, kind=JointKind.CONTINUOUS, position=UNLIMITED),
            "min_position: -6, max_position: 6",
            {"position": (-6.0, 6.0)},
        ),
    ],
)
def test_limits_laid_over_those_of_the_urdf(
    known: Joint, body: str, expected: dict[str, object]
) -> None:
    found = _over(known, body)
    assert replace(found, removed=frozenset()) == replace(known, **expected)


def test_the_later_file_counts_key_by_key() -> None:
    first = parse_limits("joint_limits: {j: {max_velocity: 5, max_jerk: 9}}", "a.yaml")
    second = parse_limits("joint_limits: {j: {max_velocity: 4}}", "b.yaml")
    found = laid_over(KNOWN, [first, second])
    assert (found.velocity, found.jerk) == (4.0, 9.0)


def test_the_default_factor_of_the_later_file_counts(tmp_path: Path) -> None:
    arm = written(tmp_path, "arm.urdf", planar(1.0))
    files = [
        written(tmp_path, f"{k}.yaml", f"default_velocity_scaling_factor: 0.{k}\n") for k in (5, 2)
    ]
    assert Robot.from_urdf(arm, limits=files).joints[0].velocity == 0.2 * 2.0


def test_limits_of_a_follower_reach_its_leader(tmp_path: Path) -> None:
    follower = joint("g", "b", "c", more='<mimic joint="j" multiplier="4"/>')
    arm = written(tmp_path, "arm.urdf", urdf('<link name="a"/>', joint("j", "a", "b"), follower))
    limits = written(
        tmp_path, "l.yaml", "joint_limits: {j: {max_jerk: 9}, g: {max_velocity: 2, max_jerk: 8}}"
    )
    (leader,) = Robot.from_urdf(arm, limits=limits).joints
    assert (leader.velocity, leader.jerk, leader.position) == (0.5, 2.0, (-0.75, 0.75))


def test_nodes_of_a_ros2_control_file() -> None:
    text = """
controller_manager:
  ros__parameters:
    update_rate: 500
cell:
  joint_trajectory_controller:
    ros__parameters:
      joints: [j, k]
      constraints: {goal_time: 0.0, j: {goal: 0.1}}
      joint_limits:
        j: {has_velocity_limits: true, max_velocity: 2.0}
/**:
  ros__parameters:
    joint_limits:
      j: {has_velocity_limits: true, max_velocity: 2.0}
      k: {max_velocity: 3.0}
"""
    found = parse_limits(text, "x.yaml")
    assert {name: e.values["max_velocity"].number() for name, e in found.joints.items()} == {
        "j": 2.0,
        "k": 3.0,
    }
    with pytest.raises(InputError, match=r"line 1[45]: .*max_velocity: 3.0, but 2.0 on line 11"):
        parse_limits(
            text.replace("max_velocity: 2.0}\n      k", "max_velocity: 3.0}\n      k"), "x.yaml"
        )


FAULTS = [
    (
        "joint_limit:\n  j: {}\n",
        "x.yaml: line 2: joint_limit: unknown key; the nearest known one is 'joint_limits'",
    ),
    (
        "joint_limits:\n  j:\n    max_velocty: 1\n",
        "x.yaml: line 3: joint_limits.j.max_velocty: unknown key; the nearest known one is 'max_velocity'",
    ),
    (
        "joint_limits:\n  j: {max_velocity: fast}\n",
        "x.yaml: line 2: joint_limits.j.max_velocity: expected a number, got 'fast'",
    ),
    ("joint_limits:\n  j: {max_velocity: true}\n", "expected a number, got True"),
    ("joint_limits:\n  j: {max_velocity: '1'}\n", "expected a number, got '1'"),
    ("joint_limits:\n  j: {max_velocity: [1]}\n", "expected a number, got a list of 1"),
    ("joint_limits:\n  j: {max_velocity: }\n", "expected a number, got nothing"),
    ("joint_limits:\n  j: {max_velocity: .nan}\n", "nan is not a finite number"),
    ("joint_limits:\n  j: {max_velocity: -.inf}\n", "-inf is not a finite number"),
    ("joint_limits:\n  j: {max_velocity: 1e300}\n", "1e+300 is beyond 1e+09"),
    ("joint_limits:\n  j: {max_velocity: " + "9" * 5000 + "}\n", "inf is not a finite number"),
    (
        "joint_limits:\n  j: {max_velocity: -1}\n",
        "joint 'j': -1 is not a limit; it must be 1e-09 or more",
    ),
    ("joint_limits:\n  j: {max_velocity: 0}\n", "has_velocity_limits: false where there is none"),
    ("joint_limits:\n  j: {max_velocity: 1e-12}\n", "1e-12 is not a limit"),
    ("joint_limits:\n  j: {has_velocity_limits: 1}\n", "expected true or false, got 1.0"),
    (
        "joint_limits:\n  j: {min_position: 2, max_position: 1}\n",
        "joint 'j': lowest position 2 is not below the highest, 1",
    ),
    (
        "joint_limits:\n  j: {angle_wraparound: true, min_position: 2}\n",
        "joint 'j': given beside angle_wraparound: true",
    ),
    (
        "joint_limits:\n  j: {max_velocity: 1}\n  j: {max_velocity: 2}\n",
        "x.yaml: line 3: key 'j' is given twice",
    ),
    (
        "joint_limits:\n  j: {max_velocity: 1, max_velocity: 1}\n",
        "line 2: key 'max_velocity' is given twice",
    ),
    ("joint_limits:\n  j: 5\n", "joint_limits.j: expected keys with values, got 5.0"),
    ("joint_limits: [1]\n", "joint_limits: expected keys with values, got a list of 1"),
    ("- 1\n", "expected keys with values, got a list of 1"),
    (
        "default_velocity_scaling_factor: 1.5\n",
        "default_velocity_scaling_factor: 1.5 is not a factor above 0, up to 1",
    ),
    (
        "default_velocity_scaling_facto: 1\n",
        "the nearest known one is 'default_velocity_scaling_factor'",
    ),
    ("joint_limits: {}\n", "has neither joint_limits nor a scaling factor"),
    (
        "node:\n  ros__parameters: {update_rate: 5}\n",
        "no node has joint_limits among its ros__parameters",
    ),
    (
        "node:\n  ros__parameters: {joint_limit: 5}\n",
        "node.ros__parameters.joint_limit: unknown key; the nearest known one is 'joint_limits'",
    ),
    ("node:\n  ros__parameters: {joint_limits: {j: {max_speed: 1}}}\n", "max_speed: unknown key"),
    ("cartesian_limits: {max_trans_vel: 1}\njoint_limits: {}\n", "cartesian_limits: unknown key"),
    ("joint_limits:\n  j: {max_velocity: !degree 90}\n", "tag '!degree'; known: !degrees, !radians"),
    ("joint_limits:\n  j: {max_velocity: !degrees fast}\n", "!degrees: expected a number, got 'fast'"),
    ("joint_limits: &a\n  j: {max_velocity: 1}\n", "anchor '&a': anchors are not read"),
    ("a: 1\nb: *a\n", "alias '*a': aliases are not read"),
    ("joint_limits:\n  ? [a]\n  : 1\n", "a key must be a name"),
    ("joint_limits:\n  <<: {}\n", "merge keys << are not read"),
    ("joint_limits: {j: {max_velocity: 1}\n", "not valid YAML"),
    ("joint_limits: {j: {max_velocity: 1}}\n---\na: 1\n", "a second document begins"),
    ("# nothing\n", "holds no values"),
]


@pytest.mark.parametrize(("text", "reason"), FAULTS)
def test_faults_are_named_in_one_line(text: str, reason: str) -> None:
    with pytest.raises(InputError) as caught:
        laid_over(BARE, [parse_limits(text, "x.yaml")])
    assert reason in str(caught.value)
    assert str(caught.value).startswith("x.yaml: ")
    assert len(str(caught.value)) < 350


def test_joints_that_the_robot_does_not_have() -> None:
    found = parse_limits("joint_limits: {panda_joint1: {max_velocity: 1}}", "x.yaml")
    with pytest.raises(
        InputError, match=r"no joint 'panda_joint1'; the nearest known one is 'panda_joint2'"
    ):
        check_names(found, {"panda_joint2": BARE, "fixed": None})
    with pytest.raises(
        InputError, match="joint 'panda_joint1' of the URDF does not move along one axis"
    ):
        check_names(found, {"panda_joint1": None})


def test_degrees_for_a_prismatic_joint_are_refused(tmp_path: Path) -> None:
    arm = written(
        tmp_path, "a.urdf", urdf('<link name="a"/>', joint("lift", "a", "b", kind="prismatic"))
    )
    limits = written(tmp_path, "l.yaml", "joint_limits: {lift: {max_velocity: !degrees 90}}")
    with pytest.raises(
        InputError, match="joint 'lift' is prismatic; its limits are in m, not in degrees"
    ):
        Robot.from_urdf(arm, limits=limits)
