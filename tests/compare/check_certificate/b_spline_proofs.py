"""Small B-spline problems with their certificates, and the checker as a function."""

from __future__ import annotations

import copy
from functools import cache
from typing import Any

import numpy as np

from compare.check_certificate.answers import BadInput, Refused
from compare.check_certificate.verify import verify
from formulations import Limits, Problem, family_bound

# name: degree, segments, joints, limits (V, A, J, P), relative gap, seed
CASES: dict[str, tuple[int, int, int, str, float, int]] = {
    "both": (5, 3, 2, "VA", 0.02, 1),
    "cubic": (3, 3, 2, "VA", 0.03, 2),
    "speed": (5, 3, 1, "V", 0.05, 3),
    "jerk": (5, 3, 2, "VAJ", 0.05, 4),
    "cubic-jerk": (3, 4, 1, "VAJ", 0.05, 5),
    "walls": (5, 3, 3, "VAP", 0.05, 10),
    "cubic-walls": (3, 3, 2, "VAP", 0.05, 3),
    "four": (5, 4, 2, "VA", 0.05, 8),
}


def problem(name: str) -> Problem:
    degree, n, dof, kind, _, seed = CASES[name]
    rng = np.random.default_rng(seed)
    d = rng.uniform(0.2, 1.5, (n, dof)) * rng.choice([-1.0, 1.0], (n, dof))
    waypoints = np.vstack([np.zeros(dof), np.cumsum(d, axis=0)])
    walls = np.stack([waypoints.min(axis=0) - 0.06, waypoints.max(axis=0) + 0.06], axis=1)
    limits = Limits.of(
        rng.uniform(0.8, 1.5, dof),
        rng.uniform(1.0, 3.0, dof) if "A" in kind else np.inf,
        rng.uniform(1.0, 2.0, dof) if "J" in kind else np.inf,
        walls if "P" in kind else (-np.inf, np.inf),
        dof=dof,
    )
    return Problem.of(waypoints, limits, family=f"b-spline-{degree}")


@cache
def _certificate(name: str) -> dict[str, Any]:
    bound = family_bound(problem(name), gap=CASES[name][4], time_limit=60.0, record=True)
    assert bound.certificate is not None
    assert bound.certificate["events"]
    return bound.certificate


def certificate(name: str) -> dict[str, Any]:
    """A certificate of its own, to be spoilt."""
    return copy.deepcopy(_certificate(name))


def answer(data: Any) -> str:
    """certified, refused or bad."""
    try:
        verify(data)
    except Refused:
        return "refused"
    except BadInput:
        return "bad"
    return "certified"
