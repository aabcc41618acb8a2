"""The search in linear time under conditions: beside the nonlinear program, and laws for all of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from formulations import Conditions, Limits, Problem, check, free_form
from formulations.optima.free_form import many_waypoints

LIMITS = Limits.of(velocity=2.0, acceleration=5.0, jerk=50.0, dof=2)


def random_problem(n_waypoints: int, seed: int) -> Problem:
    rng = np.random.default_rng(seed)
    steps = rng.uniform(0.2, 1.0, (n_waypoints - 1, 2)) * rng.choice([-1.0, 1.0], (n_waypoints - 1, 2))
    return Problem(np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)]), LIMITS)


SLOW = Limits.of(velocity=1.0, acceleration=2.0, jerk=30.0, dof=2)
ASKED: dict[str, Conditions] = {
    "zones": Conditions(tolerance={k: np.full(2, 0.05) for k in range(1, 11)}),
    "one zone": Conditions(tolerance={4: np.array([0.1, 0.0])}),
    "stop": Conditions(stops=frozenset({5})),
    "wait": Conditions(waits={3: 0.2, 7: 0.5}),
    "least times": Conditions(segment_times={2: (1.0, np.inf), 6: (0.7, np.inf)}),
    "limits of segments": Conditions(segment_limits={4: SLOW, 5: SLOW}),
    "free end": Conditions(end_velocity="free", end_acceleration="free"),
    "all": Conditions(
        tolerance={k: np.full(2, 0.03) for k in (1, 2, 8)},
        stops=frozenset({6}),
        waits={3: 0.2},
        segment_times={9: (1.0, np.inf)},
        segment_limits={4: SLOW},
    ),
}


@pytest.fixture
def always(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(many_waypoints, "MANY", 1)
    monkeypatch.setattr(many_waypoints, "_WIDE", 1)


@pytest.mark.usefixtures("always")
@pytest.mark.parametrize("kind", ASKED)
def test_no_slower_than_the_program_of_the_whole_motion(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = random_problem(12, 1)
    found = free_form(problem, conditions=ASKED[kind], tolerance=1e-5)
    assert found.method == many_waypoints.NAME
    assert check(problem, found.trajectory, conditions=ASKED[kind]).feasible
    monkeypatch.setattr(many_waypoints, "MANY", 10_000)
    whole = free_form(problem, conditions=ASKED[kind], tolerance=1e-5)
    assert whole.method != many_waypoints.NAME
    assert found.seconds <= whole.seconds * (1.0 + 1e-4)


@pytest.mark.usefixtures("always")
@pytest.mark.parametrize("seed", range(3))
def test_zones_never_make_a_motion_slower_and_waits_add_their_time(seed: int) -> None:
    problem = random_problem(15, seed)

    def seconds(**asked: Any) -> float:
        found = free_form(problem, conditions=Conditions(**asked), tolerance=1e-5)
        assert found.method == many_waypoints.NAME
        return found.seconds

    through = seconds()
    wide, wider = ({k: np.full(2, size) for k in range(1, 14)} for size in (0.01, 0.08))
    assert seconds(tolerance=wider) < seconds(tolerance=wide) < through
    stopped = seconds(stops=frozenset({7}))
    assert through < stopped
    assert seconds(waits={7: 0.4}) == pytest.approx(stopped + 0.4, rel=2e-5)


@pytest.mark.usefixtures("always")
@pytest.mark.parametrize("calls", [0, 1, 30, 120])
def test_an_interrupt_leaves_a_verified_motion(calls: int) -> None:
    problem, asked = random_problem(12, 2), []

    def stop() -> bool:
        asked.append(None)
        return len(asked) > calls

    found = free_form(problem, conditions=ASKED["all"], stop=stop)
    assert check(problem, found.trajectory, conditions=ASKED["all"]).feasible


@pytest.mark.usefixtures("always")
@pytest.mark.parametrize(
    "asked",
    [
        Conditions(start_velocity=np.array([0.1, 0.0])),
        Conditions(windows={4: (0.0, 50.0)}),
        Conditions(passage={4: 30.0}),
        Conditions(segment_times={2: (0.0, 30.0)}),
        Conditions(cyclic=True),
    ],
    ids=["moving start", "window", "passage", "latest time", "cycle"],
)
def test_what_it_does_not_know_is_left_to_the_programs(asked: Conditions) -> None:
    problem = random_problem(8, 3)
    if asked.cyclic:
        problem = replace(problem, waypoints=np.vstack([problem.waypoints, problem.waypoints[:1]]))
    found = free_form(problem, conditions=asked)
    assert found.method != many_waypoints.NAME
    assert check(problem, found.trajectory, conditions=asked).feasible


@pytest.mark.long
def test_three_hundred_zones_take_no_longer_than_the_waypoints() -> None:
    rng = np.random.default_rng(0)
    limits = Limits.of(velocity=2.0, acceleration=5.0, jerk=50.0, dof=7)
    problem = Problem(np.cumsum(rng.uniform(-1.0, 1.0, (300, 7)), axis=0), limits)
    zones = Conditions(tolerance={k: np.full(7, 0.05) for k in range(1, 299)})
    found = free_form(problem, conditions=zones)
    assert found.method == many_waypoints.NAME
    assert check(problem, found.trajectory, conditions=zones).feasible
    assert found.seconds < 0.93 * free_form(problem).seconds
