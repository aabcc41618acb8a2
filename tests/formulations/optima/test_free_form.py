"""Free-form motions: closed forms, laws, two solvers, conditions with planted faults, sensitivities."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import casadi
import numpy as np
import pytest
from conftest import powers_of_ten, problems
from hypothesis import given, settings
from hypothesis import strategies as st

from compare.__main__ import main
from compare.studies import free_form_study, planners
from formulations import (
    REFERENCES,
    Conditions,
    InputError,
    Limits,
    NoFeasibleMotion,
    Problem,
    Trajectory,
    check,
    family_optimum,
    free_form,
    load,
)
from formulations.optima.free_form import FreeForm
from formulations.optima.free_form.nlp.arcs import Arcs
from formulations.optima.free_form.nlp.assembly import trajectory
from formulations.optima.free_form.nlp.program import Program
from formulations.optima.free_form.nlp.task import Task
from formulations.optima.free_form.stop_and_go import stop_and_go
from formulations.proofs.rest_to_rest import rest_to_rest

UR5, SR4C, Z1 = load("ur5"), load("sr4c"), load("z1")
JERKY = replace(
    SR4C,
    name="sr4c, jerk",
    limits=Limits.of(
        SR4C.limits.velocity,
        SR4C.limits.acceleration,
        5.0 * SR4C.limits.acceleration,
        SR4C.limits.position,
        dof=6,
    ),
)
# all four from arcs 7 to 24 per segment, IPOPT and HiGHS; the digits that they agree in
OPTIMA = [(UR5, 14.7678659), (SR4C, 2.9975817), (JERKY, 3.2060593), (Z1, 12.9586047)]


def motion(found: FreeForm) -> Trajectory:
    assert found.trajectory is not None
    return found.trajectory


def drawn(seed: int, segments: int, limits: Limits) -> Problem:
    rng = np.random.default_rng(seed)
    return Problem.of(rng.uniform(-2.5, 2.5, (segments + 1, len(limits.velocity))), limits)


def seconds_of(outcome: str, problem: Problem) -> float:
    found = REFERENCES[outcome](problem).seconds
    return math.inf if found is None else found


# --- closed forms -----------------------------------------------------------------------------------


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
    task = Task(problem, Conditions())
    if not task.n_segments:
        return
    whole = trajectory(task, stop_and_go(task))
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


# --- laws -------------------------------------------------------------------------------------------


@given(
    problem=problems(
        segments=st.integers(1, 4),
        max_dof=3,
        limited=("v", "va", "vj", "vaj"),
        reach=(-2.0, 1.0),
        position=True,
    )
)
@settings(max_examples=30)
def test_answers_pass_the_check_and_lie_between_the_bounds(problem: Problem) -> None:
    found = free_form(problem)
    if found.trajectory is None:
        assert not problem.moving_joints
        return
    verdict = check(problem, found.trajectory)
    assert verdict.feasible, verdict.faults
    np.testing.assert_allclose(found.durations, np.diff(found.trajectory.passage_times), rtol=0, atol=0)
    assert found.seconds <= seconds_of("ruckig_stop_and_go", problem)
    assert found.seconds >= seconds_of("displacement", problem) * (1.0 - 1e-12)
    if problem.limits.has_acceleration:
        assert found.seconds >= seconds_of("ruckig_end_to_end", problem) * (1.0 - 1e-9)


@given(seed=st.integers(0, 1000), factor=powers_of_ten(-2.0, 2.0), jerk=st.booleans())
@settings(max_examples=3)
def test_faster_limits_scale_the_time_and_order_does_not_matter(
    seed: int, factor: float, jerk: bool
) -> None:
    v, a, j = 2.0, 5.0, 20.0 if jerk else math.inf
    problem = drawn(seed, 3, Limits.of(v, a, j, dof=3))
    seconds = free_form(problem, tolerance=1e-5).seconds
    faster = Limits.of(v * factor, a * factor**2, j * factor**3, dof=3)
    backwards = problem.waypoints[::-1, ::-1]
    for other, expected in (
        (Problem.of(problem.waypoints, faster), seconds / factor),
        (Problem.of(backwards, problem.limits), seconds),
        (Problem.of(1e-3 * problem.waypoints, Limits.of(1e-3 * v, 1e-3 * a, 1e-3 * j, dof=3)), seconds),
    ):
        assert free_form(other, tolerance=1e-5).seconds == pytest.approx(expected, rel=2e-5)


def test_a_motion_of_the_family_is_never_faster() -> None:
    for problem in (UR5, SR4C):
        assert free_form(problem).seconds < family_optimum(problem, random_starts=0).seconds


@pytest.mark.parametrize(
    "problem", [UR5, SR4C, drawn(3, 3, Limits.of(2.0, 5.0, 20.0, dof=4))], ids=["ur5", "sr4c", "drawn"]
)
def test_sequential_linear_programs_agree_with_ipopt(problem: Problem) -> None:
    fallback = free_form(problem, solver="highs")
    assert check(problem, motion(fallback)).feasible
    assert fallback.seconds == pytest.approx(free_form(problem).seconds, rel=1e-4)
    assert all("arcs" not in s.name or s.seconds < math.inf for s in fallback.stages)


@pytest.mark.parametrize(
    ("waypoints", "limits"),
    [
        # one joint, many waypoints; twelve joints
        (np.random.default_rng(0).uniform(-2.5, 2.5, (30, 1)), Limits.of(2, 5, 20, dof=1)),
        (np.random.default_rng(0).uniform(-2.5, 2.5, (4, 12)), Limits.of(2, 5, 20, dof=12)),
        # joints that stand still, equal waypoints at the start, inside and at the end
        ([[0, 1], [0, 1], [1, 1], [1, 1], [1, 1], [-1, 1], [-1, 1]], Limits.of(1, 2, 5, dof=2)),
        # limits 1e4 apart, displacements from 1e-6 to 1e3
        ([[0, 0], [1, 1], [-1, 2]], Limits.of([1e-2, 1e2], [1e2, 1e-2], [1.0, 1e4], dof=2)),
        ([[0, 0], [1e-6, 1e3], [2e-6, 1e3 + 1e-6], [1, 0]], Limits.of(1, 2, [5.0, math.inf], dof=2)),
        # a joint with a velocity limit alone beside others
        (
            [[0, 0, 0], [1, 1, 1], [0, 2, 0]],
            Limits.of(1, [2, math.inf, 3], [9, math.inf, math.inf], dof=3),
        ),
    ],
)
def test_hard_problems_are_answered(waypoints: Any, limits: Limits) -> None:
    problem = Problem.of(waypoints, limits)
    found = free_form(problem)
    verdict = check(problem, motion(found))
    assert verdict.feasible, verdict.faults
    assert found.seconds <= found.stages[0].seconds
    assert found.seconds <= seconds_of("ruckig_stop_and_go", problem)
    still = ~np.diff(problem.waypoints, axis=0).any(axis=1)
    assert (found.durations[still] == 0.0).all()


def test_nothing_moves() -> None:
    problem = Problem.of([[1.0, 2.0]] * 3, Limits.of(1.0, 1.0, 1.0, dof=2))
    found = free_form(problem)
    assert (found.seconds, found.trajectory, found.status) == (0.0, None, "ok")
    waiting = free_form(problem, conditions=Conditions(total=2.0))
    assert waiting.seconds == 2.0
    assert check(problem, motion(waiting), conditions=Conditions(total=2.0)).feasible


def test_ruckigs_own_failures_are_a_status() -> None:
    # its answer is a result that its enumeration does not have
    problem = Problem.of([[0.0], [1e9]], Limits.of(1e-2, 1.0, 1.0, dof=1))
    assert REFERENCES["ruckig_stop_and_go"](problem).status == "failed"
    assert check(problem, motion(free_form(problem))).feasible


# --- position limits --------------------------------------------------------------------------------


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
    task = Task(Problem.of([[0.0], [1.0]], limits), Conditions(end_velocity=np.array([0.5])))
    program = Program(task, (4, 4), free=True, second=1.0, guarded=frozenset({(0, 0)}))
    nlp = program.symbols.nlp
    rows = casadi.Function("rows", [nlp["x"], nlp["p"]], [nlp["g"]])
    kinds = [kind for kind, _, n in program.symbols.kinds for _ in range(n)]
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


# --- what holds the time up -------------------------------------------------------------------------


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


# --- conditions -------------------------------------------------------------------------------------

SLOW = Limits.of(0.5 * UR5.limits.velocity, UR5.limits.acceleration, UR5.limits.jerk, dof=6)
DRIFT = np.array([-0.1, -0.2, 0.0, 0.1, 0.0, -0.3])
ASKED = [
    Conditions(passage={1: 6.0}),
    Conditions(passage={1: 4.5, 2: 12.0}),
    Conditions(total=20.0),
    Conditions(total=20.0, passage={1: 5.0}),
    Conditions(stops=frozenset({1})),
    Conditions(start_velocity=DRIFT),
    Conditions(start_velocity=DRIFT, end_velocity=-DRIFT),
    Conditions(segment_limits={1: SLOW}),
    Conditions(segment_limits={0: SLOW}, stops=frozenset({2})),
]


@pytest.mark.parametrize("asked", ASKED, ids=range(len(ASKED)))
def test_conditions_are_kept(asked: Conditions) -> None:
    found = motion(free_form(UR5, conditions=asked))
    times = found.passage_times
    for waypoint, time in {**asked.passage, **({3: asked.total} if asked.total else {})}.items():
        assert times[waypoint] == pytest.approx(time, rel=1e-12)
    for stop in asked.stops:
        assert np.abs(found.at(times[stop], 1)).max() < 1e-9
        assert np.abs(found.at(times[stop], 2)).max() < 1e-9
    for at, velocity in ((0.0, asked.start_velocity), (found.seconds, asked.end_velocity)):
        expected = np.zeros(6) if velocity is None else velocity
        np.testing.assert_allclose(found.at(at, 1), expected, atol=1e-9)
    for segment in asked.segment_limits:
        inside = np.linspace(times[segment], times[segment + 1], 2000)[1:-1]
        assert (np.abs(found.at(inside, 1)) <= SLOW.velocity * (1.0 + 1e-9)).all()
    # the check says the same, and without the conditions it may not
    assert check(UR5, found, conditions=asked).feasible
    assert check(UR5, found).feasible == (asked.start_velocity is None)


@pytest.mark.parametrize(
    ("asked", "fault"),
    [
        (Conditions(passage={1: 3.0}), "passes waypoint 2 at"),
        (Conditions(total=15.0), "passes waypoint 4 at"),
        (Conditions(stops=frozenset({1})), "at waypoint 2, a stop"),
        (Conditions(start_velocity=DRIFT), "off by 0.3 at an end"),
        (Conditions(end_velocity=DRIFT), "off by 0.3 at an end"),
        (Conditions(segment_limits={1: SLOW}), "over the limit: velocity"),
    ],
)
def test_the_check_sees_what_was_not_kept(asked: Conditions, fault: str) -> None:
    verdict = check(UR5, motion(free_form(UR5)), conditions=asked)
    assert not verdict.feasible
    assert any(fault in line for line in verdict.faults), verdict.faults


def test_conditions_cost_time_in_order() -> None:
    fastest = free_form(UR5).seconds
    stopping = free_form(UR5, conditions=Conditions(stops=frozenset({1}))).seconds
    both = free_form(UR5, conditions=Conditions(stops=frozenset({1, 2}))).seconds
    assert fastest < stopping < both
    assert both == pytest.approx(seconds_of("ruckig_stop_and_go", UR5), rel=1e-9)
    rolling = free_form(UR5, conditions=Conditions(start_velocity=DRIFT)).seconds
    assert rolling < fastest


def test_the_smoothest_motion_is_smoother_than_the_fastest_slowed_down() -> None:
    def roughness(found: Trajectory) -> float:
        jerks = found.at(found.breaks[:-1] + 0.5 * found.durations, 3) / UR5.limits.jerk
        return float((jerks**2).sum(axis=1) @ found.durations)

    fastest = motion(free_form(UR5))
    smooth = motion(free_form(UR5, conditions=Conditions(total=20.0)))
    assert roughness(smooth) < 0.5 * roughness(fastest.stretched(20.0 / fastest.seconds))


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (Conditions(passage={1: 1.0}), "passes waypoint 1 at 3.96"),
        (Conditions(total=14.0), "passes waypoint 3 at 14.76"),
        (Conditions(total=14.0, stops=frozenset({1})), "conditions.total, conditions.stops"),
    ],
)
def test_what_cannot_be_done_is_one_clear_line(asked: Conditions, line: str) -> None:
    with pytest.raises(NoFeasibleMotion, match=line) as refusal:
        free_form(UR5, conditions=asked)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (Conditions(passage={9: 1.0}), "conditions.passage: waypoint 9 is not there: 0 to 3"),
        (Conditions(passage={1: -1.0}), "conditions.passage: waypoint 1: -1 s is no time"),
        (Conditions(passage={0: 1.0}), "conditions.passage: waypoint 0: 1 s, not the start"),
        (Conditions(passage={1: 3.0, 2: 2.0}), "waypoint 2: 2 s is not after waypoint 1 at 3 s"),
        (Conditions(total=math.nan), "conditions.total: nan s"),
        (Conditions(total=2.0, passage={3: 3.0}), "conditions.total: 2 s, but conditions.passage"),
        (Conditions(total=2.0, passage={1: 3.0}), "waypoint 1: 3 s is after conditions.total, 2 s"),
        (Conditions(stops=frozenset({7})), "conditions.stops: waypoint 7 is not there"),
        (Conditions(start_velocity=np.zeros(2)), r"start_velocity: expected 6 values, got \(2,\)"),
        (Conditions(end_velocity=np.full(6, 9.0)), "end_velocity: joint 1: 9 rad/s is over the limit"),
        (Conditions(start_velocity=DRIFT, stops=frozenset({0})), "start_velocity: .* which is a stop"),
        (Conditions(segment_limits={5: SLOW}), "segment_limits: segment 5 is not there: 0 to 2"),
        (Conditions(segment_limits={0: SR4C.limits}), "segment 0: jerk of joint 1 is inf"),
        (Conditions(segment_limits={0: Limits.of(1, dof=2)}), "segment 0: limits.velocity: 2 values"),
    ],
)
def test_conditions_that_do_not_fit_are_one_clear_line(asked: Conditions, line: str) -> None:
    with pytest.raises(InputError, match=line):
        free_form(UR5, conditions=asked)


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"mesh": 1}, "mesh: 1 arcs"),
        ({"tolerance": -1.0}, "tolerance: -1 is not positive"),
        ({"tolerance": math.nan}, "tolerance: nan"),
        ({"solver": "snopt"}, "solver: 'snopt' is not known"),
    ],
)
def test_options_that_make_no_sense(options: dict[str, Any], line: str) -> None:
    with pytest.raises(InputError, match=line):
        free_form(UR5, **options)


def test_progress_and_stages_tell_the_same_story() -> None:
    told: list[tuple[str, float]] = []
    found = free_form(SR4C, progress=lambda name, seconds: told.append((name, seconds)))
    assert told == [(stage.name, stage.seconds) for stage in found.stages]
    assert found.seconds == min(seconds for _, seconds in told)
    assert found.method in {name for name, _ in told}


def test_equal_waypoints_with_different_times_wait() -> None:
    problem = Problem.of([[0.0], [1.0], [1.0], [2.0]], Limits.of(1.0, 2.0, 10.0, dof=1))
    asked = Conditions(passage={1: 3.0, 2: 5.0})
    found = motion(free_form(problem, conditions=asked))
    assert found.passage_times[1:3] == pytest.approx([3.0, 5.0], rel=1e-12)
    assert check(problem, found, conditions=asked).feasible


@pytest.mark.parametrize("arm", ["panda", "xarm6"])
def test_two_real_arms(arm: str) -> None:
    problem = drawn(11, 3, free_form_study.ARMS[arm])
    found = free_form(problem)
    refined = free_form(problem, tolerance=1e-5)
    assert found.status == "ok"
    assert check(problem, motion(found)).feasible
    assert found.seconds < seconds_of("ruckig_stop_and_go", problem)
    assert refined.seconds * (1.0 - 1e-12) <= found.seconds <= refined.seconds * (1.0 + 1e-3)


# --- the commands -----------------------------------------------------------------------------------


def test_the_study_verifies_every_answer(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(free_form_study, "cases", lambda: iter([SR4C]))
    monkeypatch.setattr(free_form_study, "extremes", lambda: iter(()))
    assert main(["free_form_study", "--count", "2"]) == 0
    shown = capsys.readouterr().out
    assert "2 random problems: 2 verified, 0 above stop and go, 0 below their bound" in shown


def test_a_rival_that_is_not_installed_is_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert main(["rivals"]) == 1
    assert "drake: not installed (pip install drake)" in capsys.readouterr().err
    assert main(["rivals", "--rivals", "pilz"]) == 2
    assert "--rivals: 'pilz' is not known" in capsys.readouterr().err


def test_a_rivals_motion_is_slowed_down_or_refused() -> None:
    own = motion(free_form(SR4C))
    hasty = planners.judged(SR4C, "hasty", own.stretched(0.99), 0.0)
    assert hasty.seconds == pytest.approx(own.seconds, rel=1e-6)
    assert "slowed down by 1.0e-02" in hasty.note
    lazy = planners.judged(SR4C, "lazy", Trajectory(own.durations[:-1], own.coefficients[:-1]), 0.0)
    assert lazy.note.startswith("refused: ")
