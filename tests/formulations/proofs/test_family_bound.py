"""The certified bound of a family is true and tight, and misuse of it is one clear line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from family_problems import (
    CASES_353,
    anyhow,
    as_quintic,
    holds,
    random_problem,
    stretched,
    z1_bound,
)

from formulations import (
    FAMILIES,
    FamilyBound,
    FamilyOptimum,
    InputError,
    Limits,
    Problem,
    UnsupportedProblem,
    family_bound,
    family_optimum,
    load,
)
from formulations.proofs.displacement import exceeded_time
from formulations.proofs.family import PROVERS
from formulations.proofs.four_three_four import bound as four_three_four
from formulations.proofs.quintic import bound as quintic
from formulations.proofs.status import BoundStatus
from formulations.proofs.three_five_three import bound as three_five_three


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES_353)
def test_every_shipped_3_5_3_case_is_proved_together_and_joint_by_joint(case: str) -> None:
    problem = load(case)
    for each in [problem, *(problem.joint(j) for j in problem.moving_joints)]:
        holds(family_bound(each), 1e-7)


@pytest.mark.long
def test_bagging_is_proved() -> None:
    holds(family_bound(load("bagging"), gap=1e-6, time_limit=20.0), 1e-6)


@pytest.mark.slow
def test_random_3_5_3_problems_are_all_proved() -> None:
    rng = np.random.default_rng(2024)
    found_by_the_proof = 0
    for i in range(60):
        problem = random_problem(rng, 3, int(rng.integers(1, 8)), ("V", "VA", "VAJ")[i % 3])
        # half begin at a feasible motion that is no optimum: proof and NLP must find it together
        poor = FamilyOptimum(problem, "3-5-3", np.ones(3), ())
        start = family_optimum(problem, starts=3) if i % 2 else poor
        bound = family_bound(problem, gap=1e-5, optimum=start)
        holds(bound, 1e-5)
        found_by_the_proof += not i % 2 and bound.upper < stretched(start) * (1.0 - 1e-3)
    assert found_by_the_proof > 20


@pytest.mark.slow
@pytest.mark.parametrize(
    ("n", "kind"), [(5, "V"), (5, "VA"), (5, "VAJ"), (6, "V"), (6, "VA"), (6, "VAJ")]
)
def test_random_4_3_4_problems_are_proved(n: int, kind: str) -> None:
    problem = random_problem(np.random.default_rng([n, 2]), n, 4, kind, least=-1.0)
    optimum = family_optimum(problem, starts=5)
    holds(family_bound(problem, gap=1e-4, optimum=optimum), 1e-4)


@pytest.mark.slow
def test_the_proof_finds_the_basin_a_local_solver_misses() -> None:
    rng = np.random.default_rng(2024)
    problem = random_problem(rng, 3, 2, "VA")
    optimum = family_optimum(problem)
    # a feasible motion far from the optimum stands for a solver that ended in the wrong place
    worse = FamilyOptimum(problem, "3-5-3", np.array([5.0, 20.0, 9.0]), ())
    assert stretched(worse) > 1.2 * optimum.seconds
    bound = family_bound(problem, optimum=worse)
    holds(bound, 1e-7)
    assert bound.upper <= optimum.seconds * (1.0 + 1e-9)


def test_position_limits_count_with_the_slack_of_the_check() -> None:
    rng = np.random.default_rng(5)
    free = random_problem(rng, 3, 1, "VA", least=-0.5)
    w = free.waypoints
    excess = FAMILIES["3-5-3"].position_excess
    reach = np.array([[w.min() - 0.02, w.max() + 0.02]])
    limited = Problem.of(
        w, Limits.of(free.limits.velocity, free.limits.acceleration, np.inf, reach, dof=1)
    )
    loose, tight = family_bound(free), family_bound(limited)
    holds(loose, 1e-7)
    holds(tight, 1e-7)
    assert loose.durations is not None
    assert tight.durations is not None
    assert excess(limited, loose.durations[None])[0] > 0.0  # the limit binds
    assert tight.seconds > loose.upper * 1.001
    assert excess(limited, tight.durations[None])[0] <= limited.position_slack


def test_a_segment_on_which_nothing_moves_may_vanish() -> None:
    for still, n in ((0, 3), (1, 3), (2, 3), (1, 4), (0, 4)):
        problem = random_problem(np.random.default_rng(still), n, 2, "VAJ", least=-0.5, still=still)
        bound = family_bound(problem, gap=1e-5)
        assert bound.seconds <= bound.upper
        assert bound.gap <= 1e-5 or bound.status != "proved"
        assert bound.gap <= 1e-2


def test_where_nothing_moves_the_bound_is_zero() -> None:
    problem = Problem.of(np.ones((4, 2)), Limits.of(1.0, dof=2))
    bound = family_bound(problem)
    assert (bound.seconds, bound.upper, bound.gap, bound.status) == (0.0, 0.0, 0.0, "proved")


@pytest.fixture(scope="module")
def z1_as_quintic() -> FamilyBound:
    return z1_bound()


@pytest.mark.slow
def test_z1_as_a_quintic_is_proved(z1_as_quintic: FamilyBound) -> None:
    holds(z1_as_quintic, 5e-10)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["V", "VA", "VAJ"])
def test_random_quintic_problems_are_proved(kind: str) -> None:
    rng = np.random.default_rng(11)
    for n, dof in ((1, 2), (2, 1), (3, 2), (6, 1)):
        problem = as_quintic(random_problem(rng, n, dof, kind, least=-1.0))
        holds(family_bound(problem, gap=1e-5, optimum=anyhow(problem)), 1e-5)


@pytest.mark.parametrize("kind", ["VA", "VAJ"])
def test_a_quintic_of_two_segments_agrees_with_a_search_of_all_shapes(kind: str) -> None:
    problem = as_quintic(random_problem(np.random.default_rng(4), 2, 2, kind, least=-1.0))
    ratio = np.exp(np.linspace(-6.0, 6.0, 40_001))
    shapes = np.stack([ratio, np.ones_like(ratio)], axis=1)
    totals = shapes.sum(axis=1) * FAMILIES["quintic"].stretch(problem, shapes)
    bound = family_bound(problem, gap=1e-9, optimum=anyhow(problem))
    assert totals.min() * (1.0 - 3e-4) < bound.seconds <= totals.min()  # steps of 3e-4


def test_a_joint_without_any_limit_is_not_applicable() -> None:
    unlimited = replace(Limits.of(1.0, dof=1), velocity=np.array([np.inf]))  # ``of`` refuses it
    problem = Problem.of([[0.0], [1.0], [2.0], [3.0]], unlimited)
    bound = family_bound(problem)
    assert bound.status is BoundStatus.NOT_APPLICABLE
    assert "without a limit" in bound.reason


def test_misuse_is_one_clear_line() -> None:
    problem = load("sr4c")
    for gap in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(InputError, match="gap"):
            family_bound(problem, gap=gap)
    with pytest.raises(InputError, match="time_limit"):
        family_bound(problem, time_limit=-1.0)
    with pytest.raises(UnsupportedProblem):
        family_bound(load("bagging"), family="3-5-3")


@pytest.mark.slow
def test_a_time_limit_leaves_a_smaller_but_valid_bound() -> None:
    problem = load("bagging").joint(5)  # minutes of boxes at the finest gaps
    optimum = family_optimum(problem, starts=5)
    bound = family_bound(problem, gap=1e-9, time_limit=0.05, optimum=optimum)
    assert bound.status == "time limit"
    assert exceeded_time(problem) <= bound.seconds < bound.upper
    assert bound.gap > 1e-9
    assert bound.runtime < 20.0  # compiling, perhaps, but not the proof
    longer = family_bound(problem, gap=1e-9, time_limit=1.0, optimum=optimum)
    assert longer.seconds >= bound.seconds


def test_the_provers_are_those_of_their_families() -> None:
    assert list(PROVERS) == list(FAMILIES)
    begins = {"3-5-3": three_five_three, "4-3-4": four_three_four, "quintic": quintic}
    assert all(PROVERS[family] == module.begin for family, module in begins.items())
