"""The bound of every motion there is: sound row by row, safe against rounding, and tight."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import highspy
import numpy as np
import pytest
import ruckig
from conftest import Array, climbed, powers_of_ten, problems
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog
from scipy.sparse import csr_array

from formulations import (
    FAMILIES,
    REFERENCES,
    FreeFormBound,
    InputError,
    Limits,
    Problem,
    Trajectory,
    check,
    free_form_bound,
    load,
)
from formulations.proofs.every_motion.closed_forms import least_durations, stop_and_go
from formulations.proofs.every_motion.relaxation import cuts as kinds
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.program import Program
from formulations.proofs.every_motion.relaxation.reach import distance_coefficients, speed_coefficients
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.every_motion.relaxation.safe_dual import safe_bound
from formulations.proofs.every_motion.relaxation.separation import separate
from formulations.proofs.every_motion.relaxation.switches import farthest, fastest
from formulations.proofs.every_motion.relaxation.task import Task
from formulations.proofs.every_motion.relaxation.tightening import tightened
from formulations.proofs.rest_to_rest import rest_to_rest
from formulations.references.ruckig_ import pieces_of

ROUNDING = 1e-12  # in the motions themselves, in units of the rows' variables
SIZE = powers_of_ten(-1.0, 1.0)


def jerk_limited(name: str, factor: float) -> Problem:
    """A case with jerk limits of ``factor`` times its acceleration limits."""
    problem = load(name)
    limits = problem.limits
    return replace(problem, limits=replace(limits, jerk=factor * limits.acceleration))


def unbounded(problem: Problem) -> Problem:
    """The same without position limits."""
    position = np.full((problem.dof, 2), (-np.inf, np.inf))
    return replace(problem, limits=replace(problem.limits, position=position))


def task_of(waypoints: Any, *limits: Any, **position: Any) -> Problem:
    points = np.asarray(waypoints, dtype=np.float64)
    return Problem.of(points, Limits.of(*limits, **position, dof=points.shape[1]))


def holds(problem: Problem, bound: FreeFormBound) -> None:
    """What must hold of every bound: its order, and that its own motion is one."""
    assert bound.seconds == max(bound.bounds.values())
    assert 0.0 <= bound.seconds <= stop_and_go(problem).sum() * (1.0 + 1e-9)
    assert bound.seconds == bound.bounds[bound.method]
    if bound.motion is not None:
        verdict = check(problem, bound.motion)
        assert verdict.feasible, verdict.faults
        assert bound.least_verified <= verdict.seconds
        assert bound.upper is not None
        assert bound.upper <= verdict.seconds


# --- every row holds for every motion -------------------------------------------------------------


def exact(problem: Problem, motion: Trajectory) -> Trajectory:
    """Stretched until it keeps the limits without a tolerance."""
    return motion.stretched(max(check(problem, motion).stretch, 1.0) * (1.0 + 1e-12))


def stopping(problem: Problem) -> Trajectory:
    motion = REFERENCES["ruckig_stop_and_go"](problem).trajectory
    assert motion is not None
    return motion


def splined(problem: Problem, family: str, rng: np.random.Generator) -> Trajectory:
    """A family's spline for random durations, as fast as the limits allow."""
    durations = 10.0 ** rng.uniform(-0.5, 0.5, problem.n_segments)
    stretch = FAMILIES[family].stretch(problem, durations[None])[0]
    return FAMILIES[family].trajectory(problem, durations * stretch)


def through_states(problem: Problem, rng: np.random.Generator) -> Trajectory:
    """Ruckig from waypoint to waypoint through random states: passes at speed, accelerating."""
    limits = problem.limits
    speeds = 0.4 * rng.uniform(-1.0, 1.0, problem.waypoints.shape) * limits.velocity
    steeps = 0.4 * rng.uniform(-1.0, 1.0, problem.waypoints.shape) * limits.acceleration
    steeps *= np.sqrt(np.minimum(1.0, limits.jerk * limits.velocity / limits.acceleration**2))
    speeds[[0, -1]] = steeps[[0, -1]] = 0.0
    parts, lengths = [], [0.0]
    for k in range(problem.n_segments):
        start = problem.waypoints[k]
        motion = ruckig.Trajectory(problem.dof)
        task = ruckig.InputParameter(problem.dof)
        task.current_position, task.target_position = start.tolist(), problem.waypoints[k + 1].tolist()
        task.current_velocity, task.target_velocity = speeds[k].tolist(), speeds[k + 1].tolist()
        task.current_acceleration = steeps[k].tolist()
        task.target_acceleration = steeps[k + 1].tolist()
        task.max_velocity, task.max_acceleration = (
            limits.velocity.tolist(),
            limits.acceleration.tolist(),
        )
        task.max_jerk = limits.jerk.tolist()
        ruckig.Ruckig(problem.dof).calculate(task, motion)
        parts.append(integrated(motion, start, speeds[k], steeps[k]))
        lengths.append(parts[-1][0].sum())
    durations, coefficients = (np.concatenate(both) for both in zip(*parts, strict=True))
    return Trajectory(durations, coefficients, np.cumsum(lengths))


def integrated(motion: ruckig.Trajectory, x: Array, v: Array, a: Array) -> tuple[Array, Array]:
    """``pieces_of`` with the state it starts from."""
    durations, coefficients = pieces_of(motion, x)
    t = np.concatenate([[0.0], np.cumsum(durations)[:-1]])[:, None]
    coefficients[..., 0] += v * t + a * t**2 / 2.0
    coefficients[..., 1] += v + a * t
    coefficients[..., 2] += a / 2.0
    return durations, coefficients


def point_of(frame: Frame, problem: Problem, motion: Trajectory) -> Array:
    """A motion in the variables of the relaxation, from its own polynomials."""
    task = frame.task
    times = motion.passage_times[np.append(task.segments, task.segments[-1] + 1)]
    T = np.diff(times) / frame.typical
    v = motion.at(times, 1)[:, task.joints] / task.velocity
    a = motion.at(times, 2)[:, task.joints] / task.acceleration
    v[[0, -1]] = a[[0, -1]] = 0.0  # rest but for rounding
    a[:, ~task.has_jerk] = 0.0
    x = np.zeros(frame.size)
    x[frame.T], x[frame.inverse], x[frame.square] = T, 1.0 / T, T**2
    x[frame.v], x[frame.a] = v, a
    x[frame.W[:, :, 0]], x[frame.W[:, :, 1]] = T[:, None] * a[:-1], T[:, None] * a[1:]
    return x


def frame_for(problem: Problem, horizon: float) -> Frame:
    task = Task.of(problem, horizon)
    low = least_durations(problem)[task.segments]
    limit = np.broadcast_to(task.acceleration, (len(low) + 1, len(task.joints)))
    box = np.stack([low, horizon - (low.sum() - low)], axis=1)
    return Frame(task, box, np.stack([-limit, limit], axis=-1), 2.0 * low)


def random_cuts(frame: Frame, rng: np.random.Generator, m: int = 80) -> Cuts:
    """Rows of every kind, posed anywhere."""
    found = []
    for kind in range(11):
        k, j = rng.integers(frame.K, size=m), rng.integers(frame.n, size=m)
        limited = frame.task.has_jerk[j][:, None]
        low, high = frame.durations[k].T
        at = np.sort(rng.random((m, 6)) ** rng.choice([0.2, 1.0, 5.0], (m, 1)), axis=1)
        # without a jerk limit: no pieces of jerk
        late = at[:, 3] if kind == kinds.CRUISE else at[:, 1]
        plain = np.stack([0.0 * k, at[:, 1], at[:, 1], late, late, 0.0 * k + 1.0], axis=1)
        if kind in (kinds.TANGENT, kinds.HULL):
            at = (low + rng.random(m) ** 3 * (high - low))[:, None]
        elif kind in (kinds.PRODUCT_AT_START, kinds.PRODUCT_AT_END):
            at = rng.integers(4, size=(m, 1)).astype(np.float64)
        elif kind in (kinds.PEAK_AT_START, kinds.PEAK_AT_END):
            at = (rng.normal(size=m) * frame.task.acceleration[j] / frame.typical[k])[:, None]
        elif kind == kinds.SPEED:
            at = np.where(limited, at[:, :2], [0.0, 1.0])
        elif kind in (kinds.STOP_AT_START, kinds.STOP_AT_END):
            at = np.where(limited, at, plain)[:, :2]
        else:
            at = np.where(limited, at, plain)
        cuts = Cuts.of(kind, k, at, j, rng.choice([-1.0, 1.0], m))
        if kind in (kinds.PEAK_AT_START, kinds.PEAK_AT_END):
            cuts = cuts[limited[:, 0]]
        if kind in (kinds.STOP_AT_START, kinds.STOP_AT_END):
            cuts = cuts[np.isfinite(frame.task.room).all(axis=(0, 2))[j]]
        found.append(cuts)
    return Cuts.joined(found)


def limited_by(motion: Trajectory, problem: Problem) -> Problem:
    """The problem with position limits that the motion just keeps."""
    extremes = motion.extremes(0)
    bounds = np.stack([extremes.low.min(axis=0), extremes.high.max(axis=0)], axis=1)
    return replace(problem, limits=replace(problem.limits, position=bounds))


LIMITS: dict[str, tuple[Any, ...]] = {
    "jerk": ([1.0, 2.0, 1.5], [3.0, 2.0, 9.0], [20.0, 4.0, 500.0]),
    "no jerk": ([1.0, 2.0, 1.5], [3.0, 2.0, 9.0]),
    "jerk of one": ([1.0, 2.0, 1.5], [3.0, 2.0, 9.0], [np.inf, 4.0, np.inf]),
    "low jerk": ([3.0, 2.0, 5.0], [30.0, 20.0, 90.0], [2.0, 1.0, 5.0]),
}


@pytest.mark.parametrize("kind", LIMITS)
@pytest.mark.parametrize("seed", range(5))
def test_every_row_holds_for_every_motion(kind: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    steps = rng.normal(size=(3 + seed, 3)) * 10.0 ** rng.uniform(-2.0, 0.0, (3 + seed, 1))
    problem = task_of(np.cumsum(steps, axis=0), *LIMITS[kind])
    motions = [stopping(problem), splined(problem, "quintic", rng)]
    motions.append(splined(problem, "3-5-3" if problem.n_segments == 3 else "4-3-4", rng))
    if kind in ("jerk", "low jerk"):
        passing = [through_states(problem, rng) for _ in range(8)]
        # Ruckig's own precision is below the check's
        passing = [motion for motion in passing if check(problem, exact(problem, motion)).feasible]
        assert len(passing) >= 2
        motions += passing
    for raw in motions:
        motion = exact(problem, raw)
        tight = limited_by(motion, problem)
        assert check(tight, motion).feasible
        # a horizon that the motion just keeps, and one far away
        for horizon in (motion.seconds * (1.0 + 1e-12), 3.0 * motion.seconds):
            frame = frame_for(tight, horizon)
            x = point_of(frame, tight, motion)
            outside = np.maximum(frame.box[:, 0] - x, x - frame.box[:, 1])
            assert outside.max() <= ROUNDING * np.abs(x).max()
            for rows in (frame.fixed(), frame.of(random_cuts(frame, rng))):
                size = abs(rows.matrix) @ np.abs(x) + np.abs(rows.upper)
                assert (rows.matrix @ x - rows.upper <= ROUNDING * size).all()


def banged(jerks: list[tuple[float, float]]) -> Trajectory:
    """One joint from rest through pieces of constant jerk: (jerk, duration)."""
    state, pieces = np.zeros(3), []
    for jerk, h in jerks:
        x, v, a = state
        pieces.append([[x, v, a / 2.0, jerk / 6.0]])
        state = np.array(
            [x + h * (v + h * (a / 2 + h * jerk / 6)), v + h * (a + h * jerk / 2), a + h * jerk]
        )
    return Trajectory(np.array([h for _, h in jerks]), np.array(pieces))


R3 = math.sqrt(3.0)
EXTREMAL = {
    # jerk alone; with acceleration; with both; from -V to V; turning round with jerk, with acceleration
    "jerk": [(1.0, 1.0), (-1.0, 2.0), (1.0, 1.0)],
    "acceleration": [(1.0, 1.0), (0.0, 2.0), (-1.0, 2.0), (0.0, 2.0), (1.0, 1.0)],
    "cruise": [(1.0, 1.0), (0.0, 1.0), (-1.0, 1.0), (0.0, 3.0), (-1.0, 1.0), (0.0, 1.0), (1.0, 1.0)],
    "to and fro": [(-1.0, 1.0), (1.0, 1.0 + 2.0**0.5), (-1.0, 1.0 + 2.0**0.5), (1.0, 1.0)],
    "turn": [(1.0, 1.0), (-1.0, 3.0), (1.0, 2.0 + R3), (-1.0, R3)],
    "turn, held": [(1.0, 1.0), (-1.0, 2.0), (0.0, 3.0), (1.0, 2.0), (0.0, 2.0), (-1.0, 1.0)],
}


@pytest.mark.parametrize("kind", EXTREMAL)
def test_every_row_holds_where_nothing_is_left(kind: str) -> None:
    """Motions that use their limits to the full, seen at any times, in rows posed for their states."""
    motion, used = banged(EXTREMAL[kind]), set()
    most = [max(-e.low.min(), e.high.max()) for e in (motion.extremes(1), motion.extremes(2))]
    for seed in range(4):
        rng = np.random.default_rng(seed)
        inner = np.sort(rng.uniform(0.05, 0.95, 3) * motion.seconds) if seed else motion.breaks[1:-1]
        times = np.concatenate([[0.0], inner, [motion.seconds]])
        passing = replace(motion, passages=times)
        # an acceleration limit just as large as the motion needs, or one without influence
        limits = most[0], most[1] * (100.0 if seed % 2 else 1.0), 1.0
        problem = limited_by(passing, task_of(motion.at(times), *limits))
        assert check(problem, passing).feasible
        frame = frame_for(problem, motion.seconds * (1.0 + 1e-12))
        x = point_of(frame, problem, passing)
        outside = np.maximum(frame.box[:, 0] - x, x - frame.box[:, 1])
        assert outside.max() <= ROUNDING * np.abs(x).max()
        posed = separate(frame, x, -math.inf)
        rows = frame.of(posed)
        excess = rows.matrix @ x - rows.upper
        assert excess.max() <= 1e-11
        used |= set(posed.kind[excess > -1e-9].tolist())
    # and every kind of row is used up somewhere: a smaller one would cut a motion off
    assert used >= set(range(11)) - {kinds.CRUISE}


def test_a_joint_may_use_all_the_speed_it_has_time_for() -> None:
    """Accelerate, brake: half way it is as fast as the horizon allows, and no slower is asked of it."""
    motion = stopping(task_of([[0.0], [1.0]], 10.0, 3.0))
    problem = task_of([[0.0], [0.5], [1.0]], 10.0, 3.0)
    passing = replace(motion, passages=np.array([0.0, 0.5, 1.0]) * motion.seconds)
    frame = frame_for(problem, motion.seconds)
    x = point_of(frame, problem, passing)
    assert x[frame.v[1, 0]] == pytest.approx(1.0, rel=1e-12)
    assert frame.task.velocity[0] == pytest.approx(3.0 * motion.seconds / 2.0, rel=1e-12)


def test_a_wrong_row_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A coefficient of the jerk that is a hundredth too small would break the test above."""

    def wrong(switches: Array, cruises: bool) -> tuple[Array, ...]:
        *rest, c_J = distance_coefficients(switches, cruises)
        return *rest, 0.99 * c_J

    problem = task_of([[0.0], [1.0]], [10.0], [10.0], [1.0])
    motion = stopping(problem)
    frame = frame_for(problem, 2.0 * motion.seconds)
    # the motion that goes farthest: jerk J, -J, J, switched at a quarter and at three quarters
    at = np.array([[0.25, 0.25, 0.25, 0.75, 0.75, 0.75]])
    cut, x = Cuts.of(kinds.DISTANCE, np.zeros(1, np.intp), at), point_of(frame, problem, motion)
    rows = frame.of(cut)
    assert (rows.matrix @ x)[0] == pytest.approx(rows.upper[0], abs=1e-12)
    monkeypatch.setattr("formulations.proofs.every_motion.relaxation.rows.distance_coefficients", wrong)
    rows = frame.of(cut)
    assert (rows.matrix @ x)[0] > rows.upper[0] + 1e-4


# --- the inequalities are tight: an oracle of linear programs in time -----------------------------


def farthest_on_a_grid(ends: Array, V: float, A: float, J: float, n: int = 120) -> float:
    """Largest displacement in unit time with jerks constant on n steps: no more than the true one.

    Velocity bounded between the nodes too, by its middle Bernstein coefficients.
    """
    v0, W0, v1, W1 = ends
    h = 1.0 / n
    W = h * np.tril(np.ones((n + 1, n)), -1)  # of the jerks, W0 apart
    v = h * (np.tril(np.ones((n + 1, n)), -1) @ (W[:-1] + h / 2.0 * np.eye(n)))
    v_at = v0 + W0 * h * np.arange(n + 1)
    middle, middle_at = v[:-1] + h / 2.0 * W[:-1], v_at[:-1] + h / 2.0 * W0
    covered = np.ones(n) @ (h * v[:-1] + h**2 / 2.0 * W[:-1] + h**3 / 6.0 * np.eye(n))
    rows = np.concatenate([W, -W, v, -v, middle, -middle])
    steep = [np.full(n + 1, A - W0), np.full(n + 1, A + W0)]
    upper = np.concatenate([*steep, V - v_at, V + v_at, V - middle_at, V + middle_at])
    met = np.stack([W[-1], v[-1]])
    answer = linprog(-covered, rows, upper, met, [W1 - W0, v1 - v_at[-1]], (-J, J), method="highs")
    assert answer.status == 0, answer.message
    return float(covered @ answer.x + h * (v_at[:-1] + h / 2.0 * W0).sum())


@pytest.mark.parametrize("seed", range(8))
def test_distance_is_that_of_the_farthest_motion(seed: int) -> None:
    rng = np.random.default_rng(seed)
    A, J = 10.0 ** rng.uniform(0.0, 1.0), 10.0 ** rng.uniform(1.5, 2.5)
    W0, W1 = 0.3 * A * rng.uniform(-1.0, 1.0, 2)
    v0, v1 = 0.1 * A * rng.uniform(-1.0, 1.0, 2)
    V = 0.25 * A if seed % 2 else 2.0 * A
    ends, limits = np.array([v0, W0, v1, W1]), np.array([V, A, J])
    switches, cruises = farthest(*ends[:, None], *limits[:, None])
    assert bool(cruises[0]) == bool(seed % 2)
    c = np.concatenate(distance_coefficients(switches, bool(cruises[0])))
    bound = float(c @ [*ends, *limits])
    reached = farthest_on_a_grid(ends, V, A, J)
    assert bound - 3e-3 * V <= reached <= bound * (1.0 + 1e-9)
    two = fastest(ends[1:2], ends[3:], *limits[1:, None])
    gained = float(np.concatenate(speed_coefficients(two)) @ [W0, W1, A, J])
    s = np.linspace(0.0, 1.0, 100_001)
    steepest = np.minimum(np.minimum(W0 + J * s, W1 + J * (1.0 - s)), A)
    assert gained == pytest.approx(float(np.trapezoid(steepest, s)), rel=1e-8)


# --- safe against rounding, and against whatever the solver says ----------------------------------


def lagrangian(cost: Array, matrix: Array, upper: Array, box: Array, y: Array) -> Fraction:
    """The bound of any multipliers in exact arithmetic."""
    exactly = np.vectorize(Fraction, otypes=[object])
    y = exactly(np.where(y > 0.0, y, 0.0))
    reduced = exactly(cost) + exactly(matrix).T @ y
    least = sum(min(r * low, r * high) for r, (low, high) in zip(reduced, exactly(box), strict=True))
    return Fraction(least - exactly(upper) @ y)


@pytest.mark.parametrize("seed", range(60))
def test_safe_bound_never_exceeds_the_exact_one(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m, n = rng.integers(1, 12, 2)
    matrix = rng.normal(size=(m, n)) * 10.0 ** rng.uniform(-8.0, 8.0, (m, n))
    cost, upper = rng.normal(size=n), rng.normal(size=m)
    box = np.sort(rng.normal(size=(n, 2)) * 10.0 ** rng.uniform(-3.0, 3.0, (n, 1)), axis=1)
    y = rng.normal(size=m) * 10.0 ** rng.uniform(-8.0, 8.0)
    if seed % 3 == 0:  # a reduced cost that cancels but for rounding
        cost = -(matrix.T @ np.maximum(y, 0.0))
    if seed % 3 == 1:  # nothing but the right hand sides
        box, y = 0.0 * box, np.abs(y)
    bound = safe_bound(cost, csr_array(matrix), upper, box, y)
    true = lagrangian(cost, matrix, upper, box, y)
    assert Fraction(bound) <= true
    reach = np.abs(box).max(axis=1)
    size = np.abs(cost) @ reach + np.abs(y) @ np.abs(upper) + np.abs(matrix).T @ np.abs(y) @ reach
    assert float(true) - bound <= 1e-13 * float(size) + 1e-280


def test_any_multipliers_give_a_valid_bound() -> None:
    problem = load("ur5")
    known = free_form_bound(problem).upper
    assert known is not None
    frame = frame_for(problem, known * 1.01)
    rng = np.random.default_rng(0)
    program = Program(frame, random_cuts(frame, rng))
    solution = program.solve(frame.cost, rounds=20, tolerance=1e-7)
    assert known * (1.0 - 1e-3) <= solution.bound <= known
    m = len(program.rows)
    for size in (1e-9, 1e-3, 1.0, 1e6, 1e300):
        for share in (0.0, 1.0):
            y = share * solution.multipliers + size * rng.normal(size=m)
            assert program.certify(frame.cost, y) <= known
            # what has a point is never certified to have none
            assert program.certify(0.0 * frame.cost, y) <= 0.0
    for value in (math.nan, math.inf, -math.inf, -1.0):
        assert program.certify(frame.cost, np.full(m, value)) <= known


def test_a_solver_that_fails_leaves_the_simple_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(self: Program, deadline: float) -> highspy.HighsModelStatus:
        return highspy.HighsModelStatus.kSolveError

    monkeypatch.setattr(Program, "_run", broken)
    problem = load("ur5")
    bound = free_form_bound(problem)
    assert "HiGHS ended" in bound.status
    assert bound.method == "segment"
    assert bound.seconds == pytest.approx(least_durations(problem).sum(), rel=1e-9)
    holds(problem, bound)


def test_a_solver_that_lies_proves_nothing_false(monkeypatch: pytest.MonkeyPatch) -> None:
    """Points and multipliers disturbed: every bound, of boxes too, stays below a known motion."""
    problem = load("ur5")
    known = free_form_bound(problem).upper
    honest = Program._solution
    rng = np.random.default_rng(0)

    def lying(self: Program, cost: Array, converged: bool) -> Any:
        solution = honest(self, cost, converged)
        noise = solution.multipliers * rng.uniform(0.5, 1.5, len(solution.multipliers))
        x = solution.x * rng.uniform(0.9, 1.1, len(solution.x))
        return replace(solution, x=x, multipliers=noise, bound=self.certify(cost, noise))

    monkeypatch.setattr(Program, "_solution", lying)
    bound = free_form_bound(problem, time_limit=2.0)
    assert known is not None
    assert bound.seconds <= known


# --- where the fastest motion is known ------------------------------------------------------------


@pytest.mark.parametrize(
    ("V", "A", "J"),
    [(1.0, 2.0, 10.0), (5.0, 2.0, 3.0), (1.0, 2.0, np.inf), (1.0, np.inf, 4.0)],
)
@pytest.mark.parametrize("inner", [[], [0.3], [0.1, 0.2, 0.9]])
def test_one_joint_that_never_turns_back(V: float, A: float, J: float, inner: list[float]) -> None:
    """Inner waypoints on the way change nothing: the motion from rest to rest passes them."""
    problem = task_of([[0.0], *[[x] for x in inner], [1.0]], V, A, J)
    bound = free_form_bound(problem, gap=1e-6, time_limit=20.0)
    optimum = rest_to_rest(1.0, V, A, J)
    assert optimum * (1.0 - 1e-9) <= bound.seconds <= optimum
    # the relaxation knows nothing of the closed form, which ended the search
    assert bound.bounds["relaxation"] >= optimum * (1.0 - 2e-2)
    holds(problem, bound)


@pytest.mark.parametrize("limits", [(1.0, 2.0, 10.0), (5.0, 1.5, 3.0), (1.0, np.inf, 4.0), (1.0, 2.0)])
@pytest.mark.parametrize("distance", [0.003, 0.05, 0.2, 0.7, 3.0])
def test_a_first_segment_by_itself(limits: tuple[float, ...], distance: float) -> None:
    """Against the steepest start there is, step by step: a <= J t, a <= A, v + a^2 / (2 J) <= V."""
    V, A, J = (*limits, np.inf)[:3]
    t, h, x, v, a = 0.0, 1e-4, 0.0, 0.0, 0.0
    while x < distance:
        a = min(a + J * h if np.isfinite(J) else A, A, math.sqrt(2.0 * J * max(V - v, 0.0)))
        a = min(a, (V - v) / h)
        x, v, t = x + h * (v + h * a / 2.0), v + h * a, t + h
    alone = least_durations(task_of([[0.0], [distance], [0.0]], *limits))
    assert alone[0] == alone[1] == pytest.approx(t, rel=1e-3, abs=1e-4)
    assert least_durations(task_of([[-1.0], [0.0], [distance], [0.0]], *limits))[1] <= distance / V


@given(distances=st.lists(SIZE, min_size=1, max_size=4), V=SIZE, A=SIZE, J=SIZE)
@settings(max_examples=15)
def test_two_waypoints_are_ruckigs(distances: list[float], V: float, A: float, J: float) -> None:
    problem = task_of([np.zeros(len(distances)), distances], V, A, J)
    optimum = max(rest_to_rest(d, V, A, J) for d in distances)
    bound = free_form_bound(problem, gap=1e-6)
    assert optimum * (1.0 - 1e-9) <= bound.seconds <= optimum
    assert bound.upper == pytest.approx(optimum, rel=1e-6)


def test_turning_between_walls_without_a_jerk_limit_is_a_row_of_trapezoids() -> None:
    problem = task_of([[0.0], [1.0], [0.0], [1.0]], 1.0, 3.0, position=(0.0, 1.0))
    bound = free_form_bound(problem, gap=1e-6)
    trapezoids = 3.0 * rest_to_rest(1.0, 1.0, 3.0, np.inf)
    assert trapezoids * (1.0 - 1e-6) <= bound.seconds <= trapezoids * (1.0 + 1e-8)


def test_with_a_velocity_limit_alone_displacement_is_the_bound() -> None:
    problem = task_of([[0.0, 0.0], [1.0, 3.0], [2.0, 2.0]], [1.0, 2.0])
    bound = free_form_bound(problem)
    assert bound.seconds == pytest.approx(2.5, rel=1e-11)
    assert bound.method == "displacement"
    assert bound.status.startswith("simple bounds only")


def test_nothing_moves() -> None:
    bound = free_form_bound(task_of([[1.0, 2.0]] * 3, 1.0, 2.0, 3.0))
    assert (bound.seconds, bound.upper, bound.gap, bound.status) == (0.0, 0.0, 0.0, "proved")


# --- never above any motion, and close to the fastest ---------------------------------------------


@given(problem=problems(segments=st.integers(1, 4), reach=(-3.0, 1.0), limited=("va", "vj", "vaj")))
@settings(max_examples=12)
def test_it_is_below_stop_and_go_and_its_own_motion(problem: Problem) -> None:
    bound = free_form_bound(problem, gap=5e-2, time_limit=1.0)
    holds(problem, bound)
    reference = REFERENCES["ruckig_stop_and_go"](problem)
    if reference.seconds is not None:
        assert bound.least_verified <= reference.seconds


@pytest.mark.parametrize("case", ["ur5", "sr4c", "cobot"])
def test_no_family_is_faster(case: str) -> None:
    ladder = climbed(case)
    bound = free_form_bound(ladder.problem)
    holds(ladder.problem, bound)
    for key, motion in ladder.trajectories.items():
        assert (
            bound.least_verified <= check(ladder.problem, motion).seconds or key == "ruckig_end_to_end"
        )
    for key in ("displacement", "ruckig_end_to_end"):
        assert bound.seconds >= (ladder.seconds(key) or 0.0) * (1.0 - 1e-11)


@pytest.mark.parametrize(
    ("problem", "gap"),
    [
        (load("ur5"), 1e-4),
        (unbounded(load("sr4c")), 1e-6),
        (unbounded(jerk_limited("sr4c", 5.0)), 1e-4),
        (unbounded(load("z1")), 1e-6),
    ],
    ids=["ur5", "sr4c", "sr4c with jerk", "z1"],
)
def test_the_gap_is_closed_where_it_is_promised(problem: Problem, gap: float) -> None:
    bound = free_form_bound(problem, gap=gap)
    holds(problem, bound)
    assert bound.status == "proved"
    assert bound.gap is not None
    assert bound.gap <= gap


def test_position_limits_raise_the_bound() -> None:
    """Those of z1 cost half a per cent; those of sr4c nothing, but they must not lower it."""
    for case, least in (("z1", 1.005), ("sr4c", 1.0)):
        limited, free = free_form_bound(load(case)), free_form_bound(unbounded(load(case)))
        assert limited.seconds >= least * free.seconds * (1.0 - 1e-6)


ARMS = {
    "high jerk": (
        [2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61],
        [15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0],
        [7500.0, 3750.0, 5000.0, 6250.0, 7500.0, 10000.0, 10000.0],
    ),
    "low jerk": ([0.44] * 3 + [0.52] * 3, [0.52] * 3 + [0.7] * 3, [0.7] * 3 + [0.9] * 3),
}


@pytest.mark.parametrize("arm", ARMS)
@pytest.mark.parametrize("n", [2, 5, 8])
def test_random_waypoints_of_real_arms_are_solved(arm: str, n: int) -> None:
    limits = ARMS[arm]
    rng = np.random.default_rng(n)
    problem = task_of(rng.uniform(-2.5, 2.5, (n, len(limits[0]))), *limits)
    bound = free_form_bound(problem)
    holds(problem, bound)
    assert bound.gap is not None
    assert bound.gap <= 1e-3


# --- laws -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-3, 7.0])
def test_it_scales_with_time_and_with_space(scale: float) -> None:
    problem = load("ur5")
    limits, bound = problem.limits, free_form_bound(problem, gap=1e-6).seconds
    faster = replace(
        limits,
        velocity=limits.velocity * scale,
        acceleration=limits.acceleration * scale**2,
        jerk=limits.jerk * scale**3,
    )
    quick = free_form_bound(replace(problem, limits=faster), gap=1e-6)
    assert quick.seconds == pytest.approx(bound / scale, rel=1e-6)
    v, a, j = limits.derivatives * scale
    wider = replace(limits, velocity=v, acceleration=a, jerk=j, position=limits.position * scale)
    wide = free_form_bound(
        replace(problem, waypoints=problem.waypoints * scale, limits=wider), gap=1e-6
    )
    assert wide.seconds == pytest.approx(bound, rel=1e-6)


def test_it_is_the_same_backwards_mirrored_and_with_joints_in_any_order() -> None:
    problem = unbounded(load("ur5"))
    bound = free_form_bound(problem, gap=1e-6).seconds
    order = [3, 0, 5, 1, 4, 2]
    limits = Limits.of(*problem.limits.derivatives[:, order], dof=6)
    for other in (
        replace(problem, waypoints=problem.waypoints[::-1]),
        replace(problem, waypoints=-problem.waypoints),
        replace(problem, waypoints=problem.waypoints[:, order], limits=limits),
    ):
        assert free_form_bound(other, gap=1e-6).seconds == pytest.approx(bound, rel=1e-6)


def test_a_waypoint_said_twice_and_a_joint_at_rest_change_nothing() -> None:
    problem = unbounded(load("ur5"))
    bound = free_form_bound(problem, gap=1e-6).seconds
    twice = replace(problem, waypoints=problem.waypoints[[0, 0, 1, 2, 2, 2, 3]])
    more = free_form_bound(twice, gap=1e-6)
    assert more.seconds == pytest.approx(bound, rel=1e-6)
    assert more.durations is not None
    assert (more.durations[[0, 3, 4]] == 0.0).all()
    points = np.column_stack([problem.waypoints, np.full(4, 0.3)])
    v, a, j = np.column_stack([problem.limits.derivatives, [1e-3, 1e-3, 1e-3]])
    still = free_form_bound(task_of(points, v, a, j), gap=1e-6)
    assert still.seconds == pytest.approx(bound, rel=1e-6)


def test_savings_are_the_derivatives_and_obey_the_scaling_law() -> None:
    problem = unbounded(load("ur5"))
    bound = free_form_bound(problem, gap=1e-6)
    saved = bound.savings
    assert saved is not None
    assert saved.shape == (3, 3, 6)
    assert (saved >= -1e-9).all()
    by_limit = saved.sum(axis=1)
    assert float(np.array([1.0, 2.0, 3.0]) @ by_limit.sum(axis=1)) == pytest.approx(
        bound.seconds, rel=1e-3
    )
    h = 1e-4
    for quantity, joint in zip(*np.nonzero(by_limit > 0.05), strict=True):
        more = problem.limits.derivatives.copy()
        more[quantity, joint] *= 1.0 + h
        other = replace(problem, limits=Limits.of(*more, dof=6))
        gained = bound.seconds - free_form_bound(other, gap=1e-6).seconds
        assert gained / h == pytest.approx(by_limit[quantity, joint], rel=0.02, abs=0.02)


# --- boxes, horizons, extremes --------------------------------------------------------------------


def test_tightened_boxes_keep_the_fastest_motion() -> None:
    problem = task_of(np.random.default_rng(3).normal(size=(4, 2)) * 0.1, 3.0, 5.0, 50.0)
    bound = free_form_bound(problem, gap=1e-4)
    assert bound.motion is not None
    motion = exact(problem, bound.motion)
    frame = frame_for(problem, motion.seconds * (1.0 + 1e-9))
    program = Program(frame, random_cuts(frame, np.random.default_rng(0), 5))
    solution = program.solve(frame.cost, rounds=50, tolerance=1e-8)
    boxes = tightened(program, solution, math.inf)
    assert not boxes.empty
    T = np.diff(motion.passage_times)
    assert (boxes.durations[:, 0] <= T).all()
    assert (boxes.durations[:, 1] >= T).all()
    widths = np.diff(boxes.durations, axis=1) / np.diff(frame.durations, axis=1)
    assert widths.max() < 0.2
    a = motion.at(motion.passage_times, 2)[1:-1]
    assert (boxes.accelerations[1:-1, :, 0] <= a + 1e-9).all()
    assert (boxes.accelerations[1:-1, :, 1] >= a - 1e-9).all()


@pytest.mark.parametrize("share", [0.5, 0.99, 1.0, 1.3])
def test_whatever_is_said_to_be_known_the_bound_holds(share: float) -> None:
    """An upper value that no motion has: the bound is no more than it, and than the optimum."""
    problem = task_of([[0.0], [0.4], [1.0]], 1.0, 2.0, 10.0)
    optimum = rest_to_rest(1.0, 1.0, 2.0, 10.0)
    bound = free_form_bound(problem, gap=1e-6, upper=share * optimum, time_limit=5.0)
    assert bound.seconds <= optimum
    assert bound.bounds["relaxation"] <= share * optimum * (1.0 + 2e-6)


def spread(exponents: tuple[float, float], n: int, dof: int, seed: int) -> Array:
    rng = np.random.default_rng(seed)
    steps = 10.0 ** rng.uniform(*exponents, (n, dof)) * rng.choice([-1.0, 1.0], (n, dof))
    return np.cumsum(np.vstack([np.zeros(dof), steps]), axis=0)


@pytest.mark.parametrize(
    "problem",
    [
        task_of([[0.0], [1e-6], [2e-6], [1e-6]], 1.0, 2.0, 3.0),
        task_of([[0.0], [1e3], [-1e3]], 1.0, 2.0, 3.0),
        task_of([[0.0, 0.0], [1e-6, 1.0], [1e3, 1.000001], [1e3 + 1e-6, 0.0]], 1.0, 2.0, 3.0),
        task_of(spread((-6.0, 3.0), 5, 2, 0), [1.0, 2.0], [3.0, 1.0], [10.0, 4.0]),
        task_of(spread((-1.0, 0.0), 4, 3, 1), [0.01, 1, 100], [0.01, 3, 100], [0.1, 10, 1000]),
        task_of(spread((-1.0, 0.0), 4, 3, 2), 1.0, [np.inf, 5.0, 5.0], [np.inf, np.inf, 20.0]),
        task_of(spread((-1.0, 0.0), 29, 1, 3), 1.0, 3.0, 20.0),
        task_of(spread((-1.0, 0.0), 29, 12, 4), 1.0, 3.0, 20.0),
        task_of(spread((-1.0, 0.0), 3, 2, 5), 1e-8, 1e-8, 1e-8),
        task_of(spread((-1.0, 0.0), 3, 2, 6), 1e8, 1e8, 1e8),
        task_of([[0.0], [5e-324]], 1.0, 1.0),
    ],
    ids=[
        *("micrometres", "kilometres", "both", "nine decades", "limits of four decades"),
        *("unlimited ones", "thirty waypoints", "thirty, twelve joints", "slow", "fast", "denormal"),
    ],
)
def test_extremes_are_survived(problem: Problem) -> None:
    bound = free_form_bound(problem, gap=1e-2, time_limit=1.5)
    holds(problem, bound)
    assert math.isfinite(bound.seconds)
    assert bound.status


def test_the_time_limit_is_kept_and_progress_only_grows() -> None:
    problem = task_of(spread((-2.0, -1.0), 12, 6, 0), 3.0, 5.0, 50.0)
    seen: list[float] = []
    bound = free_form_bound(
        problem, gap=1e-9, time_limit=1.0, progress=lambda seconds, upper: seen.append(seconds)
    )
    assert bound.runtime < 4.0
    assert bound.status == "time limit"
    assert seen == sorted(seen)
    assert bound.seconds == seen[-1]


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ({"gap": 0.0}, "gap: 0.0 is not a positive number"),
        ({"gap": math.nan}, "gap: nan is not a positive number"),
        ({"upper": -1.0}, "upper: -1.0 s is not a time"),
        ({"time_limit": math.nan}, "time_limit: nan s is not a time"),
    ],
)
def test_misuse_is_refused_by_name(what: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        free_form_bound(load("sr4c"), **what)  # type: ignore[arg-type]
