"""The instances: the same on every machine, feasible, spread over families and arms."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands_run import ROOT
from hypothesis import given
from hypothesis import strategies as st

from compare.benchmark.suite import Instance, Split, chosen, suite
from compare.benchmark.suite.arms import arm_sheets
from compare.benchmark.suite.draws import Draws
from formulations import CASES, FAMILIES, InputError, load

PINNED = (ROOT / "tests" / "data" / "suite_digests.txt").read_text().splitlines()


@pytest.fixture(scope="module")
def sixty() -> list[Instance]:
    return suite()


def test_the_sixty_are_pinned(sixty: list[Instance]) -> None:
    """A changed number changes a digest: results of two versions would no longer be about one task."""
    assert [f"{one.digest} {one.split} {one.name}" for one in sixty] == PINNED


def test_however_many_are_asked_for_the_first_stay_the_same(sixty: list[Instance]) -> None:
    more = suite(75)
    assert more[:60] == sixty
    assert suite(7) == sixty[:7]
    assert len({one.digest for one in more}) == len({one.name for one in more}) == 75


def test_two_in_five_are_open_in_every_family_and_of_every_arm(sixty: list[Instance]) -> None:
    assert Counter(one.split for one in sixty) == {Split.open: 24, Split.held_out: 36}
    for key in (lambda one: one.problem.family, lambda one: one.origin.split()[-1]):
        for group in {key(one) for one in sixty}:
            mine = [one for one in sixty if key(one) == group]
            if len(mine) >= 5:
                share = sum(one.split is Split.open for one in mine) / len(mine)
                assert 0.3 <= share <= 0.55, group


def test_the_suite_has_every_family_size_arm_and_kind_of_limit(sixty: list[Instance]) -> None:
    drawn = [one for one in sixty if one.origin.startswith("drawn")]
    assert {one.problem.family for one in drawn} == set(FAMILIES)
    assert {one.problem.n_segments for one in drawn} == set(range(3, 9))
    assert {one.origin.split()[1] for one in drawn} == set(arm_sheets())
    kinds = {(one.problem.limits.has_jerk, one.problem.limits.has_position) for one in drawn}
    assert len(kinds) == 4
    assert {one.name for one in sixty if one.origin == "paper"} == set(CASES)


def test_a_drawn_problem_is_feasible_and_has_the_limits_of_its_arm(sixty: list[Instance]) -> None:
    for one in sixty:
        if not one.origin.startswith("drawn"):
            continue
        sheet = arm_sheets()[one.origin.split()[1]]
        limits, problem = one.problem.limits, one.problem
        np.testing.assert_array_equal(limits.velocity, sheet.velocity)
        np.testing.assert_array_equal(limits.acceleration, sheet.acceleration)
        assert problem.units == sheet.units
        assert sheet.source in one.source
        assert sheet.assumed in one.source
        low, high = np.array(sheet.position).T
        assert (problem.waypoints > low).all()
        assert (problem.waypoints < high).all()
        assert len(problem.moving_joints) == problem.dof
        if limits.has_position:
            # the exact extremes, not the kernel that placed the waypoints
            motion = FAMILIES[problem.family].trajectory(problem, np.ones(problem.n_segments))
            extremes = motion.extremes(0)
            assert (extremes.low >= low).all()
            assert (extremes.high <= high).all()


def test_a_perturbed_case_is_near_its_case(sixty: list[Instance]) -> None:
    found = [one for one in sixty if one.origin.startswith("perturbed")]
    assert len(found) == 12
    for one in found:
        case = load(one.origin.split()[1])
        moved = np.abs(one.problem.waypoints - case.waypoints)
        assert (moved <= 0.03 * np.ptp(case.waypoints, axis=0) + 1e-4).all()
        assert one.problem.moving_joints == case.moving_joints
        np.testing.assert_array_equal(one.problem.limits.position, case.limits.position)
        ratio = one.problem.limits.velocity / case.limits.velocity
        assert (np.abs(ratio - 1.0) < 0.051).all()
        assert not np.array_equal(one.problem.waypoints, case.waypoints)


def test_plain_data_makes_the_same_instance(sixty: list[Instance]) -> None:
    for one in sixty:
        data = json.loads(json.dumps(one.to_json(), allow_nan=False))
        again = Instance.from_json(data)
        assert again.digest == one.digest
        assert again.to_json() == one.to_json()


def test_plain_data_of_another_problem_is_refused(sixty: list[Instance]) -> None:
    data = sixty[0].to_json()
    data["problem"]["waypoints"][1][0] += 1e-9
    with pytest.raises(InputError, match="its digest is"):
        Instance.from_json(data)
    del data["problem"]["limits"]["velocity"]
    with pytest.raises(InputError, match="velocity"):
        Instance.from_json(data)


@given(low=st.integers(-(10**9), 10**9), width=st.integers(0, 10**9), name=st.text(max_size=5))
def test_draws_stay_in_their_range_and_repeat(low: int, width: int, name: str) -> None:
    first, again = ([s.between(low, low + width) for _ in range(5)] for s in (Draws(name), Draws(name)))
    assert first == again
    assert all(low <= value <= low + width for value in first)


def test_draws_are_uniform_and_never_change() -> None:
    stream = Draws("a name")
    assert [stream.between(0, 999) for _ in range(4)] == DRAWN
    counts = Counter(stream.between(0, 9) for _ in range(20000))
    assert len(counts) == 10
    assert all(1800 < count < 2200 for count in counts.values())


DRAWN = [490, 889, 427, 26]

MINE = """
name = "{name}"
waypoints = [[0.0, 0.0], [1.0, 0.5], [0.2, 0.9]]
[limits]
velocity = 1.0
acceleration = 2.0
"""


def test_problem_files_stand_beside_shipped_cases(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(MINE.format(name="press 7"))
    mine, shipped = chosen([str(file), "cobot"])
    assert (mine.name, mine.split, mine.origin) == ("press 7", Split.own, "file")
    assert shipped.problem == load("cobot")
    assert Instance.from_json(mine.to_json()).problem == replace(mine.problem, source=str(file))


@pytest.mark.parametrize(
    ("name", "words"), [("sr4c", "that of a shipped case"), ("../up", "names files too")]
)
def test_a_name_that_cannot_be_used_is_refused(tmp_path: Path, name: str, words: str) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(MINE.format(name=name))
    with pytest.raises(InputError, match=words):
        chosen([str(file)])


def test_two_instances_of_one_name_are_refused(tmp_path: Path) -> None:
    for stem in ("a", "b"):
        (tmp_path / f"{stem}.toml").write_text(MINE.format(name="one"))
    with pytest.raises(InputError, match="two instances"):
        chosen([str(tmp_path / "a.toml"), str(tmp_path / "b.toml")])
