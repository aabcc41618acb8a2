"""True results that are rounded are never accused; results that are a little too short are."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from printed_papers import one_joint

from compare.audit import Finding, Paper
from compare.audit.findings.claims import claims_of
from compare.audit.findings.other_limits import total_findings
from compare.audit.findings.vectors import motion_faults
from compare.audit.motion.minima import minimum
from compare.audit.motion.printed_motion import PrintedMotion
from compare.audit.motion.ranged import Undecided
from formulations import Limits, Problem


@cache
def optima() -> list[tuple[Problem, np.ndarray]]:
    """True optima of one joint under velocity and acceleration limits: problems and durations."""
    rng, found = np.random.default_rng(11), []
    for _ in range(20):
        w = np.cumsum(rng.uniform(-1.0, 1.0, (4, 1)), axis=0)
        limits = Limits.of(rng.uniform(0.5, 2.0), rng.uniform(0.5, 3.0), dof=1)
        problem = Problem.of(w, limits)
        proved = minimum(problem)
        assert proved.durations is not None
        assert proved.gap < 2e-5
        found.append((problem, proved.durations))
    return found


def paper_of(
    w: np.ndarray,
    v: float,
    a: float,
    t: np.ndarray,
    digits: tuple[int, int],
) -> Paper:
    """A paper that prints a motion of one joint to so many digits of rad and s."""
    rad, sec = digits
    return one_joint(
        (f'"{x:.{rad}f}"' for x in w[:, 0]),
        (f'"{x:.{sec}f}"' for x in t),
        f'"{t.sum():.{sec}f}"',
        velocity=repr(v),
        acceleration=repr(a),
    )


def verdicts(paper: Paper) -> list[Finding]:
    """Every verdict on time vectors and totals."""
    motions = [PrintedMotion.of(paper, row) for row in paper.rows]
    found = [finding for motion in motions for finding in motion_faults(motion)]
    return found + claims_of(paper) + total_findings(paper, paper.totals)


@pytest.mark.long
def test_rounding_alone_never_makes_a_verdict() -> None:
    rng = np.random.default_rng(17)
    naive = unreadable = 0
    for run in range(1000):
        problem, t = optima()[run % len(optima())]
        # the same optimum on other scales of angle and time, elsewhere: other digits
        x, s = rng.uniform(0.3, 3.0), rng.uniform(0.3, 3.0)
        w = x * problem.waypoints + rng.uniform(-2.0, 2.0)
        v = float(problem.limits.velocity[0]) * x / s
        a = float(problem.limits.acceleration[0]) * x / s**2
        digits = [(4, 4), (3, 3), (2, 2)][run % 3]
        paper = paper_of(w, v, a, s * t, digits)
        try:
            motion = PrintedMotion.of(paper, paper.rows[0])
        except Undecided as reason:
            unreadable += "printed as 0.00" in str(reason)
            continue
        naive += motion.verdict.stretch > 1.0 + 1e-9
        accused = [finding for finding in verdicts(paper) if finding.fault]
        assert not accused, (run, digits, accused)
    assert naive > 300  # who takes the digits at their word accuses a third of them
    assert 0 < unreadable < 30


def test_the_same_results_a_little_too_short_are_accused() -> None:
    for run, (problem, t) in enumerate(optima()[:6]):
        v, a = float(problem.limits.velocity[0]), float(problem.limits.acceleration[0])
        short = t * 0.995
        found = verdicts(paper_of(problem.waypoints, v, a, short, (5, 5)))
        kinds = {finding.kind for finding in found if finding.fault}
        assert {"limits", "minimum"} <= kinds, (run, found)
