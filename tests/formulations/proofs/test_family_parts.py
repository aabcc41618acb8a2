"""Bounds of parts of a 4-3-...-3-4 motion: no motion's part is faster, and their certificates are checked."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from family_problems import closed, outcome, planted, random_problem

from formulations import FAMILIES, Problem, family_bound, family_optimum
from formulations.proofs.certificate import certificate_of_proof
from formulations.proofs.four_three_four import parts as parts_module
from formulations.proofs.four_three_four.bound import begin
from formulations.proofs.four_three_four.parts import least_time, parts_of
from formulations.proofs.part import PartBound
from formulations.proofs.proof import Proof

N = 5  # segments: parts of one to four


@pytest.fixture(autouse=True)
def few_segments(monkeypatch: pytest.MonkeyPatch) -> None:
    """Parts of short problems too; the search does not depend on the number."""
    monkeypatch.setattr(parts_module, "LEAST_SEGMENTS", N)
    monkeypatch.setattr(parts_module, "_LONGEST", N - 1)
    monkeypatch.setattr(parts_module, "_BOXES", 150)


def problem_of(seed: int, kind: str, still: int = -1, dof: int = 2) -> Problem:
    return random_problem(np.random.default_rng(seed), N, dof, kind, -1.0, still)


def bounded(problem: Problem, durations: Any, horizon: float) -> tuple[PartBound, ...]:
    return parts_of(
        problem, durations, horizon, record=True, over=lambda: False, progress=lambda boxes: None
    )


@pytest.mark.parametrize(
    ("seed", "kind", "still", "position"),
    [
        (1, "VAJ", -1, False),
        (2, "VA", 2, False),
        (3, "VAJ", 0, False),
        (4, "VA", -1, True),
        (5, "V", -1, False),
    ],
)
def test_no_part_of_a_feasible_motion_is_faster_than_its_bound(
    seed: int, kind: str, still: int, position: bool
) -> None:
    rng, problem = np.random.default_rng(seed), problem_of(seed, kind, still)
    best = family_optimum(problem, starts=3).durations
    if position:
        excess = FAMILIES["4-3-4"].position_excess(closed(problem), best[None])[0]
        problem = closed(problem, float(excess) + 0.01)
    horizon = 3.0 * float(best.sum())
    parts = bounded(problem, best, horizon)
    assert len(parts) >= N
    # a part is fastest where the rest gives way: a random search that moves the rest as well
    closest = np.inf
    for part in parts:
        inside, centre, least = slice(part.start, part.end), best * 1.5, np.inf
        centre[inside] = best[inside]
        for spread in (0.6, 0.4, 0.3, 0.2, 0.1, 0.05):
            T = centre * np.exp(spread * rng.normal(size=(4000, N)))
            T *= FAMILIES["4-3-4"].stretch(problem, T)[:, None]
            T = T[T.sum(axis=1) <= horizon]
            if position:
                T = T[FAMILIES["4-3-4"].position_excess(problem, T) <= problem.position_slack]
            times = T[:, inside].sum(axis=1)
            if len(T) and times.min() < least:
                least, centre = times.min(), T[times.argmin()]
        assert least > part.seconds * (1.0 - 1e-12)
        closest = min(closest, least / part.seconds)
    assert closest < 1.3  # the sample is good enough to notice bounds that are too high


def test_bounds_of_parts_add_up_and_are_kept_by_the_whole() -> None:
    problem = problem_of(1, "VAJ")
    best = family_optimum(problem, starts=3)
    parts = bounded(problem, best.durations, best.seconds)
    shortest = np.zeros(N)
    total = least_time(shortest, (0, N), parts)
    by_hand = {0: 0.0}  # every way to put parts side by side
    for end in range(1, N + 1):
        ways = [by_hand[p.start] + p.seconds for p in parts if p.end == end]
        by_hand[end] = max([by_hand[end - 1], *ways])
    assert total == pytest.approx(by_hand[N], rel=1e-14)
    assert 0.5 * best.seconds < total < best.seconds
    # less than the sum is proved without a split
    proof = Proof(begin(problem, total * (1.0 - 1e-9), parts=parts), total * (1.0 - 1e-9))
    proof.run(10)
    assert proof.proved
    assert proof.boxes == 1
    # and what is not true is not proved with them
    proof = Proof(begin(problem, best.seconds * (1.0 + 1e-9), parts=parts), best.seconds * (1.0 + 1e-9))
    proof.run(2000)
    assert not proof.proved


@pytest.fixture(scope="module")
def certificate() -> Any:
    """A proof that uses parts with free ends, splits of velocities and a still segment."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(parts_module, "LEAST_SEGMENTS", N)
        patch.setattr(parts_module, "_BOXES", 150)
        problem = problem_of(2, "VA", 2)
        best = family_optimum(problem, starts=3)
        parts = bounded(problem, best.durations, best.seconds)
        for gap in (0.1, 0.2, 0.3, 0.4, 0.6):
            L = best.seconds / (1.0 + gap)
            proof = Proof(begin(problem, L, parts=parts), L, record=True)
            proof.run(1000)
            if proof.proved:
                return certificate_of_proof(problem, proof)
    raise AssertionError("nothing is proved")


def _of(letter: str, certificate: Any) -> list[Any]:
    return [event for event in certificate["events"] if event[0] == letter]


def test_the_checker_proves_the_parts_and_the_whole_again(certificate: Any, tmp_path: Any) -> None:
    rows = [row for event in certificate["events"] if event[0] in "LBA" for row in event[-1] if row]
    assert len(_of("W", certificate)) > N
    assert _of("V", certificate)
    assert any(row[0] == "w" for row in rows if isinstance(row, list))
    assert outcome(tmp_path, certificate) == 0


def _head(certificate: Any, position: int) -> Any:
    return _of("W", certificate)[position]


def _raise_bound(certificate: Any) -> None:
    for head in _of("W", certificate)[:-1]:
        head[3] = (float.fromhex(head[3]) * 1.5).hex()


def _shorten_horizon(certificate: Any) -> None:
    head = _head(certificate, 0)
    head[4] = (float.fromhex(certificate["seconds"]) * 0.999).hex()


def _widen_part(certificate: Any) -> None:
    head = _head(certificate, 0)
    head[2] += 1


def _leave_out_a_tree(certificate: Any) -> None:
    events = certificate["events"]
    heads = [i for i, event in enumerate(events) if event[0] == "W"]
    longest = max(range(len(heads) - 1), key=lambda i: heads[i + 1] - heads[i])
    del events[heads[longest] + 1 : heads[longest + 1]]


def _leave_out_the_whole(certificate: Any) -> None:
    events = certificate["events"]
    last = max(i for i, event in enumerate(events) if event[0] == "W")
    del events[last:]


def _claim_the_whole_for_less(certificate: Any) -> None:
    head = _head(certificate, -1)
    head[3] = (float.fromhex(head[3]) * 0.9).hex()


def _split_a_known_velocity(certificate: Any) -> None:
    events = certificate["events"]
    at = next(i for i, event in enumerate(events) if event[0] == "W" and event[1] == 0)
    events.insert(at + 1, ["V", 0, 0, (0.0).hex()])


def _use_a_part_that_is_not_proved(certificate: Any) -> None:
    for event in certificate["events"]:
        for row in event[-1] if event[0] in "LBA" and isinstance(event[-1], list) else []:
            if row[0] == "w":
                row[1], row[2] = 0, N
                return
    raise AssertionError("no row about a part")


@pytest.mark.parametrize(
    "change",
    [
        _raise_bound, _shorten_horizon, _widen_part, _leave_out_a_tree, _leave_out_the_whole,
        _claim_the_whole_for_less, _split_a_known_velocity, _use_a_part_that_is_not_proved,
    ],
)  # fmt: skip
def test_the_checker_refuses_of_parts(
    change: Callable[[Any], None], certificate: Any, tmp_path: Any
) -> None:
    assert outcome(tmp_path, planted(change)(certificate)) == 1


def test_a_long_search_uses_parts_and_says_so_in_its_certificate(tmp_path: Any) -> None:
    problem = problem_of(6, "VAJ", dof=3)
    bound = family_bound(
        problem, gap=1e-9, time_limit=2.0, optimum=family_optimum(problem, starts=3), record=True
    )
    assert 0.0 < bound.seconds <= bound.upper
    assert bound.certificate is not None
    if bound.status != "proved":
        assert _of("W", bound.certificate)
    assert outcome(tmp_path, bound.certificate) == 0
