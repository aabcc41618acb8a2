"""What limits on tool and motors cost: closed forms of one joint, and which motors hold nothing up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from small_arms import VERTICAL, pendulum
from small_arms import two_links as two_links_urdf
from tool_problems import LIMITS, hinge, two_links

from formulations import Conditions, Limits, Problem, free_form
from formulations.costs.demand_costs import DemandCost, demand_costs
from formulations.problem.torque import TorqueLimits

pytest.importorskip("pinocchio", reason="pin is not installed (extra dynamics)")
pytest.importorskip("yourdfpy", reason="yourdfpy is not installed (extra robot)")

LEVER = 0.5  # m
POINTS = ((0.0,), (1.0,), (0.3,))
INERTIA = 0.1 + 2.0 * 0.5**2  # of the pendulum about its hinge [kg m^2]


def by_kind(costs: tuple[DemandCost, ...]) -> dict[str, DemandCost]:
    found = {cost.demand: cost for cost in costs}
    assert len(found) == len(costs)
    return found


def seconds(limits: dict[str, float] | Limits, points: object = POINTS) -> float:
    return free_form(Problem(points, limits), tolerance=1e-6).seconds


@pytest.mark.long
def test_the_speed_of_a_hinge_s_tool_costs_what_a_velocity_limit_costs() -> None:
    (cost,) = demand_costs(hinge(LEVER, Conditions(tool_speed=0.6 * LEVER)))
    truth = seconds({**LIMITS, "velocity": 0.6}) - seconds(LIMITS)
    assert (cost.demand, cost.place, cost.saves) == ("tool speed", None, False)
    assert cost.seconds == pytest.approx(truth, rel=5e-3)
    assert 0.0 < cost.least <= truth <= cost.greatest
    assert cost.line.startswith("the limit of the tool's speed costs ")


@pytest.mark.long  # searches and proofs
def test_a_slower_segment_costs_and_a_faster_one_saves() -> None:
    for speed, saves in ((0.15, False), (0.6, True)):
        asked = Conditions(tool_speed=0.3, segment_tool_speed={1: speed})
        cost = by_kind(demand_costs(hinge(LEVER, asked)))["segment tool speed"]
        assert (cost.place, cost.saves) == (1, saves)
        assert cost.seconds > 0.1
        assert 0.0 <= cost.least <= cost.seconds <= cost.greatest
        assert cost.to_json()["place"] == 2


@pytest.mark.long
def test_a_ball_of_the_tool_costs_within_the_zone_and_saves_against_the_point() -> None:
    """A ball of 0.5 mm all but fixes the point: what it saves is what it does not cost, about."""
    for radius, much in ((5e-4, "tool ball"), (0.2, "zone")):
        costs = by_kind(demand_costs(two_links(Conditions(tool_zones={1: radius}))))
        assert set(costs) == {"zone", "tool ball"}
        assert (costs["zone"].saves, costs["tool ball"].saves) == (True, False)
        little = next(kind for kind in costs if kind != much)
        assert costs[much].seconds > 0.02
        assert costs[little].seconds < 0.005


def test_a_torque_limit_costs_what_an_acceleration_limit_costs() -> None:
    """About a vertical axis tau = I a; the bound knows no torque."""
    limits = {"velocity": 3.0, "acceleration": 50.0, "jerk": 60.0}
    asked = Conditions(torque=TorqueLimits(pendulum(VERTICAL), ("hinge",), (4.0 * INERTIA,)))
    problem = Problem(POINTS, limits, names=["hinge"], conditions=asked)
    (cost,) = demand_costs(problem)
    truth = seconds({**limits, "acceleration": 4.0}) - seconds(limits)
    assert cost.demand == "torque"
    assert cost.seconds == pytest.approx(truth, rel=0.02)
    assert cost.least == 0.0
    assert truth <= cost.greatest
    assert cost.line.startswith("the torque limits cost ")
    assert "proved: at most" in cost.line


def test_a_motor_that_is_strong_enough_costs_nothing() -> None:
    limits = Limits.of(velocity=3.0, acceleration=20.0, jerk=200.0, dof=2)
    torque = TorqueLimits(two_links_urdf(), ("one", "two"), (30.0, 40.0))
    points = [[-1.2, 0.3], [-0.4, 1.0], [0.3, -0.5]]
    problem = Problem(points, limits, names=["one", "two"], conditions=Conditions(torque=torque))
    costs = demand_costs(problem)
    motors = {cost.place: cost for cost in costs if cost.demand == "joint torque"}
    assert set(motors) == {0, 1}
    assert motors[0].seconds > 0.005
    assert motors[1].seconds == 0.0
    assert motors[1].line.startswith("joint two's torque limit costs nothing (proved: at most ")
    whole = next(cost for cost in costs if cost.demand == "torque")
    without = free_form(replace(problem, conditions=Conditions()), tolerance=1e-4).seconds
    assert whole.seconds == pytest.approx(free_form(problem).seconds - without, abs=2e-3)
    assert all(np.isfinite([cost.least, cost.greatest]).all() for cost in costs)
