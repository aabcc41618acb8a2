"""The ladder: the order of the bounds, what is said where there is none, and its JSON."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from conftest import SOLVED, climbed, problems
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from formulations import (
    FAMILIES,
    REFERENCES,
    RUNGS,
    Ladder,
    Limits,
    Problem,
    check,
    ladder,
    load,
    parse,
)
from formulations.climb import Climb
from formulations.references import Outcome, Rung, RungKind

KINDS = {key: rung.kind for key, rung in RUNGS.items()}
AGREED = {  # keys and kinds that other programs read; new ones may join
    "displacement": "lower",
    "ruckig_end_to_end": "lower",
    "free_form_lower": "lower",
    "free_form": "upper",
    "ruckig_stop_and_go": "upper",
    "family_lower": "lower",
    "family": "upper",
    "family_longest_segment": "upper",
    "toppra_family_path": "reference",
    "toppra_cubic": "reference",
    "toppra_torque": "reference",
    "copp_family_path": "reference",
}
LOWER_OF_ALL = ("displacement", "ruckig_end_to_end", "free_form_lower")
UPPER_OF_ALL = ("free_form", "ruckig_stop_and_go", "family", "family_longest_segment")
ORDER = [
    *((low, high) for low in LOWER_OF_ALL for high in UPPER_OF_ALL),
    ("free_form", "ruckig_stop_and_go"),
    ("free_form", "family"),
    ("family_lower", "family"),
    ("family", "family_longest_segment"),
    ("displacement", "free_form_lower"),
    ("ruckig_end_to_end", "free_form_lower"),
]
SLACK = 1e-9


def in_order(found: Ladder) -> None:
    """Every fact of the ladder that both numbers of which are known."""
    for low, high in ORDER:
        least, most = found.seconds(low), found.seconds(high)
        if least is not None and most is not None:
            assert least <= most * (1.0 + SLACK) + 1e-15, (low, high)
    path, family = found.seconds("toppra_family_path"), found.seconds("family")
    if path is not None and family is not None:
        error = found.rungs["toppra_family_path"].note.split("grid error ")
        slack = float(error[1].split(";")[0]) if len(error) > 1 else 0.0
        assert path <= family * (1.0 + max(1e-3, 4.0 * slack))


def whole(found: Ladder) -> None:
    """What holds of every rung of every ladder."""
    assert list(found.rungs) == list(KINDS)
    for key, rung in found.rungs.items():
        assert rung.key == key
        assert rung.kind == KINDS[key]
        assert rung.status in ("ok", "not-applicable", "failed")
        assert (rung.seconds is not None) == (rung.status == "ok"), key
        assert rung.runtime >= 0.0
        assert len(rung.note.splitlines()) <= 1
        if rung.status != "ok":
            assert rung.note, key
            assert not rung.certified
        else:
            assert rung.seconds is not None
            assert math.isfinite(rung.seconds)
            assert rung.seconds >= 0.0
    # what is called an upper bound is a motion, judged here again
    for key, motion in found.trajectories.items():
        verdict = check(found.problem, motion, through=key != "ruckig_end_to_end")
        assert verdict.feasible, (key, verdict.faults)
        assert verdict.seconds == pytest.approx(found.seconds(key), rel=1e-9)
    for key, times in found.durations.items():
        assert found.rungs[key].status == "ok"
        assert times.sum() == pytest.approx(found.seconds(key), rel=1e-9, abs=1e-12)
    for key in ("family", "family_longest_segment"):
        if key in found.durations and found.problem.moving_joints:
            again = FAMILIES[found.problem.family].trajectory(found.problem, found.durations[key])
            assert check(found.problem, again).feasible


def strict(found: Ladder) -> dict[str, Any]:
    """The JSON as another program reads it."""
    text = json.dumps(found.to_json(), allow_nan=False)
    read = json.loads(text)
    assert set(read) == {"problem", "ladder", "durations", "versions"}
    assert list(read["ladder"]) == list(KINDS)
    for key, rung in read["ladder"].items():
        assert list(rung) == ["seconds", "kind", "status", "certified", "runtime", "note"]
        assert rung["kind"] == KINDS[key]
        assert rung["seconds"] is None or isinstance(rung["seconds"], float)
        assert isinstance(rung["certified"], bool)
        assert isinstance(rung["runtime"], float)
        assert isinstance(rung["note"], str)
        assert rung["seconds"] == found.seconds(key)
    assert set(read["durations"]) <= set(KINDS)
    for times in read["durations"].values():
        assert all(isinstance(time, float) for time in times)
    assert all(isinstance(version, str) for version in read["versions"].values())
    assert {"python", "numpy", "scipy", "casadi", "ruckig", "toppra"} <= set(read["versions"])
    return dict(read)


# --- the list of rungs ---------------------------------------------------------------------------


def test_the_agreed_keys_are_in_the_list_in_their_order() -> None:
    assert {key: KINDS[key] for key in KINDS if key in AGREED} == AGREED
    assert [key for key in KINDS if key in AGREED] == list(AGREED)


@pytest.mark.parametrize("key", RUNGS)
def test_every_rung_says_what_it_is(key: str) -> None:
    rung = RUNGS[key]
    assert rung.key == key
    assert rung.name
    assert rung.meaning
    assert len(rung.meaning.splitlines()) == len(rung.name.splitlines()) == 1
    assert set(rung.after) < set(RUNGS)
    assert not (rung.certified and rung.kind == "reference")
    assert (key in REFERENCES) == (rung.takes == "problem")


def test_an_upper_bound_whose_motion_breaks_a_limit_is_failed() -> None:
    """Whoever made the motion: the ladder checks it itself."""
    problem = parse("waypoints = [[0], [1]]\n[limits]\nvelocity = 1\nacceleration = 1\njerk = 4")
    motion = ladder(problem).trajectories["ruckig_stop_and_go"]

    def too_fast(problem: Problem) -> Outcome:
        return Outcome.ok(motion.seconds / 2.0, trajectory=motion.stretched(0.5))

    rung = Rung("mine", RungKind.UPPER, "mine", "a motion", too_fast, certified=True)
    found = Climb(problem).run({"mine": rung}, lambda key: None).rungs["mine"]
    assert (found.status, found.seconds, found.certified) == ("failed", None, False)
    assert "over the limit" in found.note


# --- shipped cases --------------------------------------------------------------------------------


@pytest.mark.parametrize("case", SOLVED)
def test_the_bounds_of_a_shipped_case_are_in_order(case: str) -> None:
    found = climbed(case)
    whole(found)
    in_order(found)
    for key in ("displacement", "free_form_lower", "family", "family_longest_segment"):
        assert found.rungs[key].status == "ok", found.rungs[key]
    assert found.rungs["toppra_family_path"].status == "ok"
    assert found.rungs["toppra_cubic"].status == "ok"
    limited = load(case).limits.has_acceleration
    for key in ("ruckig_end_to_end", "ruckig_stop_and_go"):
        assert found.rungs[key].status == ("ok" if limited else "not-applicable")


@pytest.mark.parametrize("case", SOLVED)
def test_the_json_of_a_shipped_case_is_strict_and_has_the_agreed_keys(case: str) -> None:
    read = strict(climbed(case))
    assert read["problem"] == case
    assert len(read["durations"]["family"]) == load(case).n_segments


def test_lower_bounds_and_verified_motions_are_certified_and_references_are_not() -> None:
    found = climbed("sr4c")
    certified = {key for key, rung in found.rungs.items() if rung.certified}
    motions = {"ruckig_stop_and_go", "family", "family_longest_segment"}
    assert {"displacement", "ruckig_end_to_end", "free_form_lower"} | motions <= certified
    assert not certified & {"toppra_family_path", "toppra_cubic", "copp_family_path"}


def test_the_family_rung_shows_how_many_starts_agree() -> None:
    assert climbed("sr4c").rungs["family"].note == "3-5-3; one start"
    found = ladder(load("sr4c"), starts=3, rungs=["family", "family_lower"])
    assert found.rungs["family"].note == "3-5-3; 3 of 3 starts agree"
    assert found.seconds("family") == pytest.approx(climbed("sr4c").seconds("family"), rel=1e-9)
    assert "gap 1e-07" in found.rungs["family_lower"].note


def test_the_papers_rule_shows_what_it_claims_and_that_it_breaks_the_limits() -> None:
    found = climbed("sr4c")
    rung = found.rungs["family_longest_segment"]
    assert "claims 4.5375" in rung.note
    assert "stretch of 1.120" in rung.note
    assert len(found.alone) == 6


def test_the_same_seed_gives_the_same_ladder() -> None:
    text = "waypoints = [[0], [1], [3]]\n[limits]\nvelocity = 2\nacceleration = 1"
    first, again = ladder(parse(text), seed=3), ladder(parse(text), seed=3)
    for key, rung in first.rungs.items():
        assert again.rungs[key].seconds == rung.seconds
        assert again.rungs[key].status == rung.status
        assert again.rungs[key].note == rung.note


def test_progress_names_every_rung_once() -> None:
    seen: list[str] = []
    ladder(
        parse("waypoints = [[0], [1]]\n[limits]\nvelocity = 1\nacceleration = 1"), progress=seen.append
    )
    assert sorted(seen) == sorted(KINDS)


def test_a_bound_that_is_not_asked_for_is_not_proved() -> None:
    text = "waypoints = [[0], [1], [3]]\n[limits]\nvelocity = 2\nacceleration = 1"
    found = ladder(parse(text), certify=False)
    assert found.bound is None
    assert found.rungs["family_lower"].status == "not-applicable"
    assert found.rungs["family_lower"].note == "not asked for"
    assert found.rungs["family"].status == "ok"


# --- problems that leave rungs empty --------------------------------------------------------------


def test_two_waypoints_have_no_family_but_the_other_rungs() -> None:
    problem = parse("waypoints = [[0, 0], [1, 2]]\n[limits]\nvelocity = 1\nacceleration = 1\njerk = 4")
    found = ladder(problem)
    whole(found)
    in_order(found)
    strict(found)
    assert found.rungs["family"].status == "not-applicable"
    assert "2 segments" in found.rungs["family"].note
    for key in ("family_longest_segment", "toppra_family_path"):
        assert found.rungs[key].status == "not-applicable"
    for key in ("displacement", "ruckig_end_to_end", "free_form_lower", "ruckig_stop_and_go"):
        assert found.rungs[key].status == "ok"
    # 2 rad at 1 rad/s, 1 rad/s^2, 4 rad/s^3: 2 + 1 + 1/4; without jerk 3
    assert found.seconds("ruckig_stop_and_go") == pytest.approx(3.25, rel=1e-12)
    assert found.seconds("ruckig_end_to_end") == found.seconds("ruckig_stop_and_go")
    assert found.seconds("toppra_cubic") == pytest.approx(3.0, rel=5e-4)


def test_with_velocity_alone_the_displacement_is_the_infimum_and_ruckig_has_no_meaning() -> None:
    problem = parse("waypoints = [[0], [1], [3], [2]]\n[limits]\nvelocity = 2")
    found = ladder(problem)
    whole(found)
    in_order(found)
    strict(found)
    assert found.seconds("displacement") == 2.0
    assert found.seconds("free_form_lower") == 2.0
    assert found.seconds("free_form") == pytest.approx(2.0, rel=1e-5)
    assert "displacement" in found.rungs["free_form_lower"].note
    for key in ("ruckig_end_to_end", "ruckig_stop_and_go"):
        assert found.rungs[key].status == "not-applicable"
        assert "acceleration" in found.rungs[key].note


@pytest.mark.parametrize("case", ["sr4c", "ur5", pytest.param("z1", marks=pytest.mark.long)])
def test_the_fastest_motion_and_its_bound_meet(case: str) -> None:
    found = climbed(case)
    lower, upper = found.seconds("free_form_lower"), found.seconds("free_form")
    assert lower is not None
    assert upper is not None
    assert lower <= upper * (1.0 + SLACK)
    assert upper <= lower * (1.0 + 1e-5)
    for key in ("displacement", "ruckig_end_to_end", "ruckig_stop_and_go", "family"):
        assert found.seconds(key) != lower


@pytest.mark.parametrize("rows", [2, 3, 4, 6])
def test_a_problem_in_which_nothing_moves_has_a_ladder(rows: int) -> None:
    problem = Problem.of(np.full((rows, 2), 0.4), Limits.of(1.0, 1.0, 1.0, dof=2))
    found = ladder(problem)
    whole(found)
    in_order(found)
    strict(found)
    for key in ("displacement", "ruckig_end_to_end", "free_form_lower", "ruckig_stop_and_go"):
        assert found.seconds(key) == 0.0
    assert found.seconds("toppra_cubic") == 0.0
    if rows > 2:
        assert found.rungs["family"].status == "ok"
        family = found.seconds("family")
        assert family is not None
        assert family < 1e-6


def test_a_family_without_a_feasible_motion_is_a_failed_rung() -> None:
    """The cube reaches the limit with speed and has to overshoot; Ruckig stops there and does not."""
    limits = Limits.of(1.0, 1.0, position=[[0.0, 1.0]], dof=1)
    found = ladder(Problem.of([[0.0], [1.0], [0.0], [1.0]], limits), starts=2)
    whole(found)
    in_order(found)
    strict(found)
    assert found.rungs["family"].status == "failed"
    assert "position limits" in found.rungs["family"].note
    assert found.rungs["family_longest_segment"].status == "not-applicable"
    assert found.rungs["ruckig_stop_and_go"].status == "ok"


def test_seconds_and_names_that_are_odd_survive_json() -> None:
    problem = parse(
        'name = "naïve \\"quoted\\"\\n name"\nwaypoints = [[0], [1]]\n[limits]\nvelocity = 1'
    )
    assert strict(ladder(problem))["problem"] == problem.name


# --- made-up problems -----------------------------------------------------------------------------


@pytest.mark.slow
@given(problem=problems(segments=st.sampled_from([1, 2, 3, 3, 4]), reach=(-2.0, 1.0), position=True))
@settings(max_examples=5, phases=(Phase.explicit, Phase.generate))
def test_the_bounds_of_a_made_up_problem_are_in_order(problem: Problem) -> None:
    found = ladder(problem)
    whole(found)
    in_order(found)
    strict(found)


def test_a_wrong_rung_would_be_noticed() -> None:
    """The facts above can fail: swap two rungs and they do."""
    found = climbed("sr4c")
    rungs = dict(found.rungs)
    rungs["displacement"], rungs["family"] = rungs["family"], rungs["displacement"]
    wrong = Ladder(found.problem, rungs, {}, {}, found.optimum, found.alone)
    with pytest.raises(AssertionError):
        in_order(wrong)
    with pytest.raises(AssertionError):
        whole(wrong)
