"""What a paper published, beside what is known of its task."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from graded_runs import graded

from compare.benchmark.known_times import SWARMS, table_of_known_times
from compare.benchmark.records.rows import Row
from formulations import CASES, FAMILIES, load
from metaheuristics import ALGORITHMS


def ladder_of(**seconds: float | None) -> dict[str, object]:
    kinds = {"family_lower": "lower", "free_form_lower": "lower"}
    return {
        "ladder": {
            key: {"seconds": value, "kind": kinds.get(key, "upper"), "note": "" if value else "why not"}
            for key, value in seconds.items()
        }
    }


def rows_of(case: str, times: list[float | None]) -> list[Row]:
    row = graded(load("sr4c"), 4.7, "shared", "random", 0, 30).row
    return [
        replace(row, case=case, coding=coding, swarm=swarm, seed=seed, seconds=t)
        for seed, t in enumerate(times)
        for coding in ("stretched", "published")
        for swarm in (SWARMS[case], "random")
    ]


def test_every_case_has_a_swarm_that_exists() -> None:
    assert set(SWARMS) == set(CASES)
    assert set(SWARMS.values()) <= set(ALGORITHMS)


def test_ur5_is_slowed_down_by_the_exact_stretch() -> None:
    problem = load("ur5-corrected")
    ladder = ladder_of(family=42.5705, family_lower=42.57, free_form=None)
    lines = table_of_known_times(problem, ladder, rows_of("ur5-corrected", [45.0, 44.0, None, 46.0]))
    told = {line.what: line for line in lines}
    # Table 6's longest times
    times = np.array([2.94, 3.918, 1.195])
    stretch = FAMILIES["3-5-3"].stretch(problem, times[None])[0]
    assert told["published (ISSA)"].seconds == pytest.approx(8.053)
    assert told["published (ISSA)"].keeps is False
    slowed = told["the same (ISSA), made feasible"]
    assert slowed.seconds == pytest.approx(8.053 * stretch)
    assert slowed.seconds == pytest.approx(99.64, abs=0.01)
    assert told["its swarm (issa) with the exact stretch"].seconds == pytest.approx(45.0)
    assert told["the spline family's optimum"].keeps is True
    assert told["no spline of the family is faster"].keeps is None
    assert (told["the fastest motion known"].seconds, told["the fastest motion known"].note) == (
        None,
        "why not",
    )


def test_what_does_not_add_up_says_so() -> None:
    lines = table_of_known_times(load("cobot"), ladder_of(family=3.9), [])
    published, feasible, swarm, _ = lines
    assert published.seconds == pytest.approx(3.139)
    assert published.note == "its times add up to 4.1358 s; the motion with these times is judged"
    # they keep the limit that is assumed for the case
    assert published.keeps is True
    assert feasible.seconds == pytest.approx(4.1358)
    assert swarm.note == "not run"


def test_without_waypoints_nothing_is_judged() -> None:
    lines = table_of_known_times(load("z1"), ladder_of(), [])
    assert [line.seconds for line in lines[:2]] == [11.71, 13.08]
    assert all(line.keeps is None for line in lines[:2])


def test_a_problem_of_ones_own_has_no_paper() -> None:
    problem = load("sr4c").joint(0)
    lines = table_of_known_times(problem, ladder_of(family=2.42), [])
    assert [line.seconds for line in lines] == [None, 2.42]
