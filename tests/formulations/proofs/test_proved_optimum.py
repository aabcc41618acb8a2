"""One start and a short proof, against many starts: the oracle."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import SOLVED, climbed
from family_problems import as_quintic, closed, random_problem

from formulations import (
    FamilyOptimum,
    InputError,
    Limits,
    NoFeasibleMotion,
    Problem,
    check,
    each_joint_alone,
    family_bound,
    family_optimum,
    load,
    proved_optimum,
)
from formulations.optima.family import optimum as optimum_module
from formulations.proofs import family as family_module
from formulations.proofs.family import PROVERS, FamilyBound, affordable_gap

GAP = 1e-7


def as_good_as_many_starts(found: FamilyOptimum, bound: FamilyBound | None) -> None:
    """The motion keeps its limits, is no slower than the best of many starts, and is proved to be.

    The check lets a motion leave the position limits by a slack, and every start ends at another place
    within it: with such limits two starts agree to the gap of the proof, not to rounding.
    """
    problem = found.problem
    many = family_optimum(problem)
    agree = GAP if problem.limits.has_position else 1e-9
    assert found.seconds <= many.seconds * (1.0 + agree)
    verdict = check(problem, found.trajectory)
    assert verdict.feasible
    assert verdict.seconds == pytest.approx(found.seconds, rel=1e-14)
    if bound is not None:
        assert bound.status == "proved"
        gap = max(GAP, affordable_gap(problem.family)[0])  # what a ladder asks for
        assert bound.seconds <= found.seconds <= bound.seconds * (1.0 + gap)
        assert bound.seconds <= many.seconds  # no verified motion lies below what is proved


@pytest.mark.parametrize("case", SOLVED)
def test_the_papers_cases_have_the_optimum_of_many_starts(case: str) -> None:
    found = climbed(case)
    assert found.optimum is not None
    proved = found.bound if found.optimum.settled and found.bound and found.bound.boxes else None
    as_good_as_many_starts(found.optimum, proved)
    for alone in found.alone:
        if alone is not None:
            as_good_as_many_starts(alone, None)


@pytest.mark.long
@pytest.mark.parametrize("limited", ["V", "VA", "VAJ"])
@pytest.mark.parametrize("position", [False, True])
@pytest.mark.parametrize("family", list(PROVERS))
def test_random_problems_have_the_optimum_of_many_starts(
    family: str, position: bool, limited: str
) -> None:
    proved = 0
    for seed in range(3):
        rng = np.random.default_rng([seed, position, len(limited)])
        segments = 3 if family == "3-5-3" else int(rng.integers(2, 5))
        problem = random_problem(rng, segments, int(rng.choice([1, 2, 3])), limited)
        if family == "quintic":
            problem = as_quintic(problem)
        if position:
            problem = closed(problem, 0.1 + 0.3 * rng.random())
        try:
            found, bound = proved_optimum(problem, gap=GAP)
        except NoFeasibleMotion:
            with pytest.raises(NoFeasibleMotion):
                family_optimum(problem)
            continue
        as_good_as_many_starts(found, bound)
        proved += bound is not None
    assert proved >= 2  # not everything is left to the many starts


def wrong_basin() -> Problem:
    """One joint, on which all fourteen starts end 50 % above the optimum."""
    rng = np.random.default_rng(34)
    dof = int(rng.choice([1, 1, 2, 3, 6]))
    return random_problem(rng, 3, dof, "VA")


def test_the_proof_finds_a_basin_that_no_start_has_found() -> None:
    problem = wrong_basin()
    many = family_optimum(problem)
    found, bound = proved_optimum(problem)
    assert found.seconds < 0.7 * many.seconds
    assert bound is not None
    as_good_as_many_starts(found, bound)
    assert found.settled
    assert len(found.starts) == 2  # where it began, and where the proof sent it


@pytest.mark.parametrize("seed", [0, 7])
def test_the_seed_of_the_start_does_not_matter(seed: int) -> None:
    seconds = proved_optimum(load("sr4c"), seed=seed)[0].seconds
    assert seconds == pytest.approx(climbed("sr4c").seconds("family"), rel=1e-9)


def test_many_starts_take_the_place_of_a_proof_that_is_not_short(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(family_module, "_SHORT_PROOF", 1)
    problem = load("sr4c")
    found, bound = proved_optimum(problem)
    assert bound is None
    assert len(found.starts) == len(family_optimum(problem).starts)
    whole = family_bound(problem)  # goes on from there, without the limit
    assert whole.status == "proved"
    assert whole.boxes > 1


def test_what_a_proof_left_unfinished_has_found_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = wrong_basin()
    _, bound = proved_optimum(problem)
    assert bound is not None
    monkeypatch.setattr(family_module, "_SHORT_PROOF", bound.boxes - 1)
    found, unfinished = proved_optimum(problem)
    assert unfinished is None
    assert found.seconds == pytest.approx(bound.upper, rel=1e-9)


def test_a_start_that_did_not_settle_is_not_trusted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FamilyOptimum, "settled", False)
    found, bound = proved_optimum(load("cobot"))
    assert bound is None
    assert len(found.starts) > 10


@pytest.mark.parametrize("starts", [1, 3])
def test_a_number_of_starts_can_be_asked_for(starts: int) -> None:
    problem = load("ur5")
    found, bound = proved_optimum(problem, starts=starts)
    assert (len(found.starts), bound) == (starts, None)
    alone = each_joint_alone(problem, starts=starts)
    assert [len(one.starts) for one in alone if one is not None] == [starts] * 6


def test_no_starts_are_refused_in_one_line() -> None:
    with pytest.raises(InputError, match="starts: 0"):
        family_optimum(load("sr4c"), starts=0)


def test_the_certificate_of_the_short_proof_is_that_of_the_whole_one() -> None:
    problem = load("cobot")
    found, bound = proved_optimum(problem, record=True)
    assert bound is not None
    assert bound.certificate is not None
    whole = family_bound(problem, optimum=found, record=True)
    assert bound.seconds == whole.seconds
    assert whole.certificate is not None
    assert bound.certificate["seconds"] == whole.certificate["seconds"]


def test_no_feasible_shape_is_said_to_be_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(optimum_module, "MANY_STARTS", 2)
    problem = Problem.of(
        [[0.0], [1.0], [0.0], [1.0]], Limits.of(1.0, 1.0, position=[[0.0, 1.0]], dof=1)
    )
    with pytest.raises(NoFeasibleMotion):
        proved_optimum(problem)
