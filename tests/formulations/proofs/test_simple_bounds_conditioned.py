"""The bounds in closed form under conditions, against the exact optimum of a linear program."""

from __future__ import annotations

import math

import numpy as np
import pytest
from conditioned_problems import conditioned_problems
from hypothesis import HealthCheck, given, settings
from scipy.optimize import linprog

from formulations import Conditions, Limits, Problem, load
from formulations.proofs.displacement import displacement_bound, displacement_durations
from formulations.proofs.rest_to_rest import end_to_end_bound, rest_to_rest_bound

SLOW = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow], max_examples=120)


def fastest_at_top_speed(problem: Problem) -> float | None:
    """The least time where speeds may jump, from the conditions as they were given; None where there is none.

    Unknown are the positions x (n + 1, dof) at the waypoints and the times t (n,) of the segments.
    """
    asked, n, dof = problem.conditions, problem.n_segments, problem.dof
    size = (n + 1) * dof + n
    rows: list[np.ndarray] = []
    right: list[float] = []

    def time(k: int) -> int:
        return (n + 1) * dof + k

    for k in range(n):
        own = asked.segment_limits.get(k, problem.limits)
        for j in range(dof):
            low, high = own.intervals[0][j]
            for sign, speed in ((1.0, high), (-1.0, -low)):  # sign (x_k+1 - x_k) <= speed t_k
                row = np.zeros(size)
                row[(k + 1) * dof + j], row[k * dof + j], row[time(k)] = sign, -sign, -speed
                rows.append(row)
                right.append(0.0)
    waits = [asked.waits.get(k, 0.0) for k in range(n + 1)]
    windows = {**asked.windows, **{k: (t, t) for k, t in asked.passage.items()}}
    if asked.total is not None:
        windows[n] = (asked.total, asked.total)
    for k, (early, late) in windows.items():
        row = np.zeros(size)
        row[[time(i) for i in range(k)]] = 1.0
        waited = sum(waits[:k])
        rows.append(-row)
        right.append(waited - early)
        if math.isfinite(late):
            rows.append(row)
            right.append(late - waited)
    bounds = []
    for k in range(n + 1):
        zone = asked.tolerance.get(k, np.zeros(dof))
        bounds += [(x - r, x + r) for x, r in zip(problem.waypoints[k], zone, strict=True)]
    for k in range(n):
        least, most = asked.segment_times.get(k, (0.0, math.inf))
        bounds.append((least, None if math.isinf(most) else most))
    cost = np.r_[np.zeros((n + 1) * dof), np.ones(n)]
    found = linprog(cost, A_ub=np.array(rows), b_ub=right, bounds=bounds, method="highs")
    return found.fun + sum(waits) if found.status == 0 else None


@SLOW
@given(problem=conditioned_problems())
def test_no_motion_at_top_speed_is_faster_than_the_displacement_bound(problem: Problem) -> None:
    exact = fastest_at_top_speed(problem)
    if exact is None:
        return  # nothing keeps these conditions, so every bound holds
    assert displacement_bound(problem) <= exact + 1e-6 * (1.0 + exact)


@SLOW
@given(problem=conditioned_problems())
def test_the_end_to_end_bound_is_not_above_it_without_limits_of_higher_order(problem: Problem) -> None:
    exact = fastest_at_top_speed(problem)
    if exact is None or problem.limits.has_acceleration:
        return
    assert end_to_end_bound(problem) <= exact + 1e-6 * (1.0 + exact)


def one_joint(points: list[float], **asked: object) -> Problem:
    limits = Limits.of([[-1.0, 2.0]], dof=1)
    return Problem(np.array(points)[:, None], limits, conditions=Conditions(**asked))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("problem", "seconds"),
    [
        (one_joint([0.0, 4.0, 1.0]), 2.0 + 3.0),  # each direction has its own limit
        (one_joint([0.0, 4.0, 1.0], tolerance={1: np.array([1.0])}), 1.5 + 2.0),
        (one_joint([0.0, 0.5, 1.0], tolerance={1: np.array([0.5])}), 0.0),  # the zones meet
        (one_joint([0.0, 4.0, 1.0], waits={1: 0.5}), 2.0 + 0.5 + 3.0),
        (one_joint([0.0, 4.0, 1.0], segment_times={0: (3.0, math.inf)}), 3.0 + 3.0),
        (one_joint([0.0, 4.0, 1.0], windows={1: (6.0, math.inf)}, waits={1: 1.0}), 6.0 + 1.0 + 3.0),
        (one_joint([0.0, 4.0, 1.0], windows={2: (9.0, 10.0)}), 9.0),
        (one_joint([0.0, 4.0, 1.0], segment_limits={1: Limits.of(0.5, dof=1)}), 2.0 + 6.0),
        (one_joint([0.0, 4.0, 1.0], end_velocity="free", start_velocity="free"), 5.0),
    ],
)  # fmt: skip
def test_the_displacement_bound_by_hand(problem: Problem, seconds: float) -> None:
    assert displacement_bound(problem) == seconds


def test_given_conditions_replace_those_of_the_problem() -> None:
    problem = one_joint([0.0, 4.0, 1.0], waits={1: 0.5})
    assert displacement_bound(problem, Conditions()) == 5.0
    assert displacement_durations(problem, Conditions()).tolist() == [2.0, 3.0]


def test_the_end_to_end_bound_takes_the_nearest_points_of_the_zones_and_knows_moving_ends() -> None:
    limits = Limits.of(1.0, 2.0, 8.0, dof=1)

    def bound(**asked: object) -> float:
        return end_to_end_bound(
            Problem([[0.0], [9.0], [2.0]], limits, conditions=Conditions(**asked))  # type: ignore[arg-type]
        )

    from fractions import Fraction

    zones = {0: np.array([0.25]), 2: np.array([0.5])}
    assert bound() == rest_to_rest_bound(Fraction(2), 1.0, 2.0, 8.0)
    assert bound(tolerance=zones) == rest_to_rest_bound(Fraction(5, 4), 1.0, 2.0, 8.0)
    for key, value in (("end_velocity", np.array([0.5])), ("start_velocity", "free"),
                       ("end_acceleration", "free"), ("start_acceleration", np.array([-1.0]))):  # fmt: skip
        assert bound(**{key: value}) == 2.0
    faster = {1: Limits.of(4.0, 2.0, 8.0, dof=1)}
    assert bound(segment_limits=faster) == rest_to_rest_bound(Fraction(2), 4.0, 2.0, 8.0)


@pytest.mark.parametrize("case", ["sr4c", "ur5"])
def test_the_bounds_of_plain_problems_are_the_sums_of_the_formula(case: str) -> None:
    problem = load(case)
    by_hand = (np.abs(problem.displacements) / problem.limits.velocity).max(axis=1).sum()
    assert displacement_bound(problem) == pytest.approx(by_hand, rel=1e-14)
