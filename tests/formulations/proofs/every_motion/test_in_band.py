"""The least total time of a long chain: as HiGHS finds it, certified, and with the horizon that is enough."""

import numpy as np
import pytest
from scipy.optimize import linprog

from compare.check_certificate.verify import verify
from formulations import Conditions, Limits, Problem, free_form, free_form_bound
from formulations.deadlines import Deadline
from formulations.problem.demands import Demands
from formulations.proofs.every_motion.beginnings import first_boxes, tangents
from formulations.proofs.every_motion.relaxation import in_band
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame


def walk(seed, steps=11, dof=2, step=0.3):
    moves = np.random.default_rng(seed).uniform(-step, step, (steps, dof))
    waypoints = np.concatenate([np.zeros((1, dof)), np.cumsum(moves, axis=0)])
    return Problem(waypoints, Limits.of(velocity=2.0, acceleration=5.0, jerk=50.0, dof=dof))


def program_of(problem, horizon):
    relaxed = RelaxedProblem.of(problem, horizon)
    boxes = first_boxes(Demands.of(problem), relaxed, None)
    K = len(boxes.durations)
    frame = Frame(relaxed, boxes, np.full(K, horizon / K))
    return LinearProgram(frame, tangents(boxes.durations))


@pytest.mark.parametrize("seed", range(4))
def test_the_optimum_is_that_of_another_solver(seed):
    problem = walk(seed)
    program = program_of(problem, free_form(problem).seconds * 1.001)
    frame = program.frame
    found = in_band.least_time(program, rounds=40, tolerance=1e-7)
    rows = program.rows
    exact = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
    other = linprog(frame.cost, rows.matrix, rows.upper, bounds=frame.box, options=exact)
    assert found.reason == "from elsewhere"  # not by HiGHS
    assert found.bound == pytest.approx(other.fun, rel=1e-6)
    assert found.bound <= other.fun + 1e-8
    assert (found.multipliers >= 0.0).all()
    # the point is one of all rows, also of those that were not posed
    whole = program_of(problem, free_form(problem).seconds * 1.001)
    assert found.bound == pytest.approx(
        whole.solve(frame.cost, rounds=60, tolerance=1e-7).bound, rel=1e-5
    )


def test_rounds_that_close_little_of_the_way_are_the_last_ones(monkeypatch):
    problem, solves, counts = walk(1), [], []
    solve = in_band._solved
    monkeypatch.setattr(in_band, "_solved", lambda *a: (solves.append(1), solve(*a))[1])
    horizon = free_form(problem).seconds
    for ceiling in (np.inf, 10.0 * horizon):
        solves.clear()
        in_band.least_time(program_of(problem, horizon), rounds=40, tolerance=1e-7, ceiling=ceiling)
        counts.append(len(solves))
    assert counts[1] < counts[0]


def test_where_rounding_leaves_no_answer_highs_solves(monkeypatch):
    problem = walk(2)
    program = program_of(problem, free_form(problem).seconds)

    def spoilt(program, columns, tolerance, deadline):
        return np.full(program.frame.size, np.nan), np.full(len(program.rows), np.nan), False

    monkeypatch.setattr(in_band, "_solved", spoilt)
    found = in_band.least_time(program, rounds=40, tolerance=1e-7)
    assert found.reason != "from elsewhere"
    assert found.converged


def test_a_deadline_that_is_over_leaves_a_bound_that_holds():
    problem = walk(3)
    upper = free_form(problem).seconds
    found = in_band.least_time(
        program_of(problem, upper), rounds=40, tolerance=1e-7, deadline=Deadline(0.0)
    )
    assert found.bound <= upper


def test_few_segments_and_cycles_are_no_long_chain():
    for steps, wanted in ((11, True), (6, False)):
        assert in_band.long_chain(program_of(walk(0, steps), 10.0).frame) is wanted


@pytest.mark.long
@pytest.mark.parametrize("seed", [5, 6])
def test_a_wide_gap_is_closed_to_the_one_asked_for(seed):
    problem = walk(seed, 12, 3, 0.2)
    upper = free_form(problem, tolerance=1e-5).seconds
    first = program_of(problem, upper * (1.0 + 1e-6))
    before = in_band.least_time(first, rounds=100, tolerance=1e-8).bound
    assert upper / before - 1.0 > 1e-3  # there is something to do
    bound = free_form_bound(problem, gap=1e-3, upper=upper, time_limit=120.0, record=True)
    assert bound.seconds <= upper <= bound.seconds * (1.0 + 1e-3)
    verify(bound.certificate)
    claimed = float.fromhex(bound.certificate["seconds"])
    assert claimed == pytest.approx(bound.seconds, rel=1e-6)


def many_zones(seed):
    """The zones do not meet: each step of a joint is longer than both together."""
    rng = np.random.default_rng(seed)
    moves = rng.uniform(0.3, 1.0, (34, 2)) * rng.choice([-1.0, 1.0], (34, 2))
    waypoints = np.concatenate([np.zeros((1, 2)), np.cumsum(moves, axis=0)])
    zones = Conditions(tolerance={k: np.array([0.05, 0.02]) for k in range(1, 34, 2)})
    limits = Limits.of(velocity=2.0, acceleration=5.0, jerk=50.0, dof=2)
    return Problem(waypoints, limits, conditions=zones)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(2))
def test_a_long_chain_in_zones_is_proved_and_certified(seed):
    problem = many_zones(seed)
    upper = free_form(problem, tolerance=1e-5).seconds
    demands = Demands.of(problem)
    relaxed = RelaxedProblem.under(demands, upper * (1.0 + 1e-6))
    assert len(relaxed.legs) == relaxed.n_segments
    frame = Frame(relaxed, first_boxes(demands, relaxed, None), np.full(relaxed.n_segments, 0.7))
    assert in_band.long_chain(frame)
    program = LinearProgram(frame, tangents(frame.boxes.durations))
    found = in_band.least_time(program, rounds=40, tolerance=1e-7)
    exact = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
    rows = program.rows
    other = linprog(frame.cost, rows.matrix, rows.upper, bounds=frame.box, options=exact)
    assert found.reason == "from elsewhere"  # not by HiGHS
    assert found.bound == pytest.approx(other.fun, rel=1e-6)
    bound = free_form_bound(problem, gap=1e-3, upper=upper, time_limit=120.0, record=True)
    assert bound.seconds <= upper <= bound.seconds * (1.0 + 1e-3)
    verify(bound.certificate)
    assert float.fromhex(bound.certificate["seconds"]) == pytest.approx(bound.seconds, rel=1e-5)


def test_where_zones_meet_legs_go_beyond_them():
    problem = many_zones(0)
    wide = Conditions(tolerance={k: np.full(2, 1.2) for k in (10, 11)})
    relaxed = RelaxedProblem.under(Demands.of(problem, wide), 100.0)
    beyond = relaxed.legs[relaxed.n_segments :]
    assert len(beyond) > 0
    assert all(start <= 10 < 11 <= end for start, end in beyond.tolist())
