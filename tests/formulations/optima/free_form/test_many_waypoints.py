"""The search in linear time, beside the nonlinear program of the whole motion; and its interrupts."""

from dataclasses import replace

import numpy as np
import pytest

from formulations import Limits, Problem, check, free_form
from formulations.optima.free_form import SearchStatus, many_waypoints
from formulations.proofs.every_motion.attaining_motion.chain_task import ChainTask
from formulations.proofs.every_motion.attaining_motion.reach_rows import ChainPoint, ReachRows
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem


def random_problem(n_waypoints, dof, seed=0):
    rng = np.random.default_rng(seed)
    steps = rng.uniform(-0.5, 0.5, (n_waypoints - 1, dof))
    waypoints = np.concatenate([np.zeros((1, dof)), np.cumsum(steps, axis=0)])
    return Problem(waypoints, Limits.of(velocity=2.0, acceleration=5.0, jerk=50.0, dof=dof))


@pytest.fixture
def always(monkeypatch):
    monkeypatch.setattr(many_waypoints, "MANY", 1)
    monkeypatch.setattr(many_waypoints, "_WIDE", 1)


@pytest.mark.parametrize("seed", range(3))
def test_no_slower_than_the_program_of_the_whole_motion(monkeypatch, always, seed):
    problem = random_problem(12, 2, seed)
    found = free_form(problem, tolerance=1e-5)
    assert found.method == many_waypoints.NAME
    assert check(problem, found.trajectory).feasible
    monkeypatch.setattr(many_waypoints, "MANY", 10_000)
    whole = free_form(problem, tolerance=1e-5)
    assert whole.method != many_waypoints.NAME
    assert found.seconds <= whole.seconds * (1.0 + 1e-4)


@pytest.mark.usefixtures("always")
def test_joints_without_a_jerk_limit():
    waypoints = random_problem(12, 3).waypoints
    limits = Limits.of(velocity=[2.0] * 3, acceleration=[5.0] * 3, jerk=[50.0, np.inf, 50.0], dof=3)
    problem = Problem(waypoints, limits)
    found = free_form(problem)
    assert found.method == many_waypoints.NAME
    assert check(problem, found.trajectory).feasible
    slow = Problem(waypoints, Limits.of(velocity=2.0, acceleration=5.0, jerk=50.0, dof=3))
    assert found.seconds <= free_form(slow).seconds * (1.0 + 1e-3)


def test_takes_over_by_itself_and_passes_every_waypoint():
    problem = random_problem(60, 5)
    found = free_form(problem)
    assert found.method == many_waypoints.NAME
    assert found.status is SearchStatus.OK
    passed = found.trajectory.at(found.trajectory.passage_times)
    assert np.abs(passed - problem.waypoints).max() < 1e-6
    assert found.seconds < 0.8 * found.stages[0].seconds


@pytest.mark.parametrize("calls", [0, 1, 30, 120, 300])
def test_an_interrupt_at_any_stage_leaves_a_verified_motion(always, calls):
    problem, asked = random_problem(20, 3), []

    def stop():
        asked.append(None)
        return len(asked) > calls

    found = free_form(problem, stop=stop)
    assert check(problem, found.trajectory).feasible
    assert found.seconds <= found.stages[0].seconds * (1.0 + 1e-6)


def test_the_time_limit_leaves_a_verified_motion(always):
    problem = random_problem(20, 3)
    found = free_form(problem, time_limit=0.0)
    assert found.status is SearchStatus.TIME_LIMIT
    assert check(problem, found.trajectory).feasible


def test_progress_only_gets_faster(always):
    seen = []
    free_form(random_problem(20, 3), progress=lambda name, seconds: seen.append(seconds))
    assert len(seen) > 2
    assert seen == sorted(seen, reverse=True)


def test_slopes_are_those_of_difference_quotients():
    problem = random_problem(6, 2)
    task = ChainTask.of(RelaxedProblem.of(problem, 100.0, 0.0))
    lower = np.random.default_rng(2).uniform(0.5, 1.0, (3, 5, 2))  # limits of each segment
    limits = (task.velocities, task.accelerations, task.jerks) * lower
    task = replace(task, velocities=limits[0], accelerations=limits[1], jerks=limits[2])
    rows, rng = ReachRows.of(task), np.random.default_rng(1)
    v, a, e = (rng.uniform(-size, size, (6, 2)) for size in (0.3, 0.3, 0.02))
    point = ChainPoint(rng.uniform(0.3, 0.6, 5), v, a, e)
    states = rows.states(point)
    slopes, slack = rows.linearised(rows.coefficients(states), states)
    for i in range(6):
        step = 1e-6 * (states[0] if i == 0 else 1.0)
        near = tuple(value + step * (i == q) for q, value in enumerate(states))
        _, there = rows.linearised(rows.coefficients(near), near)
        assert (slack - there) / 1e-6 == pytest.approx(slopes[:, i], abs=1e-4)


LIMITS = Limits.of(velocity=2.0, acceleration=5.0, jerk=50.0, dof=3)
LINE = np.array([1.0, 0.5, -0.8])


@pytest.mark.parametrize(
    ("count", "step"), [(80, 1e-3), pytest.param(200, 1e-4, marks=pytest.mark.long)]
)
def test_a_dense_line_takes_the_time_between_its_ends(count, step):
    """Without a corner the points between the ends cost nothing: 4 cbrt(d / 2 J) of the longest joint."""
    problem = Problem(np.outer(np.arange(count) * step, LINE), LIMITS)
    found = free_form(problem, time_limit=20.0)
    assert check(problem, found.trajectory).feasible
    assert found.method == many_waypoints.NAME
    least = 4.0 * np.cbrt((count - 1) * step / (2.0 * 50.0))
    assert least * (1.0 - 1e-6) <= found.seconds <= least * (1.0 + 5e-3)


def test_a_dense_path_with_a_corner_beside_the_program_of_the_whole_motion(monkeypatch):
    way = np.concatenate([np.zeros((1, 3)), np.repeat([LINE, -LINE[::-1]], 24, axis=0)])
    problem = Problem(1e-3 * np.cumsum(way, axis=0), LIMITS)
    monkeypatch.setattr(many_waypoints, "_WIDE", 1)
    found = free_form(problem)
    assert found.method == many_waypoints.NAME
    assert found.status is SearchStatus.OK
    monkeypatch.setattr(many_waypoints, "MANY", 10_000)
    assert found.seconds <= free_form(problem).seconds * (1.0 + 1e-2)


@pytest.mark.long
def test_three_hundred_waypoints():
    problem = random_problem(300, 7)
    found = free_form(problem)
    assert found.method == many_waypoints.NAME
    assert found.status is SearchStatus.OK
    assert check(problem, found.trajectory).feasible
    assert found.seconds <= 131.03 * (1.0 + 3e-4)
