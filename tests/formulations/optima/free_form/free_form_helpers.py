"""What the tests of the free-form motion share: problems and a few short ways to their answers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from formulations import REFERENCES, Limits, Problem, Trajectory, load
from formulations.optima.free_form import FreeForm

UR5, SR4C, Z1 = load("ur5"), load("sr4c"), load("z1")
JERKY = replace(
    SR4C,
    name="sr4c, jerk",
    limits=Limits.of(
        SR4C.limits.velocity,
        SR4C.limits.acceleration,
        5.0 * SR4C.limits.acceleration,
        SR4C.limits.position,
        dof=6,
    ),
)
# all four from arcs 7 to 24 per segment, IPOPT and HiGHS; the digits that they agree in
OPTIMA = [(UR5, 14.7678659), (SR4C, 2.9975817), (JERKY, 3.2060593), (Z1, 12.9586047)]
SLOW = Limits.of(0.5 * UR5.limits.velocity, UR5.limits.acceleration, UR5.limits.jerk, dof=6)
DRIFT = np.array([-0.1, -0.2, 0.0, 0.1, 0.0, -0.3])


def motion(found: FreeForm) -> Trajectory:
    assert found.trajectory is not None
    return found.trajectory


def drawn(seed: int, segments: int, limits: Limits) -> Problem:
    rng = np.random.default_rng(seed)
    return Problem.of(rng.uniform(-2.5, 2.5, (segments + 1, len(limits.velocity))), limits)


def seconds_of(outcome: str, problem: Problem) -> float:
    found = REFERENCES[outcome](problem).seconds
    return math.inf if found is None else found
