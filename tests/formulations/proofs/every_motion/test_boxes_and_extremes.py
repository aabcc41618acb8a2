"""Boxes, horizons and extreme numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from every_motion_helpers import exact, frame_for, holds, problem_of, random_cuts, spread

from formulations import InputError, Problem, free_form_bound, load
from formulations.deadlines import Deadline
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram
from formulations.proofs.every_motion.relaxation.tightening import tighten
from formulations.proofs.rest_to_rest import rest_to_rest


def test_tightened_boxes_keep_the_fastest_motion() -> None:
    problem = problem_of(np.random.default_rng(3).normal(size=(4, 2)) * 0.1, 3.0, 5.0, 50.0)
    bound = free_form_bound(problem, gap=1e-4)
    assert bound.motion is not None
    motion = exact(problem, bound.motion)
    frame = frame_for(problem, motion.seconds * (1.0 + 1e-9))
    program = LinearProgram(frame, random_cuts(frame, np.random.default_rng(0), 5))
    solution = program.solve(frame.cost, rounds=50, tolerance=1e-8)
    boxes, _ = tighten(program, solution, Deadline(None))
    assert not boxes.empty
    T = np.diff(motion.passage_times)
    assert (boxes.durations[:, 0] <= T).all()
    assert (boxes.durations[:, 1] >= T).all()
    widths = np.diff(boxes.durations, axis=1) / np.diff(frame.boxes.durations, axis=1)
    assert widths.max() < 0.2
    a = motion.at(motion.passage_times, 2)[1:-1]
    assert (boxes.accelerations[1:-1, :, 0] <= a + 1e-9).all()
    assert (boxes.accelerations[1:-1, :, 1] >= a - 1e-9).all()


@pytest.mark.parametrize("share", [0.5, 0.99, 1.0, 1.3])
def test_whatever_is_said_to_be_known_the_bound_holds(share: float) -> None:
    """An upper value that no motion has: the bound is no more than it, and than the optimum."""
    problem = problem_of([[0.0], [0.4], [1.0]], 1.0, 2.0, 10.0)
    optimum = rest_to_rest(1.0, 1.0, 2.0, 10.0)
    bound = free_form_bound(problem, gap=1e-6, upper=share * optimum, time_limit=5.0)
    assert bound.seconds <= optimum
    assert bound.bounds["relaxation"] <= share * optimum * (1.0 + 2e-6)


@pytest.mark.parametrize(
    "problem",
    [
        problem_of([[0.0], [1e-6], [2e-6], [1e-6]], 1.0, 2.0, 3.0),
        problem_of([[0.0], [1e3], [-1e3]], 1.0, 2.0, 3.0),
        problem_of([[0.0, 0.0], [1e-6, 1.0], [1e3, 1.000001], [1e3 + 1e-6, 0.0]], 1.0, 2.0, 3.0),
        problem_of(spread((-6.0, 3.0), 5, 2, 0), [1.0, 2.0], [3.0, 1.0], [10.0, 4.0]),
        problem_of(spread((-1.0, 0.0), 4, 3, 1), [0.01, 1, 100], [0.01, 3, 100], [0.1, 10, 1000]),
        problem_of(spread((-1.0, 0.0), 4, 3, 2), 1.0, [np.inf, 5.0, 5.0], [np.inf, np.inf, 20.0]),
        problem_of(spread((-1.0, 0.0), 29, 1, 3), 1.0, 3.0, 20.0),
        problem_of(spread((-1.0, 0.0), 29, 12, 4), 1.0, 3.0, 20.0),
        problem_of(spread((-1.0, 0.0), 3, 2, 5), 1e-8, 1e-8, 1e-8),
        problem_of(spread((-1.0, 0.0), 3, 2, 6), 1e8, 1e8, 1e8),
        problem_of([[0.0], [5e-324]], 1.0, 1.0),
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
    problem = problem_of(spread((-2.0, -1.0), 12, 6, 0), 3.0, 5.0, 50.0)
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
