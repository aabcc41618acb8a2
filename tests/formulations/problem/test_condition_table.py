"""The table [conditions]: what it means, and every mistake in it is one clear line."""

from __future__ import annotations

import math

import numpy as np
import pytest
from problem_texts import message

from formulations import Limits, Problem, parse
from formulations.problem.toml_file.keys import CONDITION_KEYS, SEGMENT_KEYS, WAYPOINT_KEYS

DEG = math.pi / 180.0

PLAIN = """
unit = "deg"
joints = ["base", "rail"]
prismatic = "rail"
waypoints = [[0, 0.0], [90, 0.1], [45, 0.2], [0, 0.0]]

[limits]
velocity = {base = 90, rail = [-0.5, 0.25]}
acceleration = [[-300, 200], 4]
jerk = 2000
position = [[-170, 170], [-1, 1]]
"""

WHOLE = (
    PLAIN
    + """
[conditions]
tolerance = {base = 2}
stops = [2]
total = 9
start_velocity = [-10, 0.25]
end_velocity = "free"
start_acceleration = {base = 20}
end_acceleration = 0

[[conditions.waypoint]]
at = 1
tolerance = [1, 0.01]
pass = 2.5
window = [2, inf]
wait = 0.5
stop = true

[[conditions.waypoint]]
at = 3
window = [0, 9]

[[conditions.segment]]
from = 0
time = [0.5, inf]
limits = {velocity = {base = 45}, unit = "deg", jerk = [1000, 1]}

[[conditions.segment]]
from = 2
least_time = 1
limits = {position = {base = [-inf, 100]}, acceleration = [[-100, 50], [-1, 1]]}
"""
)


def of(text: str) -> Problem:
    return parse(text)


def test_limits_may_differ_between_the_directions() -> None:
    limits = of(PLAIN).limits
    speeds, steepest = limits.intervals
    np.testing.assert_allclose(speeds, [[-90 * DEG, 90 * DEG], [-0.5, 0.25]], rtol=1e-15)
    np.testing.assert_allclose(steepest, [[-300 * DEG, 200 * DEG], [-4.0, 4.0]], rtol=1e-15)
    np.testing.assert_allclose(limits.velocity, [90 * DEG, 0.5], rtol=1e-15)
    assert not limits.symmetric


def test_pairs_that_are_the_same_in_both_directions_are_plain_limits() -> None:
    text = "waypoints = [[0, 0], [1, 1]]\n[limits]\nvelocity = [[-2, 2], [-1, 1]]"
    assert of(text) == of(text.replace("[[-2, 2], [-1, 1]]", "[2, 1]"))
    assert of(text).plain


def test_the_whole_table_means_what_it_says() -> None:
    problem = of(WHOLE)
    asked = problem.conditions
    assert set(asked.tolerance) == {1, 2}
    np.testing.assert_allclose(asked.tolerance[1], [DEG, 0.01], rtol=1e-15)
    np.testing.assert_allclose(asked.tolerance[2], [2 * DEG, 0.0], rtol=1e-15)
    assert (asked.stops, asked.total, asked.cyclic) == ({1, 2}, 9.0, False)
    assert (asked.passage, asked.waits) == ({1: 2.5}, {1: 0.5})
    assert asked.windows == {1: (2.0, math.inf), 3: (0.0, 9.0)}
    assert asked.segment_times == {0: (0.5, math.inf), 2: (1.0, math.inf)}
    np.testing.assert_allclose(asked.start_velocity, [-10 * DEG, 0.25], rtol=1e-15)
    np.testing.assert_allclose(asked.start_acceleration, [20 * DEG, 0.0], rtol=1e-15)
    assert (asked.end_velocity, np.asarray(asked.end_acceleration).tolist()) == ("free", [0.0, 0.0])


def test_limits_of_a_segment_lie_over_those_of_the_problem() -> None:
    problem = of(WHOLE)
    whole, first, last = problem.limits, *(problem.conditions.segment_limits[k] for k in (0, 2))
    expected = Limits.of(
        [[-45, 45], [-0.5, 0.25]], [[-300, 200], [-4, 4]], [1000, 1], [[-170, 170], [-1, 1]],
        dof=2, unit="deg", units=problem.units,
    )  # fmt: skip
    for mine, its in zip(first.intervals, expected.intervals, strict=True):
        np.testing.assert_allclose(mine, its, rtol=1e-15)
    np.testing.assert_allclose(first.jerk, expected.jerk, rtol=1e-15)
    np.testing.assert_array_equal(first.position, whole.position)
    np.testing.assert_array_equal(last.velocity_interval, whole.velocity_interval)
    np.testing.assert_allclose(last.position, [[-np.inf, 100 * DEG], [-1, 1]])
    np.testing.assert_allclose(last.intervals[1], [[-100 * DEG, 50 * DEG], [-1, 1]], rtol=1e-15)


def test_a_number_is_the_zone_of_every_inner_waypoint_and_of_every_joint() -> None:
    problem = of(
        "waypoints = [[0, 0], [1, 1], [2, 1], [0, 0]]\n[limits]\nvelocity = 1\n"
        "[conditions]\ntolerance = 0.1\ncyclic = true"
    )
    assert {k: zone.tolist() for k, zone in problem.conditions.tolerance.items()} == {
        1: [0.1, 0.1],
        2: [0.1, 0.1],
    }
    assert problem.conditions.cyclic


def test_an_empty_table_asks_for_nothing() -> None:
    assert of(PLAIN + "[conditions]") == of(PLAIN)
    assert of(
        PLAIN.replace("velocity = {base = 90, rail = [-0.5, 0.25]}", "velocity = 1")
    ).conditions.none


def test_conditions_go_with_a_family_that_the_file_names() -> None:
    problem = of('family = "3-5-3"\n' + WHOLE)
    assert (problem.family, problem.conditions.none) == ("3-5-3", False)


def test_every_key_is_read() -> None:
    rows = [line.split(" = ")[0] for line in WHOLE.splitlines() if " = " in line]
    assert {*CONDITION_KEYS, *WAYPOINT_KEYS, *SEGMENT_KEYS} - {"cyclic", "waypoint", "segment"} <= set(
        rows
    )


def asking(lines: str) -> str:
    return f"{PLAIN}\n[conditions]\n{lines}\n"


def at(lines: str) -> str:
    return asking(f"[[conditions.waypoint]]\nat = 1\n{lines}")


def segment(lines: str) -> str:
    return asking(f"[[conditions.segment]]\nfrom = 1\n{lines}")


MISTAKES = {
    "an unknown key": (asking("tolerence = 1"), ["conditions", "tolerence", "did you mean tolerance?"]),
    "an unknown key of a waypoint": (at("windows = [0, 1]"), ["conditions.waypoint 1", "did you mean window?"]),
    "an unknown key of a segment": (segment("limit = {}"), ["conditions.segment 1", "did you mean limits?"]),
    "an unknown key of its limits": (
        segment("limits = {velocities = 1}"),
        ["conditions.segment 1.limits", "did you mean velocity?"],
    ),
    "an unknown joint": (asking("tolerance = {bass = 1}"), ["conditions.tolerance", "did you mean base?"]),
    "no table": ("conditions = 1\n" + PLAIN, ["conditions", "table", "1"]),
    "tables of conditions": (PLAIN + "[[conditions]]\ntotal = 1", ["conditions", "table"]),
    "a waypoint that is no table": (asking("waypoint = [1]"), ["conditions.waypoint 1", "table", "1"]),
    "waypoints in one table": (PLAIN + "[conditions.waypoint]\nat = 1", ["[[conditions.waypoint]]"]),
    "at missing": (asking("[[conditions.waypoint]]\nwait = 1"), ["conditions.waypoint 1", "at", "missing"]),
    "from missing": (asking("[[conditions.segment]]\nleast_time = 1"), ["segment 1", "from", "missing"]),
    "at twice": (
        at("wait = 1\n[[conditions.waypoint]]\nat = 1\nstop = true"),
        ["conditions.waypoint 2", "at = 1", "twice"],
    ),
    "from twice": (
        segment("least_time = 1\n[[conditions.segment]]\nfrom = 1\nleast_time = 2"),
        ["conditions.segment 2", "from = 1", "twice"],
    ),
    "nothing asked": (at(""), ["at = 1", "nothing", "tolerance"]),
    "at a fraction": (asking("[[conditions.waypoint]]\nat = 1.5\nwait = 1"), ["at", "1.5", "whole"]),
    "at below 0": (asking("[[conditions.waypoint]]\nat = -1\nwait = 1"), ["at", "-1", "whole"]),
    "at true": (asking("[[conditions.waypoint]]\nat = true\nwait = 1"), ["at", "True", "whole"]),
    "at beyond the last": (asking("[[conditions.waypoint]]\nat = 4\npass = 1"), ["waypoint 4", "0 to 3"]),
    "from the last": (asking("[[conditions.segment]]\nfrom = 3\nleast_time = 1"), ["segment 3", "0 to 2"]),
    "a stop twice": (asking("stops = [1, 1]"), ["conditions.stops", "1", "twice"]),
    "a stop in text": (asking('stops = ["1"]'), ["conditions.stops", "'1'"]),
    "stops a number": (asking("stops = 1"), ["conditions.stops", "list", "1"]),
    "a negative zone": (asking("tolerance = {rail = -0.1}"), ["conditions.tolerance", "joint rail", "-0.1 m"]),
    "a negative zone in deg": (asking("tolerance = -3"), ["joint base", "-3 deg", "no distance"]),
    "an infinite zone": (asking("tolerance = inf"), ["conditions.tolerance", "inf"]),
    "a zone of too many": (asking("tolerance = [1, 1, 1]"), ["conditions.tolerance", "3 values", "2 joints"]),
    "a zone in text": (asking('tolerance = "1"'), ["conditions.tolerance", "'1'", "number"]),
    "a state in words": (asking('end_velocity = "fre"'), ["conditions.end_velocity", "'fre'", '"free"']),
    "a state over the limit": (
        asking("start_velocity = [0, 0.3]"),
        ["conditions.start_velocity", "joint rail", "0.3 m/s", "0.25 m/s"],
    ),
    "cyclic a number": (asking("cyclic = 1"), ["conditions.cyclic", "1", "true or false"]),
    "cyclic and free": (
        asking('cyclic = true\nend_velocity = "free"'),
        ["conditions.cyclic", "end_velocity"],
    ),
    "cyclic but open": (
        asking("cyclic = true").replace("[0, 0.0]]", "[1, 0.0]]"),
        ["conditions.cyclic", "joint base", "1 deg", "0 deg"],
    ),
    "stop a text": (at('stop = "yes"'), ["conditions.waypoint 1.stop", "'yes'", "true or false"]),
    "a total of zero": (asking("total = 0"), ["conditions.total", "0"]),
    "a total of inf": (asking("total = inf"), ["conditions.total", "inf"]),
    "a window of one": (at("window = 1"), ["conditions.waypoint 1.window", "[earliest, latest]", "1"]),
    "a window the wrong way round": (at("window = [3, 1]"), ["windows", "waypoint 1", "[3, 1]"]),
    "a window of NaN": (at("window = [nan, 1]"), ["conditions.waypoint 1.window", "nan"]),
    "a window from inf": (at("window = [inf, inf]"), ["windows", "waypoint 1", "inf"]),
    "a pass outside its window": (at("pass = 1\nwindow = [2, 3]"), ["waypoint 1", "1 s", "[2.0, 3.0]"]),
    "a wait of zero": (at("wait = 0"), ["waits", "waypoint 1", "0 s"]),
    "a wait at the end": (asking("[[conditions.waypoint]]\nat = 3\nwait = 1"), ["waypoint 3", "end"]),
    "a time in text": (segment('time = ["0", 1]'), ["conditions.segment 1.time", "'0'"]),
    "two times": (segment("time = [0, 1]\nleast_time = 1"), ["segment 1.least_time", "beside time"]),
    "limits of a segment that are none": (segment("limits = 1"), ["conditions.segment 1.limits", "table"]),
    "a limit of zero": (
        segment("limits = {velocity = {rail = 0}}"),
        ["conditions.segment 1.limits.velocity", "joint rail", "0 m/s", "not positive"],
    ),
    "a pair without 0": (
        segment("limits = {velocity = {base = [10, 20]}}"),
        ["conditions.segment 1.limits.velocity", "joint base", "[10, 20] deg/s", "0 inside"],
    ),
    "an unknown unit of a segment": (segment('limits = {unit = "grad"}'), ["segment 1.limits.unit", "grad"]),
    "jerk taken away": (segment("limits = {jerk = inf}"), ["segment 1", "jerk", "both must be finite"]),
    "a pair of jerks": (PLAIN.replace("jerk = 2000", "jerk = [[-1, 2], 3]"), ["limits.jerk", "[-1, 2]"]),
    "a pair of the wrong length": (
        PLAIN.replace("[-0.5, 0.25]", "[-0.5, 0, 0.25]"),
        ["limits.velocity", "joint rail", "[least, greatest]"],
    ),
    "a pair of limits without 0": (
        PLAIN.replace("[-0.5, 0.25]", "[0.1, 0.25]"),
        ["limits.velocity", "joint rail", "[0.1, 0.25] m/s", "0 inside"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_in_the_conditions_is_one_line_that_names_key_and_value(mistake: str) -> None:
    text, words = MISTAKES[mistake]
    line = message(text)
    for word in words:
        assert word in line, line
