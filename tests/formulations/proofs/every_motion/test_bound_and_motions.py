"""The bound is never above any motion, and close to the fastest one."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import climbed, problems
from every_motion_helpers import holds, jerk_limited, problem_of, unbounded
from hypothesis import given, settings
from hypothesis import strategies as st

from formulations import REFERENCES, Problem, check, free_form_bound, load


@pytest.mark.long
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
    problem = problem_of(rng.uniform(-2.5, 2.5, (n, len(limits[0]))), *limits)
    bound = free_form_bound(problem)
    holds(problem, bound)
    assert bound.gap is not None
    assert bound.gap <= 1e-3
