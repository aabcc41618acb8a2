"""The certified bound of a family: true, tight, sound, and checkable by a program of its own."""

from __future__ import annotations

import ast
import copy
import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare.benchmark.grade import Run, grade
from compare.benchmark.objective import CODINGS
from compare.check_certificate import __main__ as check_certificate
from compare.check_certificate import claim
from compare.check_certificate.__main__ import BAD_INPUT, CERTIFIED, REFUSED
from formulations import (
    CASES,
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
from formulations.proofs.arithmetic.outward import down, quadratic_least, up
from formulations.proofs.certificate import certificate_of, certificate_of_proof, write_certificate
from formulations.proofs.displacement import displacement_bound
from formulations.proofs.events import ABOVE, ASIDE, BELOW, EMPTY, LEAF, SPLIT, TURN
from formulations.proofs.every_motion.velocity_acceleration import velocity_acceleration_bound
from formulations.proofs.family import PROVERS
from formulations.proofs.four_three_four import bound as four_three_four
from formulations.proofs.proof import Proof
from formulations.proofs.quintic import bound as quintic
from formulations.proofs.three_five_three import bound as three_five_three
from metaheuristics import ALGORITHMS

ROOT = Path(__file__).parents[3]
CASES_353 = [name for name in CASES if load(name).family == "3-5-3"]


def proof_of(problem: Problem, L: float, boxes: int = 200_000, **how: Any) -> Proof:
    record = how.pop("record", False)
    proof = Proof(PROVERS[problem.family](problem, L, **how), L, record=record)
    proof.run(boxes)
    return proof


def holds(bound: FamilyBound, gap: float) -> None:
    """What must hold of every finished bound."""
    assert bound.status == "proved"
    assert bound.seconds <= bound.upper <= bound.seconds * (1.0 + gap)
    assert bound.durations is not None
    stretch = FAMILIES[bound.family].stretch(bound.problem, bound.durations[None])[0]
    assert stretch <= 1.0 + 1e-12
    assert float(bound.durations.sum()) == pytest.approx(bound.upper, rel=1e-14)
    # the other side: a bound that is too good is never proved
    assert not proof_of(bound.problem, bound.upper * (1.0 + 1e-9), 2000).proved


def random_problem(
    rng: np.random.Generator, n: int, dof: int, kind: str, least: float = -3.0, still: int = -1
) -> Problem:
    """Displacements log-uniform in 10^least .. 2 rad; still: a segment on which nothing moves."""
    size = 10.0 ** rng.uniform(least, np.log10(2.0), (n, dof))
    d = size * rng.choice([-1.0, 1.0], (n, dof))
    if still >= 0:
        d[still] = 0.0
    waypoints = np.vstack([np.zeros(dof), np.cumsum(d, axis=0)])
    if still >= 0:  # the sums above may round
        waypoints[still + 1] = waypoints[still]
    velocity, acceleration, jerk = (
        rng.uniform(0.5, 3, dof),
        rng.uniform(0.5, 5, dof),
        rng.uniform(1, 20, dof),
    )
    limits = Limits.of(
        velocity,
        acceleration if "A" in kind else np.inf,
        jerk if "J" in kind else np.inf,
        dof=dof,
    )
    return Problem.of(waypoints, limits, family="3-5-3" if n == 3 else "4-3-4")


def stretched(motion: FamilyOptimum) -> float:
    factor = FAMILIES[motion.family].stretch(motion.problem, motion.durations[None])[0]
    return float(motion.durations.sum() * factor)


# --- true and tight -------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES_353)
def test_every_shipped_3_5_3_case_is_proved_together_and_joint_by_joint(case: str) -> None:
    problem = load(case)
    for each in [problem, *(problem.joint(j) for j in problem.moving_joints)]:
        holds(family_bound(each), 1e-7)


@pytest.mark.slow
def test_bagging_is_proved() -> None:
    holds(family_bound(load("bagging"), gap=1e-6, time_limit=20.0), 1e-6)


@pytest.mark.slow
def test_random_3_5_3_problems_are_all_proved() -> None:
    rng = np.random.default_rng(2024)
    found_by_the_proof = 0
    for i in range(60):
        problem = random_problem(rng, 3, int(rng.integers(1, 8)), ("V", "VA", "VAJ")[i % 3])
        if i % 2:
            start = family_optimum(problem, random_starts=0)
        else:  # a feasible motion that is no optimum: proof and NLP must find it together
            start = FamilyOptimum(problem, "3-5-3", np.ones(3), ())
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
    optimum = family_optimum(problem, random_starts=2)
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


def anyhow(problem: Problem) -> FamilyOptimum:
    """A feasible motion that is no optimum, for a proof to start from."""
    return FamilyOptimum(problem, problem.family, np.ones(problem.n_segments), ())


@pytest.fixture(scope="module")
def z1_as_quintic() -> FamilyBound:
    start = FamilyOptimum(load("z1"), "quintic", np.array([3.2, 2.5, 1.8, 3.4, 2.2, 2.2, 2.6]), ())
    return family_bound(as_quintic(load("z1")), gap=5e-10, optimum=start, record=True)


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


def as_quintic(problem: Problem) -> Problem:
    return replace(problem, family="quintic")


@pytest.mark.parametrize("family", ["b-spline-3", "b-spline-5"])
def test_of_b_splines_the_bound_of_every_motion_is_proved_and_said(family: str) -> None:
    problem = replace(load("z1"), family=family)
    bound = family_bound(problem, optimum=anyhow(problem))
    assert bound.status == "undecided"
    assert bound.reason.startswith("what is proved holds for every motion")
    assert displacement_bound(problem) * 1.7 < bound.seconds < bound.upper


def test_the_bound_of_every_motion_is_nearly_that_of_one_segment() -> None:
    rng = np.random.default_rng(0)
    for _ in range(4):
        d, v, a = 10.0 ** rng.uniform(-3, 3), 10.0 ** rng.uniform(-2, 2), 10.0 ** rng.uniform(-2, 2)
        problem = Problem.of([[0.0], [d]], Limits.of(v, a, dof=1))
        fastest = d / v + v / a if d * a > v * v else 2.0 * np.sqrt(d / a)
        assert fastest * 0.95 < velocity_acceleration_bound(problem, 16).seconds < fastest
        assert fastest * 0.99 < velocity_acceleration_bound(problem, 48).seconds < fastest


def test_with_velocities_alone_every_motion_is_bounded_by_displacement() -> None:
    for case in ("cobot", "bagging"):
        seconds = velocity_acceleration_bound(load(case)).seconds
        assert seconds == pytest.approx(displacement_bound(load(case)), rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("family", ["quintic", "b-spline-3", "b-spline-5"])
def test_no_motion_of_a_family_is_faster_than_its_bound(family: str) -> None:
    rng = np.random.default_rng(3)
    for kind, spread in (("V", 0.7), ("VA", 0.4), ("VAJ", 0.2)):
        still = 1 if kind == "VA" else -1
        problem = replace(random_problem(rng, 3, 2, kind, -1.5, still), family=family)
        bound = family_bound(problem, gap=1e-4, time_limit=1.0, optimum=anyhow(problem))
        assert bound.durations is not None
        shapes = bound.durations * np.exp(spread * rng.normal(size=(4000, 3)))
        totals = shapes.sum(axis=1) * FAMILIES[family].stretch(problem, shapes)
        assert 0.0 < bound.seconds <= bound.upper
        assert totals.min() >= bound.least_verified


def test_a_joint_without_any_limit_is_not_applicable() -> None:
    unlimited = replace(Limits.of(1.0, dof=1), velocity=np.array([np.inf]))  # ``of`` refuses it
    problem = Problem.of([[0.0], [1.0], [2.0], [3.0]], unlimited)
    assert "without a limit" in family_bound(problem).reason


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
    optimum = family_optimum(problem, random_starts=2)
    bound = family_bound(problem, gap=1e-9, time_limit=0.05, optimum=optimum)
    assert bound.status == "time limit"
    assert displacement_bound(problem) <= bound.seconds < bound.upper
    assert bound.gap > 1e-9
    assert bound.runtime < 20.0  # compiling, perhaps, but not the proof
    longer = family_bound(problem, gap=1e-9, time_limit=1.0, optimum=optimum)
    assert longer.seconds >= bound.seconds


# --- sound: no feasible motion is ever discarded ----------------------------------------------------


def feasible_points(problem: Problem, L: float, base: Any, rng: np.random.Generator) -> Any:
    """Durations (m, n) of feasible motions whose total is L, most of them close to their limits."""
    family, found = FAMILIES[problem.family], []
    for spread in (1e-6, 1e-4, 3e-3, 0.03, 0.1, 0.3, 1.0):
        T = base * np.exp(spread * rng.normal(size=(4000, len(base))))
        T = T[T.sum(axis=1) * family.stretch(problem, T) <= L]
        if problem.limits.has_position and len(T):
            T = T[family.position_excess(problem, T) <= problem.position_slack]
        found.append((T * (L / T.sum(axis=1))[:, None])[:200])
    return np.vstack(found)


def followed(proof: Proof, points: Any) -> tuple[int, int]:
    """Points (m, n) that meet a discard, and that end undecided, down the logged tree."""
    log, near = proof.log(), 1e-11
    stack, here = [np.arange(len(points))], None
    lost = kept = 0
    for (code, k, _), value, (lo, hi) in zip(log.codes.tolist(), log.values, log.boxes, strict=True):
        if here is None:
            here = stack.pop()
        x = points[here]
        gone = np.zeros(len(here), dtype=bool)
        if code == TURN:
            gone = ((x < lo * (1.0 - near)) | (x > hi * (1.0 + near))).any(axis=1)
        elif code == BELOW:
            gone = x[:, k] > value * (1.0 + near)
        elif code == ABOVE:
            gone = x[:, k] < value * (1.0 - near)
        elif code in (EMPTY, LEAF):
            gone[:] = True
        lost += int(gone.sum())
        here = here[~gone]
        if code == SPLIT:
            stack += [here[points[here, k] < value], here[points[here, k] >= value]]
        if code == ASIDE:
            kept += len(here)
        if code in (EMPTY, LEAF, SPLIT, ASIDE):
            here = None
    rest = stack if here is None else [*stack, here]  # only of a search cut short
    assert not rest or proof.depth > 0
    return lost, kept + sum(map(len, rest))


def follow(problem: Problem, base: Any, above: float, shrink: float, rng: np.random.Generator) -> Any:
    """Follow feasible points of a problem through a search whose limits were multiplied by shrink."""
    L = float(base.sum()) * above
    points = feasible_points(problem, L, base, rng)
    limits = problem.limits
    other = Problem.of(
        problem.waypoints,
        Limits.of(
            limits.velocity * shrink,
            limits.acceleration * shrink,
            limits.jerk * shrink,
            limits.position,
            dof=problem.dof,
        ),
        family=problem.family,
    )
    begin = PROVERS[problem.family]
    narrow = 0.003 if problem.family == "3-5-3" else 0.02
    proof = Proof(begin(other, L, narrow=narrow, aside=True), L, record=True)
    proof.run(3000)
    x = 1.0 / points
    if problem.family == "3-5-3":
        x = points[:, [1, 1]] / points[:, [0, 2]]
    return len(points), *followed(proof, x)


@pytest.mark.slow
@pytest.mark.parametrize("family", ["3-5-3", "4-3-4"])
def test_no_feasible_motion_is_lost_by_a_discard_or_a_cut(family: str) -> None:
    rng = np.random.default_rng(7)
    total = lost = kept = noticed = mutants = 0
    for i in range(12):
        n = 3 if family == "3-5-3" else int(rng.integers(2, 5))
        still = int(rng.integers(n)) if i % 4 == 3 and family == "4-3-4" else -1
        problem = random_problem(
            rng, n, int(rng.integers(1, 4)), ("V", "VA", "VAJ")[i % 3], -1.3, still
        )
        if family == "4-3-4":
            problem = Problem.of(problem.waypoints, problem.limits, family=family)
        base = family_optimum(problem, random_starts=1).durations
        if i % 3 == 2:  # with position limits that this motion keeps
            T = base[None]
            widest = float(FAMILIES[family].position_excess(closed(problem), T)[0]) + 0.01
            problem = closed(problem, widest)
        counts = follow(problem, base, (1.0 + 1e-9, 1.001, 1.03)[i // 4], 1.0, rng)
        total, lost, kept = total + counts[0], lost + counts[1], kept + counts[2]
        mutant = follow(problem, base, 1.0 + 1e-9, 0.98, rng)
        mutants, noticed = mutants + (mutant[0] > 0), noticed + (mutant[1] > 0)
    assert total > 2000
    assert lost == 0
    assert kept > 0.3 * total
    assert mutants > 5
    assert noticed == mutants  # with limits that are 2 % too low the test does fail


def lost_in_the_chain(problem: Problem, points: Any, L: float, shrink: float) -> int:
    """Points (m, n) on triples that a search with limits multiplied by shrink discards."""
    limits = problem.limits
    scaled = [limit * shrink for limit in (limits.velocity, limits.acceleration, limits.jerk)]
    other = replace(problem, limits=Limits.of(*scaled, limits.position, dof=problem.dof))
    search = quintic.Search(other, L, None, 1e-11, None)
    x = np.pad(1.0 / points, ((0, 0), (1, 1)), constant_values=1.0)
    x[:, np.pad((problem.displacements == 0.0).all(axis=1), 1)] = 1.0
    alive = np.ones(len(x), bool)
    for _ in range(9):
        search.step()
        for k, (a, b, c) in enumerate(search.chain.triples):
            ends = [
                (
                    search.chain.lo[k + i][cell] * (1.0 - 1e-11),
                    search.chain.hi[k + i][cell] * (1.0 + 1e-11),
                )
                for i, cell in enumerate((a, b, c))
            ]
            held = [
                (lo <= x[:, k + i, None]) & (x[:, k + i, None] <= hi) for i, (lo, hi) in enumerate(ends)
            ]
            alive &= (held[0] & held[1] & held[2]).any(axis=1)
        if search.chain.empty or search.chain.size > 20_000:
            break
    return int((~alive).sum())


@pytest.mark.slow
def test_no_feasible_quintic_is_lost_by_a_discard_or_a_cut() -> None:
    rng = np.random.default_rng(8)
    total = mutants = noticed = 0
    for i in range(6):
        n = int(rng.integers(1, 5))
        still = int(rng.integers(n)) if i % 4 == 3 else -1
        kind = ("V", "VA", "VAJ")[i % 3]
        problem = as_quintic(random_problem(rng, n, int(rng.integers(1, 4)), kind, -1.3, still))
        base = family_optimum(problem, random_starts=0).durations
        if i % 3 == 2:  # with position limits that this motion keeps
            excess = FAMILIES["quintic"].position_excess(closed(problem), base[None])[0]
            problem = closed(problem, float(excess) + 0.01)
        L = float(base.sum()) * (1.0 + 1e-9, 1.001, 1.03)[i // 2]
        points = feasible_points(problem, L, base, rng)
        total += len(points)
        assert lost_in_the_chain(problem, points, L, 1.0) == 0
        L = float(base.sum()) * (1.0 + 1e-9)
        points = feasible_points(problem, L, base, rng)
        mutants += len(points) > 0
        noticed += lost_in_the_chain(problem, points, L, 0.98) > 0
    assert total > 1500
    assert noticed == mutants > 3  # with limits that are 2 % too low the test does fail


def closed(problem: Problem, margin: float = 0.0) -> Problem:
    """The problem with position limits at its waypoints, a margin [rad] away."""
    w, limits = problem.waypoints, problem.limits
    reach = np.stack([w.min(axis=0) - margin, w.max(axis=0) + margin + 1e-12], axis=1)
    bounds = Limits.of(limits.velocity, limits.acceleration, limits.jerk, reach, dof=problem.dof)
    return Problem.of(w, bounds, family=problem.family)


def test_rounding_is_outward() -> None:
    rng = np.random.default_rng(0)
    from fractions import Fraction

    for _ in range(300):
        a, b, k, p, q = (rng.normal(size=5) * 10.0 ** rng.uniform(-12, 12, 5)).tolist()
        exact = Fraction(a) * Fraction(b)
        assert Fraction(down(a * b)) <= exact <= Fraction(up(a * b))
        lo, hi = min(p, q), max(p, q)
        least = quadratic_least(a, a, k, lo, hi)
        for t in (lo, hi, 0.5 * (lo + hi), min(max(-0.5 * a / k, lo), hi)):
            assert Fraction(least) <= Fraction(a) * Fraction(t) + Fraction(k) * Fraction(t) ** 2


# --- the certificate ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def sr4c() -> FamilyBound:
    return family_bound(load("sr4c"), record=True)


def outcome(tmp_path: Path, certificate: Any, *more: str) -> int:
    path = tmp_path / "certificate.json"
    path.write_text(certificate if isinstance(certificate, str) else json.dumps(certificate), "utf-8")
    return check_certificate.main([str(path), *more])


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES_353)
def test_the_checker_proves_every_shipped_3_5_3_case_again(case: str, tmp_path: Path) -> None:
    problem = load(case)
    path = tmp_path / "certificate.json"
    for each in [problem, *(problem.joint(j) for j in problem.moving_joints)]:
        bound = family_bound(each, optimum=family_optimum(each, random_starts=2), record=True)
        assert bound.certificate is not None
        write_certificate(path, bound.certificate)
        named = ["--problem", case] if each is problem else []
        assert check_certificate.main([str(path), *named]) == CERTIFIED
        assert float.fromhex(json.loads(path.read_text())["seconds"]) == bound.seconds


@pytest.mark.slow
def test_the_checker_proves_bagging_again(tmp_path: Path) -> None:
    bound = family_bound(load("bagging"), gap=1e-6, record=True)
    assert outcome(tmp_path, bound.certificate, "--problem", "bagging") == CERTIFIED


@pytest.mark.slow
def test_the_checker_follows_open_segments_jumps_and_position_limits(tmp_path: Path) -> None:
    problem = random_problem(np.random.default_rng(3), 4, 2, "VAJ", least=-0.5, still=1)
    bound = family_bound(problem, gap=1e-4, record=True)
    assert bound.status == "proved"
    assert bound.certificate is not None
    kinds = {
        row[0]
        for event in bound.certificate["events"]
        if isinstance(event[-1], list)
        for row in event[-1]
    }
    assert "j" in kinds
    assert outcome(tmp_path, bound.certificate) == CERTIFIED
    for n in (3, 4):
        limited = closed(random_problem(np.random.default_rng(n), n, 2, "VA", least=-0.5), 0.1)
        bound = family_bound(limited, gap=1e-4, record=True)
        if bound.status == "proved":
            assert outcome(tmp_path, bound.certificate) == CERTIFIED


@pytest.mark.parametrize("ends", [(), (0,), (2,)])
def test_the_checker_proves_that_a_still_middle_segment_cannot_vanish(
    ends: tuple[int, ...], tmp_path: Path
) -> None:
    problem = random_problem(np.random.default_rng(1), 3, 2, "VA", least=-0.5, still=1)
    d = np.diff(problem.waypoints, axis=0)
    d[list(ends)] = 0.0  # nothing moves there either
    problem = replace(problem, waypoints=np.concatenate([[np.zeros(2)], np.cumsum(d, axis=0)]))
    bound = family_bound(problem, gap=1e-3, record=True)
    assert bound.status == "proved"
    certificate: Any = bound.certificate
    assert outcome(tmp_path, certificate) == CERTIFIED
    discards = certificate["short"]["discards"]
    for fault in (
        lambda c: c.pop("short"),
        lambda c: c["short"]["discards"].pop(),
        lambda c: c["short"]["discards"].pop(0),
        lambda c: c["short"].update(tau=(0.5 * bound.seconds).hex()),
        lambda c: c["short"]["discards"][-1].__setitem__(-1, -discards[-1][-1]),
        lambda c: c["short"]["discards"][-1].__setitem__(5, (2.0).hex()),
    ):
        faulty = copy.deepcopy(certificate)
        fault(faulty)
        assert outcome(tmp_path, faulty) != CERTIFIED


def leaves(certificate: Any) -> list[int]:
    return [i for i, event in enumerate(certificate["events"]) if event[0] == "L" and len(event) > 1]


def planted(change: Callable[[Any], None]) -> Callable[[Any], Any]:
    def fault(certificate: Any) -> Any:
        changed = copy.deepcopy(certificate)
        change(changed)
        return changed

    return fault


def _scaled(certificate: Any, key: str, joint: int, factor: float) -> None:
    values = certificate["limits"][key]
    values[joint] = (float.fromhex(values[joint]) * factor).hex()


FAULTS: dict[str, Callable[[Any], None]] = {
    "a missing leaf": lambda c: c["events"].pop(leaves(c)[3]),
    "a missing first event": lambda c: c["events"].pop(0),
    "a missing last event": lambda c: c["events"].pop(),
    "a missing split": lambda c: c["events"].pop([e[0] for e in c["events"]].index("S")),
    "an event too many": lambda c: c["events"].append(c["events"][-1]),
    "no events": lambda c: c.update(events=[]),
    "a leaf without rows": lambda c: c["events"].__setitem__(leaves(c)[0], ["L", []]),
    "a split outside": lambda c: c["events"].insert(0, ["S", 0, (1e6).hex()]),
    "the other half empty": lambda c: c["events"].insert(0, ["E"]),
    "a slab too thick": lambda c: c["events"].insert(
        0, ["B", 0, (1e-3).hex(), c["events"][leaves(c)[0]][1]]
    ),
    "a higher acceleration limit": lambda c: (
        [_scaled(c, "acceleration", j, 1.02) for j in range(6)] and None
    ),
    "another waypoint": lambda c: c["waypoints"][1].__setitem__(5, (0.9).hex()),
    "a negative slack": lambda c: c.update(position_slack="-0x1p-10"),
    "a negative bound": lambda c: c.update(seconds="-0x1p+2"),
    "a limit of zero": lambda c: c["limits"]["velocity"].__setitem__(0, "0x0p+0"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_the_checker_refuses(fault: str, sr4c: FamilyBound, tmp_path: Path) -> None:
    assert outcome(tmp_path, sr4c.certificate) == CERTIFIED
    assert outcome(tmp_path, planted(FAULTS[fault])(sr4c.certificate)) == REFUSED


def test_every_wrong_multiplier_is_refused(sr4c: FamilyBound, tmp_path: Path) -> None:
    assert sr4c.certificate is not None
    wrong = 0
    for i, event in enumerate(sr4c.certificate["events"]):
        if not isinstance(event[-1], list):
            continue
        for r, row in enumerate(event[-1]):
            for factor in (-1.0, 0.0):
                changed = copy.deepcopy(sr4c.certificate)
                changed["events"][i][-1][r][-1] = (factor * float.fromhex(row[-1])).hex()
                assert outcome(tmp_path, changed) == REFUSED
            if row[0] == "p":  # the limit on the other side
                changed = copy.deepcopy(sr4c.certificate)
                changed["events"][i][-1][r][-2] *= -1
                assert outcome(tmp_path, changed) == REFUSED
            if len(event[-1]) > 1:  # the sum is no longer positive
                changed = copy.deepcopy(sr4c.certificate)
                changed["events"][i][-1][r][-1] = (1e3 * float.fromhex(row[-1])).hex()
                wrong += outcome(tmp_path, changed) == REFUSED
    assert wrong > 2


def test_a_bound_too_good_by_a_billionth_is_refused(tmp_path: Path) -> None:
    bound = family_bound(load("sr4c"), gap=5e-10, record=True)
    assert bound.status == "proved"
    assert outcome(tmp_path, bound.certificate) == CERTIFIED
    assert bound.certificate is not None
    for factor in (1.0 + 1e-9, 1.01, 2.0, 1e3):
        assert (
            outcome(tmp_path, {**bound.certificate, "seconds": (bound.seconds * factor).hex()})
            == REFUSED
        )


@pytest.fixture(scope="module")
def chained() -> FamilyBound:
    """A quintic that takes cells, rows and sums to prove."""
    problem = as_quintic(random_problem(np.random.default_rng(2), 4, 2, "VAJ", least=-1.0))
    return family_bound(problem, gap=1e-6, optimum=anyhow(problem), record=True)


def _letters(certificate: Any, letter: str) -> list[int]:
    return [i for i, event in enumerate(certificate["events"]) if event[0] == letter]


CHAIN_FAULTS: dict[str, Callable[[Any], None]] = {
    "no events": lambda c: c.update(events=[]),
    "no cut": lambda c: c.update(events=[e for e in c["events"] if e[0] != "C"]),
    "no rows": lambda c: c.update(events=[e for e in c["events"] if e[0] != "R"]),
    "no sums": lambda c: c.update(events=[e for e in c["events"] if e[0] != "L"]),
    "no last event": lambda c: c["events"].pop(),
    "sums without the total": lambda c: (
        [c["events"][i].__setitem__(1, c["events"][i][1][1:]) for i in _letters(c, "L")] and None
    ),
    "sums of the total alone": lambda c: (
        [c["events"][i].__setitem__(1, c["events"][i][1][:1]) for i in _letters(c, "L")] and None
    ),
    "a multiplier that is not positive": lambda c: c["events"][_letters(c, "L")[-1]][1][-1].__setitem__(
        -1, (-1.0).hex()
    ),
    "a higher jerk limit": lambda c: [_scaled(c, "jerk", j, 1.02) for j in range(2)] and None,
    "another waypoint": lambda c: c["waypoints"][2].__setitem__(0, (0.01).hex()),
    "a bound too good": lambda c: c.update(seconds=(float.fromhex(c["seconds"]) * (1.0 + 2e-6)).hex()),
    "a bound twice too good": lambda c: c.update(seconds=(float.fromhex(c["seconds"]) * 2.0).hex()),
}


@pytest.mark.parametrize("fault", CHAIN_FAULTS)
def test_the_checker_refuses_of_a_chain(fault: str, chained: FamilyBound, tmp_path: Path) -> None:
    assert chained.status == "proved"
    assert {event[0] for event in chained.certificate["events"]} == {"C", "R", "L"}  # type: ignore[index]
    assert outcome(tmp_path, chained.certificate) == CERTIFIED
    assert outcome(tmp_path, planted(CHAIN_FAULTS[fault])(chained.certificate)) == REFUSED


@pytest.mark.slow
def test_every_row_of_a_sum_counts(z1_as_quintic: FamilyBound, tmp_path: Path) -> None:
    bound = z1_as_quintic
    assert bound.certificate is not None
    ((_, rows),) = bound.certificate["events"]  # one sum proves it all
    assert outcome(tmp_path, bound.certificate) == CERTIFIED
    assert (
        outcome(tmp_path, {**bound.certificate, "seconds": (bound.seconds * (1 + 1e-9)).hex()})
        == REFUSED
    )
    for r, row in enumerate(rows[1:], 1):
        for factor in (0.9, 1.1, 100.0):
            wrong = [*row[:-1], (factor * float.fromhex(row[-1])).hex()]
            events = [["L", [*rows[:r], wrong, *rows[r + 1 :]]]]
            assert outcome(tmp_path, {**bound.certificate, "events": events}) == REFUSED


def test_what_an_unfinished_chain_has_proved_can_be_checked(tmp_path: Path) -> None:
    problem = as_quintic(random_problem(np.random.default_rng(2), 4, 2, "VAJ", least=-1.0))
    optimum = family_optimum(problem, random_starts=0)
    L = optimum.seconds * 1.01  # more than can be proved
    proof = Proof(quintic.begin(problem, L, near=optimum.durations), L)
    reached = []
    for _ in range(6):
        proof.run(1)
        reached.append(proof.seconds)
        assert not proof.proved
        assert outcome(tmp_path, certificate_of_proof(problem, proof)) == CERTIFIED
    assert reached == sorted(reached)
    assert optimum.seconds * 0.95 < reached[-1] <= optimum.seconds


def test_the_checker_proves_the_bound_of_every_motion_again(tmp_path: Path) -> None:
    bound = family_bound(load("z1"), optimum=anyhow(load("z1")), record=True)
    certificate = bound.certificate
    assert certificate is not None
    assert outcome(tmp_path, certificate, "--problem", "z1") == CERTIFIED
    events = certificate["events"]
    other = [*events[0][:2], [(2.0).hex(), *events[0][2][1:]], events[0][3]]
    for wrong in (
        {**certificate, "seconds": (bound.seconds * (1 + 1e-9)).hex()},
        {**certificate, "events": events[1:]},
        {**certificate, "events": [*events, events[0]]},
        {**certificate, "events": [other, *events[1:]]},
    ):
        assert outcome(tmp_path, wrong) == REFUSED
    short = [*events[0][:3], events[0][3][:-1]]
    assert outcome(tmp_path, {**certificate, "events": [short, *events[1:]]}) == REFUSED
    # of displacement alone, the domain is the proof
    simple = certificate_of(load("z1"), displacement_bound(load("z1")))
    assert outcome(tmp_path, simple, "--problem", "z1") == CERTIFIED
    assert outcome(tmp_path, {**simple, "seconds": (7.2542).hex()}) == REFUSED


def test_another_problem_is_refused(sr4c: FamilyBound, tmp_path: Path) -> None:
    assert outcome(tmp_path, sr4c.certificate, "--problem", "sr4c") == CERTIFIED
    assert outcome(tmp_path, sr4c.certificate, "--problem", "ur5") == REFUSED
    assert outcome(tmp_path, sr4c.certificate, "--problem", "no-such-case") == BAD_INPUT
    # lower limits leave the proof true, but of another problem
    lower = planted(lambda c: _scaled(c, "velocity", 0, 0.5))(sr4c.certificate)
    assert outcome(tmp_path, lower, "--problem", "sr4c") == REFUSED
    tighter = {**(sr4c.certificate or {}), "position_slack": (0.0).hex()}
    assert outcome(tmp_path, tighter, "--problem", "sr4c") == REFUSED


HOSTILE: dict[str, Callable[[Any], Any]] = {
    "truncated": lambda c: json.dumps(c)[: len(json.dumps(c)) // 2],
    "empty": lambda c: "",
    "not JSON": lambda c: "certified",
    "a list": lambda c: "[]",
    "null": lambda c: "null",
    "nested without end": lambda c: "[" * 200_000,
    "a closed nest": lambda c: "[" * 100_000 + "]" * 100_000,
    "NaN": lambda c: json.dumps(c).replace('"seconds": "', '"seconds": NaN, "other": "'),
    "hexadecimal NaN": lambda c: {**c, "seconds": "nan"},
    "infinity": lambda c: {**c, "seconds": "inf"},
    "too large a number": lambda c: {**c, "seconds": "0x1p+99999"},
    "a number, not text": lambda c: {**c, "seconds": 1.0},
    "many digits": lambda c: json.dumps(c)[:-1] + ', "x": ' + "9" * 10_000 + "}",
    "no events": lambda c: {k: v for k, v in c.items() if k != "events"},
    "events of another type": lambda c: {**c, "events": {"0": ["E"]}},
    "an unknown event": lambda c: {**c, "events": [["X"]]},
    "an event without a name": lambda c: {**c, "events": [[]]},
    "an event of lists": lambda c: {**c, "events": [[["L"]]]},
    "a variable that is true": lambda c: {**c, "events": [["S", True, "0x1p+0"]]},
    "a variable too far": lambda c: {**c, "events": [["S", 7, "0x1p+0"]]},
    "an unknown row": lambda c: {**c, "events": [["L", [["q", "0x1p+0"]]]]},
    "a row of another length": lambda c: {**c, "events": [["L", [["p", 0, 1, "0x1p+0"]]]]},
    "unequal waypoints": lambda c: {**c, "waypoints": [["0x0p+0"], []]},
    "too many waypoints": lambda c: {**c, "waypoints": c["waypoints"] * 100},
    "no limits": lambda c: {**c, "limits": None},
    "another format": lambda c: {**c, "format": "timebound certificate 2"},
    "another family": lambda c: {**c, "family": ["3-5-3"]},
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_file_is_one_line(
    kind: str, sr4c: FamilyBound, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert outcome(tmp_path, HOSTILE[kind](sr4c.certificate)) == BAD_INPUT
    said = capsys.readouterr()
    assert said.err.startswith("error: ")
    assert said.err.count("\n") == 1
    assert not said.out


def test_sizes_are_limited(sr4c: FamilyBound, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(claim, "MOST_EVENTS", 3)
    assert outcome(tmp_path, sr4c.certificate) == BAD_INPUT
    monkeypatch.setattr(check_certificate, "LARGEST_FILE", 100)
    assert outcome(tmp_path, sr4c.certificate) == BAD_INPUT
    assert check_certificate.main([str(tmp_path / "missing.json")]) == BAD_INPUT


def test_the_checker_shares_no_code_with_the_prover() -> None:
    """But for the loader, to compare the problem; its own folder and python-flint are all it has."""
    own = {
        "__future__",
        "bisect",
        "collections.abc",
        "compare.__main__",  # the command line, which loads nothing of the prover: tested there
        "compare.commands",
        "flint",
        "itertools",
        "json",
        "math",
        "pathlib",
        "sys",
        "typing",
    }
    imported = []
    for path in (ROOT / "compare" / "check_certificate").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Import):
                imported += [name.name for name in node.names]
            elif isinstance(node, ast.ImportFrom):
                imported.append(str(node.module))
    others = [name for name in imported if not name.startswith("compare.check_certificate")]
    assert set(others) - own == {"formulations"}
    assert others.count("formulations") == 1


@pytest.mark.slow
def test_solve_writes_a_certificate_that_the_command_accepts(tmp_path: Path) -> None:
    path = tmp_path / "sr4c.json"
    run = [sys.executable, "-m"]
    solved = subprocess.run(
        [*run, "compare.solve", "sr4c", "--certificate", str(path)],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert solved.returncode == 0, solved.stderr
    assert "family_lower" in solved.stdout
    checked = subprocess.run(
        [*run, "compare.check_certificate", str(path), "--problem", "sr4c"],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert checked.returncode == 0, checked.stderr
    assert checked.stdout.startswith("certified: ")


def test_without_flint_the_checker_names_the_extra(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "flint", None)
    assert check_certificate.main(["any.json"]) == BAD_INPUT
    assert "timebound[certificate]" in capsys.readouterr().err


# --- the law the project exists for, now a theorem ----------------------------------------------------


@pytest.mark.slow
def test_no_swarm_beats_the_certified_bound(sr4c: FamilyBound) -> None:
    problem = load("sr4c")
    judged = 0
    for coding in CODINGS:
        for swarm in ALGORITHMS:
            row = grade(Run("sr4c", coding, swarm, 0, 2000, 20), problem, sr4c.seconds).row
            if row.seconds is not None:
                judged += 1
                assert row.seconds >= sr4c.least_verified
    assert judged > 3


def test_the_provers_are_those_of_their_families() -> None:
    begins = {
        "3-5-3": three_five_three.begin,
        "4-3-4": four_three_four.begin,
        "quintic": quintic.begin,
    }
    assert begins == PROVERS
