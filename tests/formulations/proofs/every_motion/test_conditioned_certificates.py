"""What the prover writes down under conditions, the checker certifies; more than that it refuses."""

from __future__ import annotations

import json
from contextlib import suppress
from math import inf
from typing import Any

import numpy as np
import pytest
from tool_problems import random_chain

from compare.check_certificate.answers import Refused
from compare.check_certificate.verify import verify
from formulations import Conditions, Limits, NoFeasibleMotion, Problem, free_form, free_form_bound

FREE = ("start_velocity", "end_velocity", "start_acceleration", "end_acceleration")


def asked(kind: str, rng: np.random.Generator) -> tuple[Problem, Conditions]:
    """A random problem with conditions of one kind."""
    n, dof = int(rng.integers(2, 5)), int(rng.integers(1, 4))
    steps = rng.normal(size=(n + 1, dof)) * 10.0 ** rng.uniform(-1.0, 0.0)
    points = np.cumsum(steps, axis=0)
    if kind == "cyclic":
        points[-1] = points[0]
    V, A, J = (rng.uniform(low, high, dof) for low, high in ((0.5, 2.0), (1.0, 4.0), (4.0, 20.0)))
    position = np.stack([points.min(axis=0) - 0.05, points.max(axis=0) + 0.05], axis=1)
    limits: dict[str, Any] = {"velocity": V, "acceleration": A, "jerk": J, "position": position}
    inner = range(1, n)
    given: dict[str, dict[str, Any]] = {
        "zones": {"tolerance": {i: np.full(dof, 0.02) for i in inner}},
        "windows": {"windows": {i: (1.5 * i, inf if i % 2 else 9.0 * i) for i in range(1, n + 1)}},
        "times": {"segment_times": {k: (float(rng.uniform(0.0, 2.0)), 9.0) for k in range(n)}},
        "waits": {
            "waits": dict.fromkeys(inner, 0.4),
            "tolerance": {i: np.full(dof, 0.1) for i in inner},
        },
        "stops": {"stops": frozenset({1})},
        "cyclic": {"cyclic": True},
        "free ends": dict.fromkeys(FREE, "free"),
        "given ends": {"start_velocity": 0.3 * V, "end_acceleration": -0.3 * A},
        "limits of a segment": {
            "segment_limits": {0: Limits.of(V / 2, A / 2, 0.7 * J, position, dof=dof)}
        },
        "limits by direction": {},
        "tool": {"tool_speed": 2.0, "segment_tool_speed": {1: 0.5}, "tool_zones": {1: 0.01}},
    }
    if kind == "limits by direction":
        limits |= {"velocity": np.stack([-V, 0.6 * V], axis=1)}
        limits |= {"acceleration": np.stack([-0.5 * A, A], axis=1)}
    tool = random_chain(rng, dof, dof + 1) if kind == "tool" else None
    return Problem(points, Limits.of(**limits, dof=dof), tool=tool), Conditions(**given[kind])


KINDS = (
    *("windows", "zones", "times", "waits", "stops", "cyclic", "free ends", "given ends"),
    *("limits of a segment", "limits by direction", "tool"),
)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.long)])
def test_a_proof_under_conditions_is_certified(kind: str, seed: int) -> None:
    problem, conditions = asked(kind, np.random.default_rng(seed))
    upper = None
    if kind != "tool":  # its fastest motion takes longer to find than the proof
        with suppress(NoFeasibleMotion):  # the random ends may not be possible
            upper = free_form(problem, conditions=conditions).seconds
    bound = free_form_bound(
        problem, conditions=conditions, gap=1e-2, upper=upper, time_limit=5.0, record=True
    )
    data = json.loads(json.dumps(bound.certificate))
    seconds = float.fromhex(data["seconds"])
    assert 0.0 < seconds <= bound.seconds * (1.0 + 1e-9)
    assert verify(data).startswith("no motion of 'problem' with ")
    data["seconds"] = data["horizon"] = (3.0 * seconds).hex()
    with pytest.raises(Refused):
        verify(data)
