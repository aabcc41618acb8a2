"""Latest times that no motion keeps: the numbers of the message, and silence where nothing is proved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from compare.__main__ import main
from formulations import Conditions, Limits, NoFeasibleMotion, Problem, free_form, ladder, load, plan
from formulations import lateness as module
from formulations.lateness import too_early

A = 4.0  # rad/s^2
ONE = Problem.of([[0.0], [0.5], [1.0]], Limits.of(100.0, A, dof=1))


def test_a_window_before_the_arm_can_be_there() -> None:
    """0.5 rad from rest, arriving at speed: sqrt(2 0.5 / 4) = 0.5 s."""
    said = too_early(ONE, Conditions(windows={1: (0.1, 0.4)}))
    assert said.startswith("waypoint 2: its latest time (conditions.windows[1]) is 0.4 s, 0.1 s before")
    assert said.endswith("none arrives before 0.5 s)")
    assert too_early(ONE, Conditions(windows={1: (0.1, 0.501)})) == ""


def test_a_stop_makes_the_arrival_later() -> None:
    """0.5 rad from rest to rest: 2 sqrt(0.5 / 4) = 0.70711 s."""
    asked = Conditions(windows={1: (0.0, 0.6)}, stops=frozenset({1}))
    assert "none arrives before 0.707107 s" in too_early(ONE, asked)


def test_a_total_a_passage_and_a_greatest_time() -> None:
    assert "waypoint 3: its latest time (conditions.total) is 0.9 s, 0.1 s" in too_early(
        ONE, Conditions(total=0.9)
    )
    assert "waypoint 2: its latest time (conditions.passage[1]) is 0.3 s" in too_early(
        ONE, Conditions(passage={1: 0.3})
    )
    # the second half, braking to rest from any speed: 0.5 s
    said = too_early(ONE, Conditions(segment_times={1: (0.0, 0.3)}))
    assert (
        "segment 2: its greatest time (conditions.segment_times[1]) is 0.3 s, 0.2 s less than any motion takes"
        in said
    )


def test_earlier_demands_count() -> None:
    """A wait of 0.3 s and a least time before the window come first."""
    problem = Problem.of([[0.0], [0.5], [0.0], [0.5]], Limits.of(100.0, A, dof=1))
    asked = Conditions(windows={2: (0.0, 1.0)}, waits={1: 0.3}, segment_times={0: (0.9, np.inf)})
    assert f"none arrives before {0.9 + 0.3 + 0.5:.6g} s" in too_early(problem, asked)


def test_zones_and_a_moving_start_bring_the_arrival_forward() -> None:
    asked = Conditions(windows={1: (0.0, 0.3)}, tolerance={1: np.array([0.32])})
    assert too_early(ONE, asked) == ""  # sqrt(2 0.18 / 4) = 0.3 s
    moving = Conditions(windows={1: (0.0, 0.3)}, start_velocity=np.array([2.0]))
    assert too_early(ONE, moving) == ""


@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.long) for k in range(1, 6))])
def test_windows_about_a_motion_are_never_called_impossible(seed: int) -> None:
    rng = np.random.default_rng(seed)
    limits = Limits.of(2.0, 5.0, 20.0, position=(-3.0, 1.0), dof=2)
    problem = Problem.of(rng.uniform(-3.0, 1.0, (4, 2)), limits)
    zones = {k: rng.uniform(0.0, 0.2, 2) for k in (1, 3)}
    asked = Conditions(
        tolerance=zones, waits={2: 0.2}, segment_limits={1: Limits.of(1.0, 3.0, 9.0, dof=2)}
    )
    found = free_form(problem, conditions=asked)
    assert found.trajectory is not None
    passed = found.trajectory.passage_times
    windows = {k: (0.0, float(passed[k])) for k in (1, 2, 3)}
    assert too_early(problem, replace(asked, windows=windows)) == ""


def test_plan_and_the_ladder_say_it() -> None:
    asked = Conditions(windows={1: (0.0, 0.3)})
    with pytest.raises(NoFeasibleMotion, match=r"waypoint 2: .*none arrives before 0\.5 s"):
        plan(ONE, conditions=asked)
    found = ladder(replace(ONE, conditions=asked), rungs=["free_form"])
    assert "none arrives before 0.5 s" in found.rungs["free_form"].note


def test_the_command_says_it_with_the_exit_code_of_bad_input(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["plan", "sr4c", "--window", "2=0:0.5"]) == 2
    said = capsys.readouterr().err
    assert "waypoint 3: its latest time (conditions.windows[2]) is 0.5 s" in said
    assert "proved: none arrives before" in said


def test_without_a_latest_time_the_words_stay() -> None:
    assert too_early(load("sr4c")) == ""
    with pytest.raises(NoFeasibleMotion, match=r"^as before$"), module.explained(ONE):
        raise NoFeasibleMotion("as before")


def test_a_part_that_forgets_a_zone_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """A planted fault: without its zone the waypoint would be reached too late."""
    monkeypatch.setattr(module, "Conditions", lambda **given: Conditions(**{**given, "tolerance": {}}))
    asked = Conditions(windows={1: (0.0, 0.3)}, tolerance={1: np.array([0.32])})
    assert too_early(ONE, asked) != ""
