"""What the tests of the family bound share: problems, checks of a bound, the checker as a function."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from compare.check_certificate import __main__ as check_certificate
from formulations import (
    CASES,
    FAMILIES,
    FamilyBound,
    FamilyOptimum,
    Limits,
    Problem,
    family_bound,
    load,
)
from formulations.proofs.family import PROVERS
from formulations.proofs.proof import Proof

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


def anyhow(problem: Problem) -> FamilyOptimum:
    """A feasible motion that is no optimum, for a proof to start from."""
    return FamilyOptimum(problem, problem.family, np.ones(problem.n_segments), ())


def as_quintic(problem: Problem) -> Problem:
    return replace(problem, family="quintic")


def closed(problem: Problem, margin: float = 0.0) -> Problem:
    """The problem with position limits at its waypoints, a margin [rad] away."""
    w, limits = problem.waypoints, problem.limits
    reach = np.stack([w.min(axis=0) - margin, w.max(axis=0) + margin + 1e-12], axis=1)
    bounds = Limits.of(limits.velocity, limits.acceleration, limits.jerk, reach, dof=problem.dof)
    return Problem.of(w, bounds, family=problem.family)


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


def outcome(tmp_path: Path, certificate: Any, *more: str) -> int:
    path = tmp_path / "certificate.json"
    path.write_text(certificate if isinstance(certificate, str) else json.dumps(certificate), "utf-8")
    return check_certificate.main([str(path), *more])


def z1_bound() -> FamilyBound:
    start = FamilyOptimum(load("z1"), "quintic", np.array([3.2, 2.5, 1.8, 3.4, 2.2, 2.2, 2.6]), ())
    return family_bound(as_quintic(load("z1")), gap=5e-10, optimum=start, record=True)


def planted(change: Callable[[Any], None]) -> Callable[[Any], Any]:
    def fault(certificate: Any) -> Any:
        changed = copy.deepcopy(certificate)
        change(changed)
        return changed

    return fault


def scaled(certificate: Any, key: str, joint: int, factor: float) -> None:
    values = certificate["limits"][key]
    values[joint] = (float.fromhex(values[joint]) * factor).hex()
