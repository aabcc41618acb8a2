"""The program on arcs: rows and bounds registered together, and solvers that fail."""

from __future__ import annotations

import casadi
import numpy as np
import pytest
from free_form_helpers import JERKY, SR4C, UR5, Z1, drawn

from formulations import Conditions, Limits, NoFeasibleMotion, Problem, free_form
from formulations.optima.free_form.nlp import ipopt, slp
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.optima.free_form.nlp.equations import equations_of
from formulations.optima.free_form.nlp.program import FreeFormNLP
from formulations.optima.free_form.stop_and_go import stop_and_go_motion

MIXED = drawn(5, 4, Limits.of(1.0, [2.0, np.inf, 3.0], [9.0, np.inf, np.inf], dof=3))


def program_of(problem: Problem, *, free: bool = True, asked: Conditions | None = None) -> FreeFormNLP:
    task = ConditionedProblem(problem, asked or Conditions())
    places = frozenset((j, k) for j in task.moving for k in range(task.n_segments))
    second = float(stop_and_go_motion(task).times.mean())
    return FreeFormNLP(task, (3, 7), free=free, second=second, guarded=places)


@pytest.mark.parametrize("problem", [UR5, SR4C, JERKY, Z1, MIXED], ids=lambda p: p.name)
@pytest.mark.parametrize(
    "asked", [Conditions(), Conditions(total=60.0, stops=frozenset({1}))], ids=range(2)
)
def test_a_motion_satisfies_every_row_within_its_own_bounds(
    problem: Problem, asked: Conditions
) -> None:
    """Stop and go is a motion: wherever a row and its bounds are mixed up, it is outside."""
    program = program_of(problem, asked=asked)
    x = program.point(stop_and_go_motion(program.task), floor=0.0)
    nlp = program.equations.nlp
    rows = casadi.Function("rows", [nlp["x"], nlp["p"]], [nlp["g"]])
    values = np.array(rows(x, program.parameters)).ravel()
    for block in program.equations.rows:
        low, high = block.bounds(program.numbers)
        assert low.shape == high.shape == values[block.part].shape
        missed = np.maximum(low - values[block.part], values[block.part] - high)
        assert missed.max(initial=0.0) <= 1e-7, (block.name, block.order)
    assert len(values) == len(program.row_low) == len(program.row_high)
    assert len(x) == len(program.low) == nlp["x"].numel()


def test_blocks_tile_the_program_and_shapes_are_made_once() -> None:
    program = program_of(MIXED)
    for blocks, n in (
        (program.equations.variables, len(program.low)),
        (program.equations.rows, len(program.row_low)),
    ):
        edges = [0, *(block.part.stop for block in blocks)]
        assert [block.part.start for block in blocks] == edges[:-1]
        assert edges[-1] == n
    assert equations_of(program.shape) is program_of(MIXED).equations


@pytest.mark.parametrize("solve", [ipopt.solve, slp.solve])
def test_a_solver_that_fails_is_a_status(solve: object) -> None:
    """Numbers that no solver takes: the starting point comes back, not converged, with a reason."""
    program = program_of(SR4C)
    x = program.point(stop_and_go_motion(program.task))
    program.parameters = np.full_like(program.parameters, np.nan)
    found = solve(program, x, tolerance=1e-6)  # type: ignore[operator]
    assert not found.converged
    assert found.status
    assert np.isfinite(found.x).all()


def test_bounds_that_cross_are_a_status() -> None:
    program = program_of(SR4C)
    x = program.point(stop_and_go_motion(program.task))
    program.low = program.high + 1.0
    found = ipopt.solve(program, x, tolerance=1e-6)
    assert (found.converged, found.iterations) == (False, 0)
    assert "Ill-posed" in found.status


def test_numbers_that_doubles_cannot_hold_are_named() -> None:
    """Phases of microseconds in a motion of a thousand years."""
    problem = Problem.of(
        [[0.0, 0.0], [1e4, 0.1], [1e4, 7e4], [1.00001e4, 4.8e4]],
        Limits.of([22.0, 3e-6], [3e-6, 1.5], [0.4, 1e5], dof=2),
    )
    with pytest.raises(NoFeasibleMotion, match="too far apart for double precision"):
        free_form(problem)


def test_short_phases_in_a_long_motion_are_no_reason_to_give_up() -> None:
    """The grid of breaks is 1e-6 of a phase: each slower motion is rounded anew."""
    points = [
        [-5.9155308940065154e-02, -1.2604568155601283e00, 1.0238952875311167e00],
        [-5.9159964784163757e-02, -1.2952656503592512e00, 1.0238953031389866e00],
        [-7.3541787967100461e01, -1.2732200764792660e00, 1.0243028045189473e00],
    ]
    limits = Limits.of(
        [2.1866064757895320e-02, 2.2086062700064687e01, 2.3418757853742678e04],
        [5.5948742136050830e-03, 1.2666604439937751e-04, 1.1287769209959506e-05],
        [1.7814588460511728e04, 5.3409372187009148e-06, 2.0781629397644274e03],
        [(-4.6e10, points[0][0]), (points[1][1], points[0][1]), (points[0][2], 1.04)],
        dof=3,
    )
    problem = Problem.of(points, limits)
    found = free_form(problem)
    assert found.verdict is not None
    assert found.verdict.feasible
    assert found.seconds <= found.stages[0].seconds
