"""Every row of the relaxation holds for every motion, and a wrong one is noticed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from every_motion_helpers import (
    LIMITS,
    ROUNDING,
    exact,
    frame_for,
    limited_by,
    point_of,
    problem_of,
    random_cuts,
    splined,
    stopping,
    through_states,
)

from formulations import Trajectory, check
from formulations.problem.arrays import Array
from formulations.proofs.every_motion.relaxation.cuts import (
    FADES,
    SPEED_PRODUCTS,
    SQUARE_PRODUCTS,
    ZONES,
    Cuts,
    Kind,
)
from formulations.proofs.every_motion.relaxation.reach import distance_coefficients
from formulations.proofs.every_motion.relaxation.separation import separate


@pytest.mark.parametrize("kind", LIMITS)
@pytest.mark.parametrize("seed", range(5))
def test_every_row_holds_for_every_motion(kind: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    steps = rng.normal(size=(3 + seed, 3)) * 10.0 ** rng.uniform(-2.0, 0.0, (3 + seed, 1))
    problem = problem_of(np.cumsum(steps, axis=0), *LIMITS[kind])
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
        problem = limited_by(passing, problem_of(motion.at(times), *limits))
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
    in_short = {*SPEED_PRODUCTS, *SQUARE_PRODUCTS, *FADES, Kind.CHANGE}
    in_short |= {kind for kind in Kind if kind.times_T}
    assert used >= set(Kind) - {Kind.CRUISE, *ZONES} - in_short


def test_a_joint_may_use_all_the_speed_it_has_time_for() -> None:
    """Accelerate, brake: half way it is as fast as the horizon allows, and no slower is asked of it."""
    motion = stopping(problem_of([[0.0], [1.0]], 10.0, 3.0))
    problem = problem_of([[0.0], [0.5], [1.0]], 10.0, 3.0)
    passing = replace(motion, passages=np.array([0.0, 0.5, 1.0]) * motion.seconds)
    frame = frame_for(problem, motion.seconds)
    x = point_of(frame, problem, passing)
    assert x[frame.v[1, 0]] == pytest.approx(1.0, rel=1e-12)
    assert frame.relaxed.velocity[0] == pytest.approx(3.0 * motion.seconds / 2.0, rel=1e-12)


def test_a_wrong_row_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A coefficient of the jerk that is a hundredth too small would break the test above."""

    def wrong(switches: Array, cruises: bool) -> tuple[Array, ...]:
        *rest, c_J = distance_coefficients(switches, cruises)
        return *rest, 0.99 * c_J

    problem = problem_of([[0.0], [1.0]], [10.0], [10.0], [1.0])
    motion = stopping(problem)
    frame = frame_for(problem, 2.0 * motion.seconds)
    # the motion that goes farthest: jerk J, -J, J, switched at a quarter and at three quarters
    at = np.array([[0.25, 0.25, 0.25, 0.75, 0.75, 0.75]])
    cut, x = Cuts.of(Kind.DISTANCE, np.zeros(1, np.intp), at), point_of(frame, problem, motion)
    rows = frame.of(cut)
    assert (rows.matrix @ x)[0] == pytest.approx(rows.upper[0], abs=1e-12)
    monkeypatch.setattr("formulations.proofs.every_motion.relaxation.rows.distance_coefficients", wrong)
    rows = frame.of(cut)
    assert (rows.matrix @ x)[0] > rows.upper[0] + 1e-4
