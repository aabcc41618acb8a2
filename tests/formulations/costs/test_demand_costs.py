"""What demands cost: closed forms of one joint, signs, and intervals that hold what is known."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from formulations import Conditions, Limits, Problem, free_form, load
from formulations.costs import demand_costs as module
from formulations.costs.demand_costs import DemandCost, demand_costs
from formulations.costs.left_out import left_out
from formulations.deadlines import Deadline
from formulations.problem.errors import NoFeasibleMotion, NotFoundInTime
from formulations.proofs.every_motion.bound import free_form_bound

A = 4.0  # rad/s^2
THERE_AND_BACK = Problem.of([[0.0], [1.0], [0.0]], Limits.of(100.0, A, dof=1))
ONE_WAY = Problem.of([[0.0], [0.5], [1.0]], Limits.of(100.0, A, dof=1))


def only(costs: tuple[DemandCost, ...]) -> DemandCost:
    assert len(costs) == 1
    return costs[0]


def holds(cost: DemandCost, truth: float) -> None:
    assert cost.seconds == pytest.approx(truth, abs=1e-4)
    assert cost.least - 1e-12 <= truth <= cost.greatest + 1e-12
    assert cost.greatest - cost.least < 1e-3


def test_a_wait_where_the_joint_turns_back_costs_its_time() -> None:
    cost = only(demand_costs(THERE_AND_BACK, Conditions(waits={1: 0.7})))
    holds(cost, 0.7)
    assert cost.line.startswith("the wait at waypoint 2 costs 0.7 s (proved: at least 0.69")


def test_a_stop_halfway_costs_what_two_motions_take_more_than_one() -> None:
    """Rest to rest over d at A takes 2 sqrt(d / A)."""
    cost = only(demand_costs(ONE_WAY, Conditions(stops=frozenset({1}))))
    holds(cost, 4.0 * np.sqrt(0.5 / A) - 2.0 * np.sqrt(1.0 / A))


def test_a_least_time_costs_what_it_is_above_the_fastest() -> None:
    problem = Problem.of([[0.0], [1.0]], Limits.of(100.0, A, dof=1))
    cost = only(demand_costs(problem, Conditions(segment_times={0: (1.3, np.inf)})))
    holds(cost, 0.3)


def test_a_zone_at_the_end_saves_what_the_shorter_way_saves() -> None:
    problem = Problem.of([[0.0], [1.0]], Limits.of(100.0, A, dof=1))
    cost = only(demand_costs(problem, Conditions(tolerance={1: np.array([0.19])})))
    assert cost.saves
    holds(cost, 2.0 * (1.0 - np.sqrt(0.81)) / np.sqrt(A))


def test_zones_are_counted_together_too() -> None:
    """Each of the two halves of the way there and back is shorter by both zones: sqrt(d) s each."""
    asked = Conditions(tolerance={0: np.array([0.19]), 1: np.array([0.32])})
    costs = demand_costs(THERE_AND_BACK, asked)
    together = next(cost for cost in costs if cost.demand == "zones")
    holds(together, 2.0 - np.sqrt(0.49) - np.sqrt(0.68))
    assert {cost.demand for cost in costs} == {"zones", "zone"}
    assert together.line.startswith("all zones together save ")


def test_a_window_and_a_passage_cost_their_delay() -> None:
    early = np.sqrt(2.0 * 0.5 / A)  # halfway of the fastest motion
    for asked in (Conditions(windows={2: (1.5, 2.0)}), Conditions(windows={1: (early, np.inf)})):
        truth = 0.5 if 2 in asked.windows else 0.0
        holds(only(demand_costs(ONE_WAY, asked)), truth)


def test_the_total_alone_is_named_where_it_is_given() -> None:
    cost = only(demand_costs(ONE_WAY, Conditions(total=2.5, stops=frozenset({1}))))
    assert cost.demand == "total"
    holds(cost, 2.5 - 4.0 * np.sqrt(0.5 / A))


def test_free_ends_save_and_lower_limits_of_one_direction_cost() -> None:
    """From rest over d at A without a halt at the end: sqrt(2 d / A)."""
    free = only(demand_costs(ONE_WAY, Conditions(end_velocity="free")))
    assert free.saves
    holds(free, 2.0 / np.sqrt(A) - np.sqrt(2.0 / A))
    limits = Limits.of(
        100.0, [[-1.0, A]], dof=1
    )  # speeds up over x, slows down over d - x: 4 x = d - x
    lower = only(demand_costs(replace(ONE_WAY, limits=limits)))
    assert (lower.demand, lower.place, lower.saves) == ("asymmetric limit", 0, False)
    top = np.sqrt(2.0 * A * 0.2)
    holds(lower, top / A + top / 1.0 - 2.0 / np.sqrt(A))


def test_a_start_against_the_way_costs() -> None:
    cost = only(demand_costs(ONE_WAY, Conditions(start_velocity=np.array([-1.0]))))
    assert (cost.demand, cost.saves) == ("start state", False)
    assert cost.least > 0.0


def test_limits_of_a_segment_cost_and_a_cycle_saves() -> None:
    slow = Limits.of(0.5, A, dof=1)
    cost = only(demand_costs(ONE_WAY, Conditions(segment_limits={1: slow})))
    assert cost.least > 0.1
    plane = Problem.of([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]], Limits.of(2.0, A, 50.0, dof=2))
    cycle = only(demand_costs(plane, Conditions(cyclic=True)))
    assert cycle.saves
    assert cycle.least > 0.1


def test_every_demand_of_an_arm_has_a_row_that_planning_again_confirms() -> None:
    sr4c = load("sr4c")
    asked = Conditions(tolerance={1: np.full(6, 0.1)}, waits={2: 0.3}, segment_times={0: (1.5, 3.0)})
    costs = demand_costs(sr4c, asked)
    assert len(list(left_out(replace(sr4c, conditions=asked)))) == len(costs)
    assert {cost.demand for cost in costs} == {"zone", "wait", "least time", "greatest time"}
    assert [cost.seconds for cost in costs] == sorted((c.seconds for c in costs), reverse=True)
    wait = next(cost for cost in costs if cost.demand == "wait")
    without = Conditions(tolerance=asked.tolerance, segment_times=asked.segment_times)
    again = free_form(sr4c, conditions=asked).seconds - free_form(sr4c, conditions=without).seconds
    assert wait.seconds == pytest.approx(again, abs=5e-3)
    zone = next(cost for cost in costs if cost.demand == "zone")
    assert zone.saves
    assert zone.to_json()["place"] == 2


def test_where_time_is_over_rows_say_so() -> None:
    (row,) = demand_costs(ONE_WAY, Conditions(end_velocity="free"), deadline=Deadline(0.0))
    assert row.line == "the free velocity at the end: not known, the time was over"
    assert row.to_json()["seconds"] is None
    asked = Conditions(stops=frozenset({1}), end_velocity="free")
    seen: list[str] = []
    costs = demand_costs(
        ONE_WAY, asked, deadline=Deadline(stop=lambda: len(seen) > 1), progress=seen.append
    )
    assert len(seen) == 2
    assert [cost.unknown for cost in costs] == ["", "it was interrupted"]
    assert costs[0].seconds is not None


def test_one_demand_that_takes_long_leaves_time_to_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search without the stop goes on until its deadline; the others end by themselves."""
    found = module.free_form

    def slow(problem: Problem, **options: Any) -> Any:
        if problem.conditions.stops:
            return found(problem, **options)
        time.sleep(options["time_limit"])
        raise NotFoundInTime("no motion was found yet")

    monkeypatch.setattr(module, "free_form", slow)
    asked = Conditions(stops=frozenset({1}), end_velocity="free")
    costs = demand_costs(ONE_WAY, asked, deadline=Deadline(6.0))
    assert {cost.demand: cost.unknown for cost in costs} == {
        "end state": "", "stop": "its share of the time was over",
    }  # fmt: skip


def test_a_demand_without_which_there_is_nothing_to_compare_says_why(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = module.free_form

    def none(problem: Problem, **options: Any) -> Any:
        if problem.conditions.stops:
            return found(problem, **options)
        raise NoFeasibleMotion("no motion at all")

    monkeypatch.setattr(module, "free_form", none)
    (row,) = demand_costs(ONE_WAY, Conditions(stops=frozenset({1})))
    assert (row.seconds, row.unknown) == (None, "nothing can be compared: no motion at all")


def test_a_proof_that_is_given_is_taken_where_it_is_close(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = Conditions(waits={1: 0.7})
    proved = {
        gap: free_form_bound(THERE_AND_BACK, conditions=asked, gap=gap, upper=2.7)
        for gap in (1e-6, 0.5)
    }
    asked_for: list[Any] = []
    prove = module.proved_motion

    def counted(found: Any, **options: Any) -> Any:
        asked_for.append(found)
        return prove(found, **options)

    monkeypatch.setattr(module, "proved_motion", counted)
    for gap, proof in proved.items():
        asked_for.clear()
        cost = only(demand_costs(THERE_AND_BACK, asked, proof=proof))
        assert cost.least == pytest.approx(0.7, abs=2e-4)
        again = 0 if (proof.gap or 0.0) <= 1e-4 else 1
        assert len(asked_for) == 1 + again, gap


def test_without_demands_there_are_no_rows() -> None:
    assert demand_costs(ONE_WAY) == ()


def test_a_bound_that_claims_too_much_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """A planted fault: bounds 10 % too high put the truth outside the interval."""

    def too_high(*args: object, **options: object) -> tuple[object, object]:
        motion, bound = as_it_is(*args, **options)
        return motion, replace(bound, seconds=1.1 * bound.seconds)

    as_it_is = module.proved_motion
    monkeypatch.setattr(module, "proved_motion", too_high)
    cost = only(demand_costs(THERE_AND_BACK, Conditions(waits={1: 0.7})))
    assert not cost.least <= 0.7 <= cost.greatest
