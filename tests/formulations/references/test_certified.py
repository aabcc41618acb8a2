"""What the ladder calls certified is no larger than the exact value, in rational arithmetic."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from math import isinf

import numpy as np
import pytest
from conftest import problems
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import CASES, REFERENCES, Limits, Problem, load
from formulations.problem.demands import Demands
from formulations.proofs.displacement import displacement_bound
from formulations.proofs.every_motion.horizons import HorizonSearch
from formulations.proofs.rest_to_rest import rest_to_rest, rest_to_rest_bound


def exact_displacement(problem: Problem) -> Fraction:
    """The sum over the segments of the slowest joint at top speed, without any rounding [s]."""
    speeds = [Fraction(v) for v in problem.limits.velocity.tolist()]
    rows = [[Fraction(x) for x in row] for row in problem.waypoints.tolist()]
    return sum(
        (max(abs(y - x) / v for x, y, v in zip(a, b, speeds, strict=True)) for a, b in pairwise(rows)),
        Fraction(0),
    )


def farthest(T: Fraction, V: Fraction, A: Fraction | None, J: Fraction | None) -> Fraction:
    """A distance [rad] that a joint surely covers from rest to rest in T seconds, by simulation.

    It rises with the profile jerk J, acceleration A, jerk -J to a speed of at most V, and falls likewise.
    The times of the profile are rounded down to rational numbers, so the motion keeps its limits.
    """

    def root(x: Fraction) -> Fraction:
        low = Fraction(np.sqrt(float(x))) * (1 - Fraction(1, 2**50))
        return low if low * low <= x else low * (1 - Fraction(1, 2**50))

    half = T / 2
    if J is None:
        assert A is not None
        rise = min(half, V / A)
        v, covered = A * rise, A * rise * rise / 2
        return 2 * covered + v * (T - 2 * rise)
    jerk_time = min(half / 2, root(V / J))
    if A is not None:
        jerk_time = min(jerk_time, A / J)
    a = J * jerk_time
    hold = max(min(half - 2 * jerk_time, V / a - jerk_time), Fraction(0)) if a else Fraction(0)
    x, v = Fraction(0), Fraction(0)
    for start, jerk, time in ((Fraction(0), J, jerk_time), (a, Fraction(0), hold), (a, -J, jerk_time)):
        x += v * time + start * time**2 / 2 + jerk * time**3 / 6
        v += start * time + jerk * time**2 / 2
    assert v <= V
    return 2 * x + v * (T - 2 * (2 * jerk_time + hold))


def end_to_end_holds(problem: Problem, seconds: float) -> None:
    """Some joint cannot do it faster: in a hair more time it gets there, and not before.

    The bound is at most the time of a motion that covers at least the distance, for one joint; for all
    joints together, that of the slowest.
    """
    slowest = Fraction(0)
    for j in range(problem.dof):
        d = abs(Fraction(problem.waypoints[-1, j]) - Fraction(problem.waypoints[0, j]))
        V, A, J = (None if isinf(x) else Fraction(x) for x in problem.limits.derivatives[:, j].tolist())
        assert V is not None
        if d == 0 or (A is None and J is None):
            slowest = max(slowest, d / V)
            continue
        low, high = Fraction(0), Fraction(1)
        while farthest(high, V, A, J) < d:
            high *= 2
        for _ in range(70):  # high is the time of a motion that gets there
            middle = (low + high) / 2
            middle = Fraction(middle.numerator, middle.denominator)
            if farthest(middle, V, A, J) < d:
                low = middle
            else:
                high = middle
        slowest = max(slowest, high)
    assert Fraction(seconds) <= slowest
    assert slowest <= Fraction(seconds) * (1 + Fraction(1, 10**13))


@pytest.mark.parametrize("case", CASES)
def test_the_displacement_bound_of_a_case_is_below_the_exact_one(case: str) -> None:
    holds(load(case))


@given(problem=problems(segments=st.integers(1, 8), max_dof=4))
@settings(max_examples=300)
def test_the_displacement_bound_is_the_largest_float_below_the_exact_one(problem: Problem) -> None:
    holds(problem)


def holds(problem: Problem) -> None:
    exact = exact_displacement(problem)
    outcome = REFERENCES["displacement"](problem)
    assert outcome.seconds is not None
    assert Fraction(outcome.seconds) <= exact
    assert Fraction(float(np.nextafter(outcome.seconds, np.inf))) > exact
    assert Fraction(HorizonSearch(Demands.of(problem), None, None).bounds["displacement"]) <= exact


@pytest.mark.parametrize("velocity", [1.0, 1e9, np.inf])
@pytest.mark.parametrize("acceleration", [1.0, 1e200, np.inf])
@pytest.mark.parametrize("jerk", [1.0, 1e-200, np.inf])
def test_extreme_and_absent_limits_have_a_bound(
    velocity: float, acceleration: float, jerk: float
) -> None:
    """In code a velocity may be unlimited; a motion then needs no time, or what the others ask for."""
    bound = rest_to_rest_bound(Fraction(2), velocity, acceleration, jerk)
    close = rest_to_rest(2.0, velocity, acceleration, jerk)
    assert bound >= 0.0
    assert bound == pytest.approx(close, rel=1e-14, abs=0.0)
    unlimited = replace(Limits.of(1.0, dof=1), velocity=np.array([np.inf]))
    assert displacement_bound(Problem.of([[0.0], [1.0]], unlimited)) == 0.0


@pytest.mark.parametrize("case", CASES)
def test_the_end_to_end_bound_of_a_case_is_below_the_exact_one(case: str) -> None:
    problem = load(case)
    seconds = REFERENCES["ruckig_end_to_end"](problem).seconds
    if seconds is not None:
        end_to_end_holds(problem, seconds)


@given(problem=problems(segments=st.integers(1, 3), limited=("va", "vaj"), reach=(-3.0, 2.0)))
@settings(max_examples=100)
def test_the_end_to_end_bound_is_below_the_exact_one(problem: Problem) -> None:
    seconds = REFERENCES["ruckig_end_to_end"](problem).seconds
    assert seconds is not None
    end_to_end_holds(problem, seconds)
