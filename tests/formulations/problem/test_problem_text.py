"""A problem that is written and read again is the same problem, conditions included."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from conditioned_problems import conditioned_problems
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tool_problems import random_chain, two_links

from compare.benchmark.records.instances import instance_digest, plain_problem, problem_of
from compare.benchmark.records.provenance import problem_digest
from formulations import CASES, Conditions, InputError, Limits, Problem, load, parse, save
from formulations.problem.toml_file.problem_text import problem_text

SLOW = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow], max_examples=150)


@SLOW
@given(problem=conditioned_problems())
def test_a_file_that_is_written_reads_as_an_equal_problem(problem: Problem) -> None:
    assert parse(problem_text(problem)) == problem


@SLOW
@given(problem=conditioned_problems())
def test_a_stored_problem_is_an_equal_problem(problem: Problem) -> None:
    stored = json.loads(json.dumps(plain_problem(problem), allow_nan=False))
    assert problem_of(stored) == problem
    assert problem_of(stored).display_unit == problem.display_unit


@pytest.mark.parametrize("case", CASES)
def test_every_case_is_written_in_its_unit_where_that_is_exact(case: str) -> None:
    problem = load(case)
    text = problem_text(problem)
    assert parse(text) == problem
    assert "[conditions]" not in text


def test_degrees_stay_degrees_where_they_give_the_same_numbers(tmp_path: Path) -> None:
    problem = Problem([[0], [90]], {"velocity": 90}, unit="deg")
    save(problem, tmp_path / "mine.toml")
    assert 'unit = "deg"' in (tmp_path / "mine.toml").read_text("utf-8")
    assert load(tmp_path / "mine.toml") == problem


def test_limits_of_some_joints_are_written_by_name_or_refused() -> None:
    some = Limits.of(1.0, [2.0, np.inf], dof=2)
    named = Problem([[0, 0], [1, 1]], some, names=["a b", "c"])
    assert parse(problem_text(named)) == named
    with pytest.raises(InputError, match=r"names: missing: .* limits.acceleration"):
        problem_text(Problem([[0, 0], [1, 1]], some))


def test_conditions_and_limits_of_one_direction_change_every_fingerprint() -> None:
    plain = Problem([[0.0], [1.0], [0.5]], {"velocity": 1.0, "acceleration": 2.0})
    others = [
        Problem(plain.waypoints, {"velocity": [[-1.0, 0.9]], "acceleration": 2.0}),
        Problem(plain.waypoints, {"velocity": 1.0, "acceleration": [[-1.5, 2.0]]}),
        Problem(plain.waypoints, plain.limits, conditions=Conditions(waits={1: 0.5})),
        Problem(plain.waypoints, plain.limits, conditions=Conditions(waits={1: 0.6})),
        Problem(plain.waypoints, plain.limits, conditions=Conditions(end_velocity="free")),
        Problem(plain.waypoints, plain.limits, conditions=Conditions(tolerance={1: np.array([0.1])})),
    ]
    for digest in (problem_digest, instance_digest):
        assert len({digest(one) for one in (plain, *others)}) == len(others) + 1


def test_fingerprints_of_plain_problems_are_those_of_earlier_versions() -> None:
    assert problem_digest(load("sr4c")) == "d80b1c8f6438"
    assert instance_digest(load("sr4c")) == "be73c10459d9a84c"


@SLOW
@given(seed=st.integers(0, 10_000), speed=st.booleans())
def test_a_stored_problem_under_a_limit_on_the_tool_keeps_its_chain(seed: int, speed: bool) -> None:
    rng = np.random.default_rng(seed)
    chain = random_chain(rng, 3, 5)
    asked = Conditions(
        tool_speed=0.3 if speed else None,
        segment_tool_speed={1: 1.0 / 3.0} if speed else {},
        tool_zones={1: 0.1 / 3.0},
    )
    points, limits = rng.normal(size=(3, 3)), {"velocity": 1.0, "acceleration": 2.0}
    problem = Problem(points, limits, tool=chain, conditions=asked)
    stored = json.loads(json.dumps(plain_problem(problem), allow_nan=False))
    again = problem_of(stored)
    assert again == problem
    assert again.tool == chain  # to the last bit
    q = rng.normal(size=(4, 3))
    np.testing.assert_array_equal(again.tool.forward(q), chain.forward(q))
    assert instance_digest(again) == instance_digest(problem)
    # another tool is another problem
    other = Problem(points, limits, tool=chain.extended([0.0, 0.0, 1e-3]), conditions=asked)
    assert other != problem
    for digest in (problem_digest, instance_digest):
        assert digest(other) != digest(problem) == digest(again)


def test_without_conditions_on_it_the_tool_is_no_part_of_what_is_stored() -> None:
    plain = two_links(Conditions())
    assert "tool" not in plain_problem(plain)
    assert problem_of(plain_problem(plain)) == plain


def test_a_stored_chain_that_is_spoilt_is_refused() -> None:
    stored = plain_problem(two_links(Conditions(tool_speed=0.3)))
    del stored["tool"]["chain"][0]["axis"]
    with pytest.raises(ValueError, match="not a problem as it is stored: KeyError"):
        problem_of(stored)
    without = {key: value for key, value in stored.items() if key != "tool"}
    with pytest.raises(InputError, match="needs to know where the tool is"):
        problem_of(without)
