"""The check of limits on the tool: against dense sampling, closed forms and planted faults."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tool_problems import LIMITS, hinge, planar, slider, two_links, ur5

from formulations import Conditions, InputError, Problem, Trajectory, check, free_form
from formulations.kinematics.link_chain import LinkChain
from formulations.motion.judgement import judge
from formulations.motion.tool_speed import tool_speed


def random_motion(dof: int, seed: int) -> Trajectory:
    """Random quintic pieces, of which no more is asked than their tool's speed."""
    rng = np.random.default_rng(seed)
    pieces = int(rng.integers(1, 5))
    durations = rng.uniform(0.2, 1.5, pieces)
    scales = 1.0 / np.array([1.0, 1.0, 2.0, 6.0, 24.0, 120.0])
    return Trajectory(durations, rng.normal(size=(pieces, dof, 6)) * scales)


def sampled_speed(chain: LinkChain, motion: Trajectory, count: int = 20001) -> float:
    """The largest speed at samples within pieces, by Jacobians of differences."""
    best = 0.0
    for k, duration in enumerate(motion.durations):
        t = np.linspace(0.0, duration, count)
        rows = motion.coefficients[k]
        powers = t[:, None] ** np.arange(6)
        q = powers @ rows.T
        v = powers[:, :5] @ (rows[:, 1:] * np.arange(1, 6)).T
        step = 1e-6
        speed = (chain.forward(q + step * v) - chain.forward(q - step * v))[:, :3, 3] / (2 * step)
        best = max(best, float(np.linalg.norm(speed, axis=1).max()))
    return best


@given(st.integers(0, 10_000), st.sampled_from(["planar", "slider", "ur5"]))
@settings(max_examples=12, deadline=None)
def test_the_bound_is_above_all_samples_and_near_them(seed: int, kind: str) -> None:
    chain = {"planar": planar([0.5, 0.4]), "slider": slider(-0.7)}.get(kind) or ur5(Conditions()).tool
    assert chain is not None
    motion = random_motion(chain.dof, seed)
    segments = np.zeros(len(motion.durations), dtype=np.intp)
    found = tool_speed(chain, motion, segments, np.array([0.5])).speed[0]
    dense = sampled_speed(chain, motion)
    assert dense * (1.0 - 1e-8) <= found <= dense * (1.0 + 1e-4)


def test_a_peak_between_samples_is_found() -> None:
    # velocity of one joint: 1 but for a hump of 1e-3 s, which samples of 100 Hz do not meet
    h = 5e-4
    pieces = np.array([0.5032, h, h, 0.4958])
    rows = np.zeros((4, 1, 4))
    x = 0.0
    for k, (velocity, slope) in enumerate(((1.0, 0.0), (1.0, 0.2 / h), (1.2, -0.2 / h), (1.0, 0.0))):
        rows[k, 0, :3] = x, velocity, slope / 2.0
        x += velocity * pieces[k] + slope / 2.0 * pieces[k] ** 2
    motion = Trajectory(pieces, rows, np.array([0.0, pieces.sum()]))
    limits = {"velocity": 10.0, "acceleration": 1e4}
    asked = Conditions(tool_speed=0.55, start_velocity=np.ones(1), end_velocity=np.ones(1))
    problem = Problem([[0.0], [x]], limits, tool=planar([0.5]), conditions=asked)
    at = np.arange(0.0, motion.seconds, 0.01)
    assert np.abs(0.5 * motion.at(at, 1)).max() < 0.55  # samples see nothing
    verdict = check(problem, motion)
    assert not verdict.feasible
    worst = verdict.peaks[0]
    assert worst.quantity == "tool speed"
    assert worst.value == pytest.approx(0.6, rel=1e-8)
    assert worst.time == pytest.approx(0.5032 + h, abs=1e-6)
    assert "tool speed in segment 1" in str(worst)
    assert verdict.stretch == pytest.approx(0.6 / 0.55, rel=1e-8)
    assert check(replace(problem, conditions=replace(asked, tool_speed=0.6001)), motion).feasible
    found = judge(problem, motion)
    assert [peak.quantity for peak in found.violations] == ["tool speed"]


def test_a_ball_that_is_missed_is_a_fault() -> None:
    whole = Conditions(tolerance={1: np.array([0.1])})
    motion = free_form(hinge(0.5, whole)).trajectory
    assert motion is not None
    passed = motion.at(motion.passage_times[1])[0]
    away = float(2.0 * 0.5 * np.sin(abs(passed - 1.0) / 2.0))  # chord of the tool's circle
    assert away > 0.01
    for radius, kept in ((1.001 * away, True), (0.999 * away, False)):
        asked = replace(whole, tool_zones={1: radius})
        verdict = check(hinge(0.5, asked), motion)
        assert verdict.feasible is kept, verdict.faults
        assert kept or "tool" in verdict.faults[0]


def test_segments_have_speeds_of_their_own() -> None:
    asked = Conditions(tool_speed=1.0, segment_tool_speed={1: 0.2})
    motion = free_form(two_links(Conditions())).trajectory
    assert motion is not None
    worst = next(p for p in check(two_links(asked), motion).peaks if p.quantity == "tool speed")
    assert (worst.segment, worst.limit) == (1, 0.2)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (Conditions(tool_speed=-1.0), "conditions.tool_speed: -1.0 is no positive number of m/s"),
        (Conditions(tool_zones={7: 0.1}), "conditions.tool_zones: waypoint 7 is not there: 0 to 2"),
        (Conditions(segment_tool_speed={0: float("nan")}), "segment 0: nan is no positive"),
    ],
)
def test_misuse_is_one_line(asked: Conditions, said: str) -> None:
    with pytest.raises(InputError, match=said):
        hinge(0.5, asked)


def test_a_problem_without_a_tool_has_no_speed_of_it() -> None:
    with pytest.raises(InputError, match="give the problem a robot or an arm"):
        Problem([[0.0], [1.0]], LIMITS, conditions=Conditions(tool_speed=1.0))
    with pytest.raises(InputError, match="a chain of 2 joints for waypoints of 1"):
        Problem([[0.0], [1.0]], LIMITS, tool=planar([1.0, 1.0]))


def test_one_joint_alone_keeps_boxes_and_drops_the_tool() -> None:
    alone = two_links(Conditions(tool_speed=1.0, tool_zones={1: 0.05})).joint(0)
    assert alone.tool is None
    assert alone.conditions.asked == ("tolerance",)
    assert alone.conditions.tolerance[1].tolist() == [0.1]
