"""Every entry of every registry keeps the conditions of a problem, or refuses them by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from compare.benchmark.grade import Run, grade
from compare.benchmark.objective import CODINGS, Objective, search_box
from compare.benchmark.suite.chosen import chosen
from compare.studies.time_split import run_and_split
from formulations import (
    CASES,
    FAMILIES,
    REFERENCES,
    RUNGS,
    Conditions,
    Limits,
    Problem,
    UnsupportedProblem,
    check,
    chord_lengths,
    each_joint_alone,
    family_bound,
    family_optimum,
    ladder,
    load,
    longest_segment,
    proved_optimum,
    save,
)
from formulations.families.population_times import PopulationTimes
from formulations.references.reference import Takes

PLAIN = Problem(
    [[0.0, 0.0], [1.0, -0.5], [0.4, 0.3], [0.0, 0.0]],
    {"velocity": [1.0, 1.5], "acceleration": [3.0, 4.0], "jerk": [30.0, 40.0]},
)
SLOW = Limits.of([0.5, 0.5], [2.0, 2.0], [20.0, 20.0], dof=2)
ASKED = {
    "tolerance": Conditions(tolerance={1: np.array([0.1, 0.2])}),
    "passage": Conditions(passage={1: 4.0}),
    "windows": Conditions(windows={2: (5.0, 9.0)}),
    "segment_times": Conditions(segment_times={1: (3.0, np.inf)}),
    "total": Conditions(total=12.0),
    "stops": Conditions(stops=frozenset({1})),
    "waits": Conditions(waits={2: 0.5}),
    "start_velocity": Conditions(start_velocity=np.array([0.3, 0.0])),
    "end_velocity": Conditions(end_velocity="free"),
    "start_acceleration": Conditions(start_acceleration=np.array([0.5, 0.0])),
    "end_acceleration": Conditions(end_acceleration="free"),
    "cyclic": Conditions(cyclic=True),
    "segment_limits": Conditions(segment_limits={0: SLOW}),
}
PROBLEMS = {
    **{key: replace(PLAIN, conditions=asked) for key, asked in ASKED.items()},
    "one direction": replace(
        PLAIN, limits=Limits.of([[-1.0, 0.8], [-1.5, 1.5]], [3.0, 4.0], [30.0, 40.0], dof=2)
    ),
}
DURATIONS = np.array([1.5, 1.5, 1.5])
PATH = FAMILIES["3-5-3"].trajectory(PLAIN, DURATIONS)

METHODS: dict[str, Callable[[Problem], Any]] = {
    **{f"optimum of {name}": lambda p, f=name: family_optimum(p, family=f) for name in FAMILIES},
    **{f"bound of {name}": lambda p, f=name: family_bound(p, family=f) for name in FAMILIES},
    **{f"splines of {name}": lambda p, f=name: FAMILIES[f].trajectory(p, DURATIONS) for name in FAMILIES},
    **{
        f"times of {name}": lambda p, f=name: PopulationTimes(FAMILIES[f], p, stretched=True)
        for name in FAMILIES
    },
    **{
        f"reference {key}": (
            (lambda p, r=rung: r.find(p, PATH)) if rung.takes is Takes.PATH else rung.find
        )
        for key, rung in RUNGS.items()
        if rung.takes is not Takes.CLIMB and not rung.knows_conditions
    },
    **{
        f"grade, {coding}": lambda p, c=coding: grade(Run("a", c, "pso", 0, 50, 10), p, 1.0)
        for coding in CODINGS
    },
    "proved optimum": proved_optimum,
    "each joint alone": each_joint_alone,
    "longest segment": lambda p: longest_segment(p, [DURATIONS]),
    "chord lengths": chord_lengths,
    "objective": lambda p: Objective(p, stretch=True),
    "search box": search_box,
    "split": lambda p: run_and_split(p, "pso", ["stretched"], seed=0, budget=50, population=10),
}  # fmt: skip


@pytest.mark.parametrize("asked", PROBLEMS)
@pytest.mark.parametrize("method", METHODS)
def test_a_method_that_knows_no_conditions_refuses_them(method: str, asked: str) -> None:
    words = "the two directions" if asked == "one direction" else f"conditions.{asked}"
    with pytest.raises(UnsupportedProblem, match=words):
        METHODS[method](PROBLEMS[asked])


def test_the_methods_are_all_those_of_the_registries() -> None:
    assert {key for key, rung in RUNGS.items() if rung.knows_conditions} == {
        "displacement", "free_form", "free_form_lower", "toppra_torque",
    }  # fmt: skip
    named = " ".join(METHODS)
    assert all(f"reference {key}" in named for key in REFERENCES if not RUNGS[key].knows_conditions)
    assert all(load(case).plain for case in CASES)  # those who make problems of cases need no guard


@pytest.mark.parametrize("asked", PROBLEMS)
def test_a_rung_keeps_the_conditions_or_says_that_it_knows_none(asked: str) -> None:
    problem = PROBLEMS[asked]
    answer = ladder(problem, time_limit=60.0)
    lower = 0.0
    for key, rung in RUNGS.items():
        found = answer.rungs[key]
        if not rung.knows_conditions:
            assert (found.status, found.seconds) == ("not-applicable", None), key
            assert found.note.startswith(f"unsupported: {key}: knows no "), found.note
            continue
        if key == "toppra_torque":
            assert (found.status, found.note) == ("not-applicable", "no torque limits")
            continue
        assert found.status == "ok", (key, found.note)
        assert found.seconds is not None
        if rung.kind == "lower":
            lower = max(lower, found.seconds)
        else:
            assert check(problem, answer.trajectories[key]).feasible
    assert 0.0 < lower <= answer.rungs["free_form"].seconds * (1.0 + 1e-9)


def test_the_comparison_of_swarms_refuses_a_file_with_conditions(tmp_path: Any) -> None:
    path = str(tmp_path / "mine.toml")
    save(replace(PROBLEMS["waits"], name="mine"), path)
    with pytest.raises(UnsupportedProblem, match=r"--cases: .*mine.toml: .* conditions.waits"):
        chosen([path])
