"""Free-form motions whose time is known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from conftest import problems
from free_form_helpers import OPTIMA, motion, seconds_of
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import Conditions, Limits, Problem, check, free_form, load
from formulations.optima.free_form.nlp.assembly import assemble
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.optima.free_form.stop_and_go import stop_and_go_motion
from formulations.proofs.rest_to_rest import rest_to_rest


@given(problem=problems(segments=1, max_dof=6, limited=("va", "vaj"), reach=(-6.0, 3.0), position=True))
@settings(max_examples=25)
def test_two_waypoints_take_as_long_as_the_slowest_joint_alone(problem: Problem) -> None:
    found = free_form(problem)
    d, limits = np.abs(problem.displacements[0]), problem.limits.derivatives
    slowest = max(rest_to_rest(d[j], *limits[:, j]) for j in range(problem.dof))
    assert found.seconds == pytest.approx(slowest, rel=1e-6)
    assert found.seconds <= seconds_of("ruckig_stop_and_go", problem)


@pytest.mark.parametrize("jerk", [20.0, math.inf])
def test_waypoints_on_a_line_cost_nothing(jerk: float) -> None:
    # every joint moves in proportion and one way: the motion end to end passes all waypoints
    shares = np.sort(np.random.default_rng(1).uniform(0.0, 1.0, 6))
    shares = (shares - shares[0]) / (shares[-1] - shares[0])
    problem = Problem.of(shares[:, None] * [3.0, -1.0, 2.0], Limits.of(2.0, 5.0, jerk, dof=3))
    assert free_form(problem, tolerance=1e-6).seconds == pytest.approx(
        rest_to_rest(3.0, 2.0, 5.0, jerk), rel=1e-6
    )


def test_there_and_back_keeps_its_acceleration_at_the_turn() -> None:
    # by symmetry v = 0 at the turn; jerk +J for t, then -J for u: v = 0 gives u = (1 + sqrt 2) t
    d, jerk = 1.0, 10.0
    ratio = 1.0 + math.sqrt(2.0)
    unit = 1.0 / 6.0 + ratio / 2.0 + ratio**2 / 2.0 - ratio**3 / 6.0
    seconds = 2.0 * (1.0 + ratio) * math.cbrt(d / (jerk * unit))
    problem = Problem.of([[0.0], [d], [0.0]], Limits.of(100.0, 1000.0, jerk, dof=1))
    found = free_form(problem, tolerance=1e-6)
    assert found.seconds == pytest.approx(seconds, rel=1e-7)
    assert found.seconds < 0.95 * seconds_of("ruckig_stop_and_go", problem)


def test_without_a_jerk_limit_a_joint_that_turns_must_stop() -> None:
    # joint 1 turns at the waypoint and is always the slower: two trapezoids, 2 sqrt(d / A) each
    problem = Problem.of([[0.0, 0.0], [1.0, 0.1], [0.0, 0.2]], Limits.of(10.0, 4.0, dof=2))
    assert free_form(problem, tolerance=1e-6).seconds == pytest.approx(4.0 * math.sqrt(0.25), rel=1e-8)


@pytest.mark.parametrize(("problem", "seconds"), OPTIMA, ids=[problem.name for problem, _ in OPTIMA])
def test_optima_of_the_shipped_cases(problem: Problem, seconds: float) -> None:
    assert free_form(problem, tolerance=1e-6).seconds == pytest.approx(seconds, abs=1e-7)
    assert free_form(problem).seconds == pytest.approx(seconds, rel=1e-5)


@pytest.mark.parametrize("case", ["cobot", "bagging"])
def test_velocity_limits_alone_are_met_at_the_displacement_bound(case: str) -> None:
    problem = load(case)
    found = free_form(problem)
    lower = seconds_of("displacement", problem)
    assert lower < found.seconds <= lower * (1.0 + 4e-6)
    assert check(problem, motion(found)).feasible
    assert any("infimum" in note for note in found.notes)


@pytest.mark.parametrize(("jerk", "least"), [(50.0, 720.0), (math.inf, 12.0)])
def test_smoothest_motion_is_close_to_the_calculus_of_variations(jerk: float, least: float) -> None:
    # rest to rest in T: least integral of jerk^2 is 720 d^2 / T^5, of acceleration^2 12 d^2 / T^3
    d, seconds = 1.5, 3.0
    problem = Problem.of([[0.0], [d]], Limits.of(5.0, 20.0, jerk, dof=1))
    found = motion(free_form(problem, conditions=Conditions(total=seconds)))
    order = 3 if math.isfinite(jerk) else 2
    squares = found.at(found.breaks[:-1] + 0.5 * found.durations, order)[:, 0] ** 2
    cost = float(squares @ found.durations) * seconds ** (2 * order - 1) / d**2
    assert least <= cost * (1.0 + 1e-9)
    assert cost == pytest.approx(least, rel=0.02)


@given(
    problem=problems(
        segments=st.integers(1, 5), max_dof=4, limited=("va", "vaj", "vj"), reach=(-6.0, 3.0)
    )
)
@settings(max_examples=80)
def test_stop_and_go_in_closed_form(problem: Problem) -> None:
    task = ConditionedProblem(problem, Conditions())
    if not task.n_segments:
        return
    whole = assemble(task, stop_and_go_motion(task))
    verdict = check(problem, whole.stretched(1.0 + 1e-7))
    assert verdict.feasible, verdict.faults
    limits = problem.limits.derivatives
    # an acceleration limit that is out of reach stands for none
    top = np.where(np.isfinite(limits[1]), limits[1], 1e6 * np.sqrt(limits[0] * limits[2]))
    legs = [
        max(rest_to_rest(abs(d), limits[0, j], top[j], limits[2, j]) for j, d in enumerate(row))
        for row in problem.displacements
    ]
    if np.isfinite(limits[1]).all():
        assert whole.seconds == pytest.approx(sum(legs), rel=1e-9)
