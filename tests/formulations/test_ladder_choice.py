"""Rungs by choice, a time limit for all of them, and problems that are too large."""

from __future__ import annotations

import time

import numpy as np
import pytest

from formulations import RUNGS, InputError, Limits, Problem, free_form, free_form_bound, ladder, load
from formulations.problem.errors import UnsupportedProblem
from formulations.rungs import LARGE, usual_rungs, with_needs, without

SR4C = load("sr4c")


def line(n: int) -> Problem:
    return Problem.of(np.arange(float(n))[:, None], Limits.of(1.0, 2.0, 10.0, dof=1))


def test_only_what_was_asked_for_is_computed_in_order_and_told_as_it_ends() -> None:
    told: list[str] = []
    found = ladder(SR4C, rungs=["free_form", "free_form_lower"], finished=lambda r: told.append(r.key))
    assert set(found.rungs) == {"free_form", "free_form_lower"}
    assert told == ["free_form", "free_form_lower"]
    assert found.optimum is None
    assert (found.seconds("free_form_lower") or 0.0) <= (found.seconds("free_form") or 0.0)


def test_a_rung_brings_what_it_needs_and_goes_with_it() -> None:
    assert set(with_needs(["toppra_family_path"])) == {"family", "toppra_family_path"}
    left = without(RUNGS, ["family"])
    assert not {"family", "family_lower", "family_longest_segment", "copp_family_path"} & set(left)
    assert "free_form" in left
    with pytest.raises(InputError, match="'free' is not known"):
        ladder(SR4C, rungs=["free"])


def test_the_family_is_on_demand_for_large_problems() -> None:
    assert usual_rungs(line(LARGE + 1)) == tuple(RUNGS)
    assert "family" not in usual_rungs(line(LARGE + 2))
    assert "free_form" in usual_rungs(line(LARGE + 2))


def test_no_time_leaves_rows_that_say_so_and_an_interrupt_too() -> None:
    for options, word in (({"time_limit": 0.0}, "time limit"), ({"stop": lambda: True}, "interrupted")):
        found = ladder(SR4C, **options)  # type: ignore[arg-type]
        assert set(found.rungs) == set(RUNGS)
        assert all(rung.status == "failed" and word in rung.note for rung in found.rungs.values())


@pytest.mark.long
def test_a_time_limit_holds_for_all_rungs_together() -> None:
    ladder(
        load("z1"), time_limit=2.0
    )  # the search for the bound of B-splines is compiled at its first use
    begun = time.perf_counter()
    found = ladder(load("z1"), time_limit=2.0)
    assert time.perf_counter() - begun < 20.0
    assert found.rungs["displacement"].status == "ok"


def test_too_many_waypoints_are_refused_at_once() -> None:
    many = line(80_000)
    begun = time.perf_counter()
    for search in (free_form, free_form_bound, ladder):
        with pytest.raises(UnsupportedProblem, match="waypoints: 80000 are too many") as refusal:
            search(many)  # type: ignore[operator]
        assert "\n" not in str(refusal.value)
    assert time.perf_counter() - begun < 10.0
