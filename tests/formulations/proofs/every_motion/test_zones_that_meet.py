"""The bound of motions through zones that meet, where a segment may take no time: closed forms and oracles."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from compare.check_certificate.verify import verify
from compare.studies.conditioned_problems import drawn_problem
from formulations import Conditions, Limits, Problem, check, free_form, free_form_bound

A, J = 2.0, 30.0  # the other limits are out of reach
FAR = 100.0


def through(boxes: list[list[tuple[float, float]]], limits: Limits, **asked: Any) -> Problem:
    """A problem through boxes, (low, high) per waypoint and joint."""
    box = np.array(boxes)
    half = {k: (box[k, :, 1] - box[k, :, 0]) / 2.0 for k in range(len(box))}
    zones = {k: width for k, width in half.items() if width.any()}
    return Problem(box.mean(axis=-1), limits, conditions=Conditions(tolerance=zones, **asked))


def at(x: float) -> list[tuple[float, float]]:
    """A waypoint of one joint that is no zone."""
    return [(x, x)]


def proved(problem: Problem, truth: float, gap: float = 1e-5) -> None:
    """The bound is just below the truth, and so is what the checker proves again."""
    bound = free_form_bound(problem, gap=gap / 2.0, upper=truth * (1.0 + 1e-9), record=True)
    assert bound.seconds <= truth * (1.0 + 2e-9)
    assert bound.seconds >= truth * (1.0 - gap)
    assert bound.certificate is not None
    verify(bound.certificate)
    assert float.fromhex(bound.certificate["seconds"]) >= truth * (1.0 - 10.0 * gap)


ACCELERATION = Limits.of(velocity=FAR, acceleration=A, dof=1)
JERK = Limits.of(velocity=FAR, acceleration=FAR, jerk=J, dof=1)


@pytest.mark.parametrize("limits", [ACCELERATION, JERK], ids=["acceleration", "jerk"])
def test_the_last_zone_is_entered_at_the_edge_of_the_one_before(limits: Limits) -> None:
    """Both zones are reached at 1, where the joint rests; without the first it would rest at 0.5."""
    truth = 2.0 * math.sqrt(1.0 / A) if limits is ACCELERATION else (32.0 / J) ** (1.0 / 3.0)
    proved(through([at(0.0), [(1.0, 1.2)], [(0.5, 1.1)]], limits), truth, 5e-5)


def test_a_joint_turns_round_where_two_zones_meet() -> None:
    """To 1 and back to 0, turning at full deceleration: as long as twice from rest to rest."""
    proved(
        through([at(0.0), [(1.0, 1.2)], [(0.9, 1.1)], at(0.0)], ACCELERATION), 4.0 * math.sqrt(1.0 / A)
    )


def test_the_first_zones_hold_the_start() -> None:
    """They ask for nothing, and are left out."""
    problem = through([at(0.0), [(-0.1, 0.1)], [(-0.2, 0.3)], at(1.0)], ACCELERATION)
    bound = free_form_bound(problem, gap=1e-6, record=True)
    assert bound.certificate is not None
    assert bound.certificate["without"] == [1, 2]
    proved(problem, 2.0 * math.sqrt(1.0 / A))


def test_zones_that_meet_two_and_two_and_yet_take_time() -> None:
    """No displacement at top speed is forced between neighbours, and still the joint has to move 0.2."""
    problem = through([[(0.0, 0.5)], [(0.4, 0.9)], [(0.7, 1.2)]], ACCELERATION)
    proved(problem, 2.0 * math.sqrt(0.2 / A), 5e-5)


def least_path(boxes: np.ndarray) -> float:
    """Length of the shortest path of one joint through intervals: to the nearest point of each."""
    x, length = float(np.clip(boxes[1, 0], *boxes[0])), 0.0
    best = math.inf
    for start in np.linspace(*boxes[0], 201) if boxes[0, 0] < boxes[0, 1] else [x]:
        x, length = float(start), 0.0
        for low, high in boxes[1:]:
            nearest = min(max(x, low), high)
            length, x = length + abs(nearest - x), nearest
        best = min(best, length)
    return best


def test_a_velocity_limit_alone_and_a_way_back() -> None:
    """To 1 and back to 0.4: 1.6 rad at 2 rad/s, where the gaps between the zones add up to 1.3."""
    boxes = [at(0.0), [(1.0, 1.2)], [(0.7, 1.1)], [(0.2, 0.4)]]
    problem = through(boxes, Limits.of(velocity=2.0, dof=1))
    truth = least_path(np.array(boxes)[:, 0]) / 2.0
    assert truth == pytest.approx(0.8)
    proved(problem, truth, 1e-8)


@settings(max_examples=15)
@given(seed=st.integers(0, 10**6), dof=st.integers(1, 3), n=st.integers(2, 5))
def test_velocity_limits_alone_are_solved_exactly(seed: int, dof: int, n: int) -> None:
    """Against the linear program over positions and durations, posed here."""
    rng = np.random.default_rng(seed)
    low = rng.uniform(-1.0, 1.0, (n + 1, dof))
    high = low + rng.uniform(0.0, 0.8, (n + 1, dof))
    high[0] = low[0]
    V = rng.uniform(0.5, 3.0, dof)
    problem = through(np.stack([low, high], axis=-1).tolist(), Limits.of(velocity=V, dof=dof))
    rows, size = [], (n + 1) * dof + n
    for k in range(n):
        for j in range(dof):
            for sign in (1.0, -1.0):
                row = np.zeros(size)
                row[(k + 1) * dof + j], row[k * dof + j], row[(n + 1) * dof + k] = sign, -sign, -V[j]
                rows.append(row)
    cost = np.concatenate([np.zeros((n + 1) * dof), np.ones(n)])
    bounds = [*zip(low.ravel(), high.ravel(), strict=True), *[(0.0, None)] * n]
    truth = linprog(cost, A_ub=np.array(rows), b_ub=np.zeros(len(rows)), bounds=bounds).fun
    bound = free_form_bound(problem, gap=1e-6, upper=max(truth, 1e-12))
    assert bound.seconds <= truth * (1.0 + 1e-9) + 1e-12
    if truth > 1e-6:
        assert bound.seconds >= truth * (1.0 - 1e-5)


@pytest.mark.long
@pytest.mark.parametrize("seed", [26, 33, 46, 63, 85, 88])
def test_random_problems_with_zones_that_meet(seed: int) -> None:
    problem = drawn_problem("zones", seed)
    motion = free_form(problem, tolerance=1e-4).trajectory
    assert motion is not None
    assert check(problem, motion).feasible
    bound = free_form_bound(problem, gap=9e-5, upper=motion.seconds, time_limit=200.0)
    assert motion.seconds * (1.0 - 1e-4) <= bound.seconds <= motion.seconds * (1.0 + 1e-9)
