"""Tuning: the same effort for each swarm, open instances alone, and never worse than published there."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from graded_runs import optimum
from hypothesis import given
from hypothesis import strategies as st

from compare.benchmark import tuning
from compare.benchmark.grade import Run, grade
from compare.benchmark.plan import runs
from compare.benchmark.protocol import Track, swarms_of
from compare.benchmark.suite import suite
from compare.benchmark.tuning import tuner
from compare.benchmark.tuning.constants import (
    constants_for,
    constants_text,
    read_constants,
)
from compare.benchmark.tuning.ranges import ranges_of
from compare.benchmark.tuning.tuner import tune
from formulations import InputError, load
from metaheuristics import ALGORITHMS

COBOT = next(one for one in suite(6) if one.name == "cobot")
SR4C = next(one for one in suite(6) if one.name == "sr4c")


def posed() -> list[tuple[object, float]]:
    return [(COBOT, optimum("cobot").seconds)]


def test_a_tuned_swarm_is_no_worse_and_the_seed_decides_the_answer() -> None:
    first = tune("whale", posed(), 5, 300, 0)  # type: ignore[arg-type]
    assert first == tune("whale", posed(), 5, 300, 0)  # type: ignore[arg-type]
    _, constants, before, after = first
    assert set(constants) == {"b"}
    assert after <= before
    assert 0.25 <= constants["b"] <= 4.0


def test_every_swarm_has_the_same_number_of_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Run] = []
    real = tuner.grade
    monkeypatch.setattr(tuner, "grade", lambda run, *rest: made.append(run) or real(run, *rest))
    for name in ("pso", "whale", "cma-es"):
        tune(name, posed(), 4, 200, 0)  # type: ignore[arg-type]
    counts = {name: sum(run.swarm == name for run in made) for name in ("pso", "whale", "cma-es")}
    assert set(counts.values()) == {4}
    assert {(run.budget, run.coding, run.track) for run in made} == {(200, "stretched", Track.tuned)}


def test_held_out_instances_are_never_looked_at() -> None:
    with pytest.raises(InputError, match="sr4c: not open"):
        tune("whale", [(COBOT, 3.4), (SR4C, 4.7)], 2, 100, 0)


def test_a_swarm_without_constants_stays_as_it_is() -> None:
    name, constants, before, after = tune("random", posed(), 3, 100, 0)  # type: ignore[arg-type]
    assert (name, constants) == ("random", {})
    assert before == after


def test_ranges_hold_the_published_value_and_leave_switches_and_tolerances_alone() -> None:
    for entry in ALGORITHMS.values():
        found = ranges_of(entry.parameters)
        assert not {"population", "popsize", "tent", "printed", "tol", "xatol", "strategy"} & set(found)
        for name, allowed in found.items():
            assert allowed.low <= entry.parameters[name] <= allowed.high
            assert allowed.low < allowed.high
            assert not allowed.logarithmic or allowed.low > 0.0


names = st.text(st.characters(exclude_categories=("Cs", "Cc")), min_size=1, max_size=8)
values = st.integers(-(10**6), 10**6) | st.floats(-1e6, 1e6, allow_nan=False)


@given(found=st.dictionaries(names, st.dictionaries(names, values, max_size=3), max_size=3))
def test_any_constants_come_back_from_their_file(
    found: dict[str, dict[str, float | int]], tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("tuned") / "tuned.toml"
    path.write_text(constants_text({"command": 'a "b"', "seed": 1}, found), "utf-8")
    assert tomllib.loads(path.read_text("utf-8"))["made"] == {"command": 'a "b"', "seed": 1}
    if found:
        assert read_constants(path) == found


def test_a_file_that_holds_no_constants_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "tuned.toml"
    for text, words in (
        ("", "is empty"),
        ("[made]", "constants: missing"),
        ("[constants.pso]\nw = 'fast'", "pso.w: expected a number, got 'fast'"),
        ("[constants.pso]\nw = nan", "pso.w: nan is not a finite number"),
        ("[constants.pso]\nw = 1e13", "constants.pso.w: 10000000000000.0 is beyond 1e.12"),
        ("[constants", "not valid TOML"),
    ):
        path.write_text(text)
        with pytest.raises(InputError, match=words):
            read_constants(path)


def test_the_plan_lays_tuned_constants_over_the_published_ones() -> None:
    constants = {"pso": {"w": 0.6}, "random": {}}
    plan = runs(
        {"cobot": load("cobot")}, swarms=["pso", "random"], codings=["stretched"],
        tracks=[Track.equal, Track.tuned], seeds=1, evaluations=200, constants=constants,
    )  # fmt: skip
    rows = {(run.swarm, run.track): grade(run, load("cobot"), 3.35).row for run in plan}
    assert '"w": 0.6' in rows["pso", Track.tuned].parameters
    assert '"c1": 1.49618' in rows["pso", Track.tuned].parameters
    assert '"w": 0.7298' in rows["pso", Track.equal].parameters
    assert rows["pso", Track.tuned].variant == "stretched (tuned)"
    assert rows["pso", Track.tuned].durations != rows["pso", Track.equal].durations
    assert rows["random", Track.tuned].durations == rows["random", Track.equal].durations


def test_the_shipped_constants_cover_every_swarm_of_a_suite_and_are_in_range() -> None:
    found = constants_for(swarms_of("suite"))
    for name, constants in found.items():
        ranges = ranges_of(ALGORITHMS[name].parameters)
        assert set(constants) == set(ranges)
        for key, value in constants.items():
            assert 0.999 * ranges[key].low <= value <= 1.001 * ranges[key].high
    shipped = Path(tuning.__file__).with_name("tuned.toml").read_text("utf-8")
    used = tomllib.loads(shipped)["made"]["instances"].split()
    split = {one.name: one.split for one in suite()}
    assert used
    assert {split[name] for name in used} == {"open"}


def test_a_swarm_that_was_not_tuned_is_named() -> None:
    with pytest.raises(InputError, match=r"mine:swarm: not tuned in the shipped constants"):
        constants_for(["pso", "mine:swarm"])
