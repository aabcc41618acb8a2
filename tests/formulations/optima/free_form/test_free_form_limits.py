"""Position limits between waypoints, and what each limit costs."""

from __future__ import annotations

import math
from dataclasses import replace

import casadi
import numpy as np
import pytest
from free_form_helpers import JERKY, SR4C, UR5, Z1, motion

from formulations import Conditions, Limits, Problem, check, free_form
from formulations.optima.free_form.nlp.arcs import Arcs
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.optima.free_form.nlp.program import FreeFormNLP


def test_position_limits_are_kept_between_waypoints() -> None:
    # joint 1 swings out of the way of its fast neighbour where it may, and only there
    swing = Limits.of([1.0, 1.0], [1.0, 4.0], [4.0, 40.0], dof=2)
    points = [[0.0, 0.0], [1.0, 0.2], [1.0, 1.2], [0.0, 1.4]]
    free = Problem.of(points, swing)
    wide = motion(free_form(free, tolerance=1e-5))
    top = float(wide.extremes(0).high[:, 0].max())
    assert top > 1.05
    for ceiling in (0.5 * (1.0 + top), 1.0):
        tight = replace(swing, position=np.array([[-1.0, ceiling], [-1.0, 2.0]]))
        held = free_form(Problem.of(points, tight), tolerance=1e-5)
        assert float(motion(held).extremes(0).high[:, 0].max()) <= ceiling + 1e-9
        assert check(Problem.of(points, tight), motion(held)).feasible
        assert wide.seconds < held.seconds < held.stages[0].seconds
    # a limit that is just out of reach changes nothing
    far = replace(swing, position=np.array([[-1.0, top + 1e-3], [-1.0, 2.0]]))
    assert free_form(Problem.of(points, far), tolerance=1e-5).seconds == pytest.approx(
        wide.seconds, rel=1e-5
    )


@pytest.mark.parametrize("order", [2, 3])
def test_guarding_rows_enclose_the_position_at_all_times(order: int) -> None:
    rng = np.random.default_rng(order)
    limits = Limits.of(1.0, 1.0, 1.0 if order == 3 else math.inf, (-5.0, 5.0), dof=1)
    task = ConditionedProblem(
        Problem.of([[0.0], [1.0]], limits), Conditions(end_velocity=np.array([0.5]))
    )
    program = FreeFormNLP(task, (4, 4), free=True, second=1.0, guarded=frozenset({(0, 0)}))
    nlp = program.equations.nlp
    rows = casadi.Function("rows", [nlp["x"], nlp["p"]], [nlp["g"]])
    kinds = [row.name for row in program.equations.rows for _ in range(row.symbols.numel())]
    for _ in range(100):
        h, tops = rng.uniform(0.1, 1.0, (1, 4)), rng.normal(size=(1, 4))
        first = Arcs(order, h, tops, np.zeros((2, 2)))
        arcs = replace(first, states=first.nodes[:, 0, [0, -1]].T)
        x = np.concatenate([[h.sum()], h[0], *(nodes[0] for nodes in arcs.nodes[: order - 1])])
        found = np.array(rows(x, program.parameters)).ravel()[[k == "position" for k in kinds]]
        tau = np.linspace(0.0, 1.0, 200)[:, None] * h[0]
        v, a = arcs.nodes[:, 0, :-1]
        a, jerk = (a, tops[0]) if order == 3 else (tops[0], np.zeros(4))
        steps = tau * (v + tau * (a / 2.0 + tau * jerk / 6.0))
        path = steps + np.concatenate([[0.0], np.cumsum(steps[-1])[:-1]])
        ends = (0.0, path[-1, -1])
        assert max(*found, *ends) >= path.max() - 1e-12
        assert min(*found, *ends) <= path.min() + 1e-12


@pytest.mark.parametrize("problem", [UR5, SR4C, JERKY, Z1], ids=lambda p: p.name)
def test_shares_of_the_time_add_up_to_it(problem: Problem) -> None:
    found = free_form(problem, tolerance=1e-6)
    assert found.sensitivity is not None
    assert found.sensitivity.held.sum() == pytest.approx(found.seconds, rel=1e-6)
    assert (found.sensitivity.held >= 0.0).all()


@pytest.mark.parametrize(
    ("problem", "quantity", "joint"), [(UR5, 0, 4), (UR5, 2, 0), (SR4C, 1, 5), (Z1, 1, 0)]
)
def test_sensitivities_are_finite_differences(problem: Problem, quantity: int, joint: int) -> None:
    found = free_form(problem, tolerance=1e-6)
    assert found.sensitivity is not None

    def raised(by: float) -> float:
        limits = problem.limits.derivatives
        limits[quantity, joint] *= 1.0 + by
        other = Limits.of(*limits, problem.limits.position, dof=problem.dof)
        return free_form(replace(problem, limits=other), tolerance=1e-6).seconds

    slope = (raised(1e-3) - raised(-1e-3)) / 2e-3
    assert slope < -0.05
    assert found.sensitivity.limits[quantity, :, joint].sum() == pytest.approx(slope, rel=1e-3)


def test_sensitivities_to_displacements_and_position_limits() -> None:
    found = free_form(Z1, tolerance=1e-6).sensitivity
    assert found is not None
    segment, joint = np.unravel_index(np.abs(found.displacements).argmax(), found.displacements.shape)
    k, j, side = np.unravel_index(np.abs(found.positions).argmax(), found.positions.shape)

    def moved(by: float) -> float:
        points = Z1.waypoints.copy()
        points[segment + 1 :, joint] += by
        return free_form(replace(Z1, waypoints=points), tolerance=1e-6).seconds

    def widened(by: float) -> float:
        bounds = Z1.limits.position.copy()
        bounds[j, side] += by
        limits = replace(Z1.limits, position=bounds)
        return free_form(replace(Z1, limits=limits), tolerance=1e-6).seconds

    step = 1e-4
    assert found.displacements[segment, joint] == pytest.approx(
        (moved(step) - moved(-step)) / (2.0 * step), rel=1e-3
    )
    assert found.positions[k, j, side] == pytest.approx(
        (widened(step) - widened(-step)) / (2.0 * step), rel=1e-3
    )
