"""Boxes narrowed in windows: no bound above the whole program's, and certificates proved again."""

import numpy as np
import pytest

from compare.check_certificate.verify import verify
from formulations import Limits, Problem, free_form, free_form_bound
from formulations.deadlines import NEVER
from formulations.problem.demands import Demands
from formulations.proofs.every_motion.beginnings import first_boxes, tangents
from formulations.proofs.every_motion.relaxation import windows
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame


def walk(seed):
    steps = np.random.default_rng(seed).uniform(-0.3, 0.3, (11, 2))
    waypoints = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    return Problem(waypoints, Limits.of(velocity=2.0, acceleration=5.0, jerk=50.0, dof=2))


@pytest.mark.parametrize("middle", [0, 4, 10])
def test_a_window_proves_no_more_than_the_whole_program(middle):
    problem = walk(0)
    upper = free_form(problem).seconds
    demands = Demands.of(problem)
    relaxed = RelaxedProblem.of(problem, upper * (1.0 + 1e-6))
    boxes = first_boxes(demands, relaxed, None)
    frame = Frame(relaxed, boxes, np.full(11, upper / 11.0))
    program = LinearProgram(frame, tangents(boxes.durations))
    solution = program.solve(frame.cost, rounds=50, tolerance=1e-7)
    window = windows.Window(program, solution.multipliers, middle)
    for column in (frame.T[middle], frame.a[middle, 1]):
        for sign in (1.0, -1.0):
            cost = sign * (np.arange(frame.size) == column)
            (found,) = windows.solve_in_windows(program, [window], [cost], solution.x, 3, NEVER)
            whole = LinearProgram(frame, program.cuts).solve(cost, rounds=50, tolerance=1e-9)
            assert found.bound <= float(cost @ whole.x) + 1e-7
            assert found.bound > float(np.minimum(*(cost * side for side in frame.box.T)).sum()) - 1e-9


@pytest.mark.long
@pytest.mark.parametrize("seed", [0, 1])
def test_the_certificate_of_a_bound_by_windows_is_proved_again(monkeypatch, seed):
    problem, used = walk(seed), []
    solve = windows.Window.solve
    monkeypatch.setattr(
        windows.Window, "solve", lambda self, cost: (used.append(1), solve(self, cost))[1]
    )
    upper = free_form(problem, tolerance=1e-5).seconds
    bound = free_form_bound(problem, gap=1e-4, upper=upper, record=True, time_limit=120.0)
    assert len(used) > 100
    assert bound.seconds <= upper <= bound.seconds * (1.0 + 1e-4)
    verify(bound.certificate)
