"""The family optimum against oracles that share no code with it, and against the laws of scaling.

Stretching any shape to feasibility turns the problem into: minimise sum(T) stretch(T) over the
ratios of the durations. The oracles here search that; the solver never does.
"""

from __future__ import annotations

import functools
import math
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from conftest import SOLVED, Array, climbed, powers_of_ten, problems
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import differential_evolution, minimize, minimize_scalar

from formulations import (
    CASES,
    FAMILIES,
    FamilyOptimum,
    InputError,
    Limits,
    NoFeasibleMotion,
    Problem,
    UnsupportedProblem,
    check,
    each_joint_alone,
    family_optimum,
    load,
    longest_segment,
)
from formulations.optima.family.program import duration_scales

THREE = [case for case in CASES if load(case).family == "3-5-3"]
NO_SHRINKING = (Phase.explicit, Phase.generate)  # each example costs a second
KEPT = 1e-9  # rad outside the position limits that counts as inside


def inward(problem: Problem, t: Array) -> Array:
    """Whether joints that rest on a position limit leave it, and come to it, on the inner side.

    Rest leaves the jerk to decide. A dip of d rad outside lasts as long as d^(1/3): what rounding
    hides can be worth 1e-5 of the time, so no tolerance on the position itself will do.
    """
    c = FAMILIES[problem.family].coefficients(problem, t)
    starts, ends = 6.0 * c[:, 0, :, 3], c[:, -1] @ [0.0, 0.0, 0.0, 6.0, 24.0, 60.0]
    kept = np.ones(len(t), dtype=bool)
    for side, sign in ((0, 1.0), (1, -1.0)):
        bounds = problem.position_bounds[:, side]
        kept &= (sign * starts >= 0.0)[:, problem.waypoints[0] == bounds].all(axis=1)
        kept &= (sign * ends <= 0.0)[:, problem.waypoints[-1] == bounds].all(axis=1)
    return kept


def scaled_seconds(problem: Problem, t: Array) -> Array:
    """Total time of durations (n, n_segments), stretched to feasibility; infinite if out of the game.

    Out are those that leave the position limits, and segments shorter than 1e-7 of the whole.
    """
    family = FAMILIES[problem.family]
    total = t.sum(axis=1)
    kept = (family.position_excess(problem, t) <= KEPT) & inward(problem, t)
    kept &= t.min(axis=1) >= 1e-7 * total
    return np.where(kept, total * family.stretch(problem, t), np.inf)


def searched(problem: Problem, seed: int = 0, reach: float = 5.0) -> tuple[float, Array]:
    """Differential evolution over log ratios, polished by Nelder-Mead: the oracle."""
    n = problem.n_segments

    def seconds(y: Array) -> Any:
        rows = np.exp(np.atleast_2d(y.T))
        values = scaled_seconds(problem, np.column_stack([np.ones(len(rows)), rows]))
        values = np.where(np.isfinite(values), values, 1e6 + np.abs(y.T).max())
        return values if y.ndim > 1 else float(values[0])

    found = differential_evolution(
        seconds,
        [(-reach, reach)] * (n - 1),
        vectorized=True,
        updating="deferred",
        popsize=20,
        maxiter=180,
        tol=0.0,
        atol=0.0,
        polish=False,
        rng=seed,
    )
    y, best = found.x, float(found.fun)
    for _ in range(4):
        options = {"xatol": 1e-13, "fatol": 1e-14, "maxiter": 2000}
        polished = minimize(seconds, y, method="Nelder-Mead", options=options)
        if polished.fun < best:
            y, best = polished.x, float(polished.fun)
    return best, np.concatenate([[1.0], np.exp(y)])


quick = functools.partial(family_optimum, random_starts=1)  # for laws, where two are compared


def optimum(case: str, joint: int | None = None) -> FamilyOptimum:
    """Optimum of a shipped case or of one of its joints alone."""
    found = climbed(case).optimum if joint is None else climbed(case).alone[joint]
    assert found is not None
    return found


def judged(found: FamilyOptimum) -> None:
    """What every optimum must be."""
    verdict = check(found.problem, FAMILIES[found.family].trajectory(found.problem, found.durations))
    assert verdict.faults == ()
    assert found.verdict.feasible
    assert found.seconds == pytest.approx(verdict.seconds, rel=1e-12)
    assert (found.durations > 0.0).all()
    assert 1 <= found.agreeing_starts <= len(found.starts)
    assert min(start.seconds for start in found.starts) == pytest.approx(found.seconds, rel=1e-12)
    if found.durations.min() > 1e-7 * found.seconds:
        assert "ok" in {start.status for start in found.starts}


# --- closed forms ---------------------------------------------------------------------------------


def test_there_and_back_in_two_quartics_takes_four_root_three() -> None:
    """x = 4 s^3 - 3 s^4 and its mirror: |a| peaks at 12 / T^2, so A = 1 asks for T = sqrt(12)."""
    problem = Problem.of([[0.0], [1.0], [0.0]], Limits.of(1.0, 1.0, dof=1))
    found = family_optimum(problem)
    judged(found)
    assert found.seconds == pytest.approx(4.0 * math.sqrt(3.0), rel=1e-9)
    np.testing.assert_allclose(found.durations, math.sqrt(12.0), rtol=1e-4)


def test_there_and_back_with_velocity_alone_takes_32_ninths() -> None:
    """|v| of 4 s^3 - 3 s^4 peaks at 16/9 / T, at s = 2/3."""
    problem = Problem.of([[0.0, 5.0], [1.0, 5.0], [0.0, 5.0]], Limits.of(1.0, dof=2))
    found = family_optimum(problem)
    judged(found)
    assert found.seconds == pytest.approx(32.0 / 9.0, rel=1e-9)


@given(problem=problems(segments=2, reach=(-3.0, 2.0)))
@settings(max_examples=8, phases=NO_SHRINKING)
def test_two_segments_agree_with_a_search_along_the_one_ratio(problem: Problem) -> None:
    assume(problem.moving_joints)
    found = family_optimum(problem)
    judged(found)
    y = np.linspace(-14.0, 14.0, 20_001)
    seconds = scaled_seconds(problem, np.exp(np.stack([y / 2.0, -y / 2.0], axis=1)))
    best = int(seconds.argmin())
    assume(0 < best < len(y) - 1)

    def along(z: float) -> float:
        return float(scaled_seconds(problem, np.exp([[z / 2.0, -z / 2.0]]))[0])

    exact = minimize_scalar(
        along, bounds=(y[best - 1], y[best + 1]), method="bounded", options={"xatol": 1e-12}
    )
    oracle = min(float(exact.fun), float(seconds[best]))
    assert found.seconds <= oracle * (1.0 + 1e-9)
    assert found.seconds >= oracle * (1.0 - 1e-6)


# --- against differential evolution ---------------------------------------------------------------


def agrees(problem: Problem, found: FamilyOptimum) -> None:
    judged(found)
    oracle, _ = searched(problem)
    assert found.seconds <= oracle * (1.0 + 1e-9)
    assert found.seconds >= oracle * (1.0 - 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("case", THREE)
def test_shipped_cases_agree_with_differential_evolution(case: str) -> None:
    agrees(load(case), optimum(case))


@pytest.mark.slow
@pytest.mark.parametrize("family", ["quintic", "b-spline-3", "b-spline-5"])
def test_other_families_agree_with_differential_evolution(
    family: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Joint 5 starts on its limit and the B-splines lean on it: no slack at all for the oracle."""
    monkeypatch.setattr(sys.modules[__name__], "KEPT", 1e-13)
    problem = replace(load("sr4c"), family=family)
    assert (problem.waypoints[0] == problem.position_bounds[:, 0])[4]
    agrees(problem, quick(problem))


@pytest.mark.slow
@pytest.mark.parametrize("case", THREE)
def test_every_joint_alone_agrees_with_differential_evolution(case: str) -> None:
    problem, known = load(case), load("ur5")
    for joint in problem.moving_joints:
        if case == "ur5-corrected" and (problem.waypoints == known.waypoints)[:, joint].all():
            continue  # the same joint as in ur5
        agrees(problem.joint(joint), optimum(case, joint))


@pytest.mark.slow
@given(problem=problems(reach=(-3.0, 1.0)))
@settings(max_examples=8, phases=NO_SHRINKING)
def test_made_up_problems_agree_with_differential_evolution(problem: Problem) -> None:
    assume(problem.moving_joints)
    found = family_optimum(problem)
    judged(found)
    oracle, _ = searched(problem, reach=9.0)
    assert found.seconds <= oracle * (1.0 + 1e-9)


@pytest.mark.slow
@given(
    middle=st.floats(-0.4, 0.4),
    last=st.floats(-1.5, 1.5),
    limited=st.sampled_from(["v", "va", "vaj"]),
)
@settings(max_examples=6, phases=NO_SHRINKING)
def test_problems_with_two_basins_end_in_the_better_one(
    middle: float, last: float, limited: str
) -> None:
    """One joint and a small middle displacement: where local solvers are misled."""
    limits = {"velocity": 1.0, "acceleration": 1.5, "jerk": 4.0}
    kept = {name: limits[name] for name in limits if name[0] in limited}
    problem = Problem.of(
        [[0.0], [1.0], [1.0 + middle], [1.0 + middle + last]], Limits.of(**kept, dof=1)
    )
    found = family_optimum(problem)
    judged(found)
    assert found.seconds <= searched(problem)[0] * (1.0 + 1e-9)


@pytest.mark.parametrize(
    ("points", "limits"),
    [
        ([[0.0], [1.0], [1.2], [1.21]], {"velocity": 1.4, "acceleration": 0.2}),
        ([[0.0], [1.0], [1.2], [1.2001]], {"velocity": 1.4, "acceleration": 0.2}),
        (
            np.cumsum(
                [[0, 0], [-6.6034e-7, -3.5427e-7], [-0.14149, -0.11083], [-0.41967, -0.31097]], axis=0
            ),
            {
                "velocity": [1.129, 0.70614],
                "acceleration": [7.3339, 0.50884],
                "jerk": [1.9512, 0.27405],
            },
        ),
    ],
    ids=["a short last step", "a shorter one", "a tiny first step"],
)
def test_a_narrow_better_basin_is_found(points: Any, limits: dict[str, Any]) -> None:
    problem = Problem.of(points, Limits.of(**limits, dof=len(points[0])))
    found = family_optimum(problem)
    judged(found)
    oracle, _ = searched(problem, reach=9.0)
    assert found.seconds <= oracle * (1.0 + 1e-9)


def test_a_start_that_is_called_ok_ends_where_no_neighbour_is_faster() -> None:
    problem = Problem.of([[0.0], [1.0], [1.2], [1.21]], Limits.of(1.4, 0.2, dof=1))
    rng = np.random.default_rng(5)
    steps = np.exp(rng.normal(size=(20_000, 3)) * 10.0 ** rng.uniform(-6.0, -2.0, (20_000, 1)))
    for start in family_optimum(problem).starts:
        if start.status == "ok":
            near = float(scaled_seconds(problem, start.durations * steps).min())
            assert start.seconds <= near * (1.0 + 1e-7), start


@given(problem=problems(reach=(-3.0, 1.0), position=True), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=8, phases=NO_SHRINKING)
def test_no_random_candidate_is_faster_than_the_optimum(problem: Problem, seed: int) -> None:
    assume(problem.moving_joints)
    rng = np.random.default_rng(seed)
    t = np.exp(rng.uniform(-7.0, 7.0, (20_000, 3)))
    t[:5000] = np.exp(rng.uniform(-1.0, 1.0, (5000, 3))) * duration_scales(problem)
    try:
        found = family_optimum(problem)
    except NoFeasibleMotion:
        assert not np.isfinite(scaled_seconds(problem, t)).any()
        return
    judged(found)
    t[5000:10_000] = found.durations * np.exp(rng.normal(size=(5000, 3)) * 1e-2)
    assert found.seconds <= scaled_seconds(problem, t).min() * (1.0 + 1e-9)


@given(problem=problems(segments=st.integers(2, 6), family="4-3-4", reach=(-2.0, 1.0)))
@settings(max_examples=4, phases=NO_SHRINKING)
def test_no_random_candidate_is_faster_in_longer_splines(problem: Problem) -> None:
    assume(problem.moving_joints)
    found = family_optimum(problem)
    judged(found)
    rng = np.random.default_rng(3)
    n = problem.n_segments
    t = np.exp(rng.uniform(-3.0, 3.0, (20_000, n)))
    t[10_000:] = found.durations * np.exp(
        rng.normal(size=(10_000, n)) * 10.0 ** rng.uniform(-5.0, 0.0, (10_000, 1))
    )
    assert found.seconds <= scaled_seconds(problem, t).min() * (1.0 + 1e-9)


@pytest.mark.parametrize("case", SOLVED)
def test_no_neighbour_of_a_shipped_optimum_is_faster(case: str) -> None:
    found = optimum(case)
    judged(found)
    rng = np.random.default_rng(11)
    steps = rng.normal(size=(20_000, len(found.durations)))
    steps *= 10.0 ** rng.uniform(-7.0, -0.5, (20_000, 1))
    seconds = scaled_seconds(found.problem, found.durations * np.exp(steps))
    assert found.seconds <= seconds.min() * (1.0 + 1e-9)
    # the stretched optimum is stretched to the limit
    assert FAMILIES[found.family].stretch(found.problem, found.durations[None])[0] == pytest.approx(
        1.0, rel=1e-12
    )


@pytest.mark.parametrize("case", THREE)
def test_the_cubes_of_an_optimum_keep_their_closed_form_bounds(case: str) -> None:
    """The first and last cube alone ask for T >= 3 |d| / V, sqrt(6 |d| / A), cbrt(6 |d| / J)."""
    found = optimum(case)
    limits, d = found.problem.limits, np.abs(found.problem.displacements)
    for k in (0, 2):
        least = max(
            (3.0 * d[k] / limits.velocity).max(),
            np.sqrt(6.0 * d[k] / limits.acceleration).max(),
            np.cbrt(6.0 * d[k] / limits.jerk).max(),
        )
        assert found.durations[k] >= least * (1.0 - 1e-9)


# --- laws -----------------------------------------------------------------------------------------

MOVING = problems(reach=(-2.0, 1.0)).filter(lambda problem: bool(problem.moving_joints))


def scaled(problem: Problem, *, waypoints: float = 1.0, time: float = 1.0) -> Problem:
    """The same task in another unit of angle and another unit of time."""
    limits = problem.limits
    orders = (limits.velocity, limits.acceleration, limits.jerk)
    factors = [waypoints / time**order for order in (1, 2, 3)]
    return Problem.of(
        problem.waypoints * waypoints,
        Limits.of(*(x * f for x, f in zip(orders, factors, strict=True)), dof=problem.dof),
        family=problem.family,
    )


@given(problem=MOVING, factor=powers_of_ten(-2.0, 2.0))
@settings(max_examples=4, phases=NO_SHRINKING)
def test_a_change_of_units_changes_nothing_but_units(problem: Problem, factor: float) -> None:
    seconds = quick(problem).seconds
    assert quick(scaled(problem, waypoints=factor)).seconds == pytest.approx(seconds, rel=1e-8)
    assert quick(scaled(problem, time=factor)).seconds == pytest.approx(seconds * factor, rel=1e-8)


@given(problem=problems(reach=(-2.0, 1.0), limited=("v",)), factor=powers_of_ten(-1.0, 1.0))
@settings(max_examples=4, phases=NO_SHRINKING)
def test_with_velocity_alone_time_is_divided_by_the_factor_on_the_limits(
    problem: Problem, factor: float
) -> None:
    assume(problem.moving_joints)
    faster = Problem.of(problem.waypoints, Limits.of(problem.limits.velocity * factor, dof=problem.dof))
    assert quick(faster).seconds == pytest.approx(quick(problem).seconds / factor, rel=1e-8)


@pytest.mark.slow
@given(problem=MOVING, shift=st.floats(-2.0, 2.0))
@settings(max_examples=3, phases=NO_SHRINKING)
def test_neither_an_offset_nor_a_sign_nor_the_direction_of_time_matters(
    problem: Problem, shift: float
) -> None:
    seconds = quick(problem).seconds
    for points in (problem.waypoints + shift, -problem.waypoints, problem.waypoints[::-1]):
        other = Problem.of(points, problem.limits, family=problem.family)
        assert quick(other).seconds == pytest.approx(seconds, rel=1e-8)


@given(problem=MOVING)
@settings(max_examples=4, phases=NO_SHRINKING)
def test_a_further_limit_or_joint_never_makes_it_faster(problem: Problem) -> None:
    whole = quick(problem).seconds
    for alone in each_joint_alone(problem, random_starts=1):
        assert alone is None or alone.seconds <= whole * (1.0 + 1e-9)
    freer = Problem.of(problem.waypoints, Limits.of(problem.limits.velocity, dof=problem.dof))
    assert quick(freer).seconds <= whole * (1.0 + 1e-9)


@pytest.mark.parametrize("case", ["sr4c", "bagging"])
def test_the_same_seed_gives_the_same_answer_to_the_bit(case: str) -> None:
    first, again = (family_optimum(load(case), random_starts=1, seed=5) for _ in range(2))
    np.testing.assert_array_equal(first.durations, again.durations)
    assert [s.seconds for s in first.starts] == [s.seconds for s in again.starts]
    assert optimum(case).seconds == pytest.approx(first.seconds, rel=1e-9)


def test_progress_rises_to_one() -> None:
    seen: list[float] = []
    family_optimum(load("cobot"), random_starts=2, progress=seen.append)
    assert len(seen) >= 4
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_another_family_can_be_asked_for() -> None:
    problem = load("sr4c")
    other = family_optimum(problem, family="4-3-4")
    assert other.family == "4-3-4"
    judged(other)
    assert optimum("sr4c").family == "3-5-3"
    with pytest.raises(UnsupportedProblem, match="3 segments"):
        family_optimum(load("bagging"), family="3-5-3")


# --- still joints, equal waypoints ----------------------------------------------------------------


@pytest.mark.parametrize("family", list(FAMILIES))
def test_nothing_moves_and_that_is_an_answer(family: str) -> None:
    problem = Problem.of(np.full((4, 2), 0.7), Limits.of(1.0, 1.0, 1.0, dof=2), family=family)
    found = family_optimum(problem)
    assert found.verdict.feasible
    assert 0.0 < found.seconds < 1e-6
    assert each_joint_alone(problem) == (None, None)


@pytest.mark.parametrize("row", range(3))
@pytest.mark.parametrize("family", list(FAMILIES))
def test_equal_consecutive_waypoints_are_solved(family: str, row: int) -> None:
    points = np.array([[0.0, 1.0], [1.0, 0.5], [1.5, 2.0], [0.2, 1.7]])
    points[row + 1] = points[row]
    problem = Problem.of(points, Limits.of(1.0, 2.0, 5.0, dof=2), family=family)
    found = family_optimum(problem)
    judged(found)
    oracle, _ = searched(problem)
    assert found.seconds <= oracle * (1.0 + 1e-9)


@pytest.mark.parametrize(
    "points", [[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 1.0, 1.0]], ids=["before the move", "after it"]
)
def test_segments_without_displacement_cost_nothing(points: list[float]) -> None:
    """One cube of 1 rad at V = 1 takes 3 s; the still segments beside it may vanish."""
    problem = Problem.of(np.array(points)[:, None], Limits.of(1.0, dof=1))
    found = family_optimum(problem)
    judged(found)
    assert found.seconds == pytest.approx(3.0, rel=1e-9)


def test_a_start_converges_where_the_last_segment_vanishes() -> None:
    points = [[0.0], [1.0], [1.0078125], [1.0078125]]
    found = family_optimum(Problem.of(points, Limits.of(1.0, dof=1)))
    judged(found)
    assert found.seconds == pytest.approx(3.0133616762408, rel=1e-9)  # as T3 tends to 0
    assert "ok" in {start.status for start in found.starts}


@pytest.mark.parametrize("size", [1e-6, 1e3])
def test_tiny_and_huge_displacements_are_solved(size: float) -> None:
    points = size * np.array([[0.0, 0.0], [1.0, -2.0], [2.0, 1.0], [5.0, 3.0]])
    found = family_optimum(Problem.of(points, Limits.of(1.0, 2.0, 5.0, dof=2)))
    judged(found)
    assert found.seconds <= searched(found.problem)[0] * (1.0 + 1e-9)


# --- the papers' rule -----------------------------------------------------------------------------


@pytest.mark.parametrize("case", SOLVED)
def test_the_longest_segment_rule_never_beats_the_optimum(case: str) -> None:
    problem = load(case)
    alone = [optimum(case, joint).durations for joint in problem.moving_joints]
    rule = longest_segment(problem, alone)
    np.testing.assert_array_equal(rule.claimed, np.max(alone, axis=0))
    stretch = FAMILIES[problem.family].stretch(problem, rule.claimed[None])[0]
    assert rule.stretch == stretch
    np.testing.assert_allclose(rule.durations, rule.claimed * max(stretch, 1.0), rtol=1e-14)
    assert rule.durations.sum() >= optimum(case).seconds * (1.0 - 1e-9)
    if rule.position_excess <= KEPT:
        verdict = check(problem, FAMILIES[problem.family].trajectory(problem, rule.durations))
        assert verdict.feasible, verdict.faults


def test_the_rule_breaks_the_limits_of_sr4c() -> None:
    problem = load("sr4c")
    alone = [optimum("sr4c", joint).durations for joint in problem.moving_joints]
    rule = longest_segment(problem, alone)
    assert rule.stretch > 1.1
    claimed = FAMILIES["3-5-3"].trajectory(problem, rule.claimed)
    assert not check(problem, claimed).feasible


@given(problem=MOVING)
@settings(max_examples=4, phases=NO_SHRINKING)
def test_the_rule_never_beats_the_optimum_of_made_up_problems(problem: Problem) -> None:
    alone = [
        found.durations for found in each_joint_alone(problem, random_starts=1) if found is not None
    ]
    rule = longest_segment(problem, alone)
    assert rule.durations.sum() >= quick(problem).seconds * (1.0 - 1e-9)
    assert rule.position_excess == 0.0


def test_the_rule_needs_a_joint_that_moves() -> None:
    with pytest.raises(InputError, match="no joint moves"):
        longest_segment(load("sr4c"), [])


# --- position limits ------------------------------------------------------------------------------

OVERSHOOT = np.array([[0.0], [1.0], [1.1], [0.1]])


def bounded(top: float) -> Problem:
    limits = Limits.of(1.0, 2.0, position=[[-0.5, top]], dof=1)
    return Problem.of(OVERSHOOT, limits)


def test_position_limits_that_bind_cut_the_overshoot_and_cost_time() -> None:
    free = quick(bounded(9.0))
    swing = float(free.trajectory.extremes(0).high.max())
    assert swing > 1.3
    oracle, _ = searched(bounded(9.0))
    assert free.seconds == pytest.approx(oracle, rel=1e-6)
    last = free.seconds
    for top in (swing - 0.02, 1.3, 1.2):
        problem = bounded(top)
        found = quick(problem)
        judged(found)
        assert found.trajectory.extremes(0).high.max() == pytest.approx(top, abs=1e-6)  # it binds
        oracle, _ = searched(problem, reach=9.0)
        assert found.seconds <= oracle * (1.0 + 1e-8)
        assert found.seconds >= oracle * (1.0 - 1e-6)
        assert found.seconds > last
        last = found.seconds


def test_the_rule_says_how_far_it_leaves_the_position_limits() -> None:
    rule = longest_segment(bounded(1.2), [np.array([1.0, 2.0, 0.5]), np.array([0.5, 1.0, 1.5])])
    assert rule.claimed.tolist() == [1.0, 2.0, 1.5]
    top = FAMILIES["3-5-3"].trajectory(bounded(1.2), rule.claimed).extremes(0).high.max()
    assert top > 1.5
    assert rule.position_excess == pytest.approx(top - 1.2, rel=1e-9)
    assert longest_segment(bounded(9.0), [rule.claimed]).position_excess == 0.0


def test_no_feasible_shape_is_said_to_be_none() -> None:
    """The cube reaches the limit with velocity 3 / T1 > 0: whatever follows, it must overshoot."""
    limits = Limits.of(1.0, 1.0, position=[[0.0, 1.0]], dof=1)
    problem = Problem.of([[0.0], [1.0], [0.0], [1.0]], limits)
    t = np.exp(np.random.default_rng(0).uniform(-3.0, 3.0, (20_000, 3)))
    assert (FAMILIES["3-5-3"].position_excess(problem, t) > 0.0).all()
    with pytest.raises(NoFeasibleMotion) as caught:
        family_optimum(problem, random_starts=0)
    assert len(str(caught.value).splitlines()) == 1
