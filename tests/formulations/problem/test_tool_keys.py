"""The keys of limits on the tool in problem files, there and back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tool_problems import two_links

from formulations import Conditions, InputError, load, parse, save
from formulations.arms import load_arm

TEXT = """
arm = "ur5"
unit = "deg"
waypoints = [[0, -60, 60, 0, 30, 0], [35, -40, 35, 10, 5, 25], [65, -70, 75, -15, 10, 5]]
[limits]
velocity = 180
acceleration = 600
[conditions]
tool_speed = 0.5
[[conditions.waypoint]]
at = 1
tool_radius = 0.03
[[conditions.segment]]
from = 1
tool_speed = 0.25
"""


def test_every_key_of_the_tool_is_read() -> None:
    problem = parse(TEXT)
    asked = problem.conditions
    assert (asked.tool_speed, asked.segment_tool_speed, asked.tool_zones) == (0.5, {1: 0.25}, {1: 0.03})
    assert problem.tool == load_arm("ur5").tool
    assert asked.asked == ("tool_speed", "segment_tool_speed", "tool_zones")
    assert asked.tool_speeds(2).tolist() == [0.5, 0.25]
    np.testing.assert_array_equal(asked.boxes(6)[1], np.full(6, 0.1))


def test_a_file_written_reads_the_same(tmp_path: Path) -> None:
    problem = parse(TEXT)
    save(problem, tmp_path / "mine.toml")
    assert load(tmp_path / "mine.toml") == problem


def test_a_tool_that_no_file_can_name_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="tool: it is that of no shipped arm"):
        save(two_links(Conditions(tool_speed=1.0)), tmp_path / "mine.toml")


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('arm = "ur5"', "", "conditions.tool_speed: 0.5 m/s needs to know where the tool is"),
        ("tool_speed = 0.5", "tool_speed = -1", "conditions.tool_speed: -1.0 is no positive number"),
        ("tool_radius = 0.03", 'tool_radius = "wide"', "conditions.waypoint 1.tool_radius"),
        ("tool_radius", "tool_radios", "tool_radius"),
        ('arm = "ur5"', 'arm = "ur6"', "arm: 'ur6' is not known"),
    ],
)
def test_misuse_is_one_line_with_the_key(old: str, new: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        parse(TEXT.replace(old, new, 1))
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_waypoints_of_another_number_of_joints_than_the_arm_are_refused() -> None:
    with pytest.raises(InputError, match="arm: ur5 has 6 joints, the waypoints 1"):
        parse('arm = "ur5"\nwaypoints = [[0], [1]]\n[limits]\nvelocity = 1\n')
