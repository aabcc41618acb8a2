"""What holds of every reference, and the displacements."""

from __future__ import annotations

import inspect
from itertools import pairwise

import numpy as np
import pytest
from conftest import problems
from hypothesis import given
from hypothesis import strategies as st

from formulations import REFERENCES, Limits, Problem, family_optimum, load
from formulations.proofs.displacement import displacement_durations
from formulations.references import Outcome, toppra_on

# --- displacement ---------------------------------------------------------------------------------


@given(problem=problems(segments=st.integers(1, 6)))
def test_displacement_is_the_sum_of_the_slowest_joints_at_top_speed(problem: Problem) -> None:
    total = 0.0
    for a, b in pairwise(problem.waypoints):
        total += max(abs(y - x) / v for x, y, v in zip(a, b, problem.limits.velocity, strict=True))
    outcome = REFERENCES["displacement"](problem)
    assert outcome.status == "ok"
    assert outcome.seconds == pytest.approx(total, rel=1e-12, abs=0.0)
    assert outcome.durations is not None
    # sum and terms are each rounded down from exact numbers (test_certified.py), so they may differ
    # by the rounding of the sum
    assert outcome.durations.sum() == pytest.approx(outcome.seconds, rel=2e-15, abs=0.0)
    np.testing.assert_array_equal(outcome.durations, displacement_durations(problem))


def test_displacement_of_the_cobot_by_hand() -> None:
    """100 deg/s: segments move 30, 45 (joint 5) and 45 degrees (joint 2)."""
    outcome = REFERENCES["displacement"](load("cobot"))
    assert outcome.seconds == pytest.approx(1.2, rel=1e-14)
    assert outcome.durations is not None
    np.testing.assert_allclose(outcome.durations, [0.3, 0.45, 0.45], rtol=1e-14)


def test_nothing_that_moves_takes_no_time() -> None:
    still = Problem.of(np.full((4, 2), 0.5), Limits.of(1.0, 1.0, 1.0, dof=2))
    for key, reference in REFERENCES.items():
        outcome = reference(still)
        if key == "toppra_torque":
            assert outcome.status == "not-applicable"
            continue
        assert outcome.status == "ok"
        assert outcome.seconds == 0.0
    assert toppra_on(still, family_optimum(still).trajectory).seconds == 0.0


# --- one signature --------------------------------------------------------------------------------


@pytest.mark.parametrize("key", list(REFERENCES))
def test_every_reference_has_the_one_signature(key: str) -> None:
    assert list(inspect.signature(REFERENCES[key]).parameters) == ["problem"]
    outcome = REFERENCES[key](load("sr4c"))
    assert isinstance(outcome, Outcome)
    if key == "toppra_torque":  # sr4c has no torque limits
        assert (outcome.status, outcome.note) == ("not-applicable", "no torque limits")
        return
    assert outcome.status == "ok"
    assert outcome.seconds is not None
    assert outcome.seconds > 0.0
    if outcome.trajectory is not None:
        assert outcome.trajectory.seconds == pytest.approx(outcome.seconds, rel=1e-9)
