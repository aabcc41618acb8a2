"""Limits printed as rounded digits: every verdict holds for each limit that prints like them."""

from __future__ import annotations

import numpy as np
import pytest
from printed_papers import DEG, one_joint

from compare.audit import Finding, Paper, audit, parse_papers
from compare.audit.findings.claims import claims_of
from compare.audit.findings.other_limits import table_findings, total_findings
from compare.audit.findings.together import ranking_findings, rule_findings
from compare.audit.findings.vectors import motion_faults
from compare.audit.motion.minima import minimum
from compare.audit.motion.printed_motion import PrintedMotion
from formulations import Limits, Problem


def paper_of(w: np.ndarray, times: np.ndarray, **limits: str) -> Paper:
    """A paper of one joint; the limits stand as they are given: 90 is exact, "90" is rounded."""
    return one_joint(
        (f'"{x:.6f}"' for x in w), (f'"{t:.6f}"' for t in times), f'"{times.sum():.6f}"', **limits
    )


def faults(paper: Paper) -> list[Finding]:
    """Everything that is called wrong about a paper's vectors and totals."""
    motions = [PrintedMotion.of(paper, row) for row in paper.rows]
    found = [finding for motion in motions for finding in motion_faults(motion)]
    found += claims_of(paper) + total_findings(paper, paper.totals)
    found += table_findings(motions, paper.totals) + ranking_findings(motions)
    for motion in motions:
        if motion.row.of:
            found += rule_findings(motion, motions)
    return [finding for finding in found if finding.fault]


W = np.array([0.0, 0.4, 1.2, 1.5])


def optimum(velocity: float, acceleration: float) -> np.ndarray:
    """Durations of the optimum of W under limits in rad."""
    found = minimum(Problem.of(W[:, None], Limits.of(velocity, acceleration, dof=1)))
    assert found.durations is not None
    return found.durations


def test_an_honest_optimum_under_120_deg_is_not_accused_when_2_09_rad_is_printed() -> None:
    times = optimum(9.0, 120 * DEG)  # 120 deg/s^2 are 2.0944 rad/s^2
    rounded = paper_of(W, times, velocity="9", acceleration='"2.09"')
    assert faults(rounded) == []
    row = audit(rounded).rows()[0]
    assert row.feasible == "within rounding"
    assert row.stretch_low is not None
    assert row.stretch_high is not None
    assert row.stretch_low <= 1.0 <= row.stretch_high
    # as exact numbers the same digits do accuse it
    exact = paper_of(W, times, velocity="9", acceleration="2.09")
    assert {finding.kind for finding in faults(exact)} == {"limits", "minimum"}


def test_a_result_beyond_every_reading_of_the_limit_is_still_accused() -> None:
    times = optimum(9.0, 2.105)  # "2.09" is 2.095 at most
    found = {f.kind: f for f in faults(paper_of(W, times, velocity="9", acceleration='"2.09"'))}
    assert {"limits", "minimum"} <= set(found)
    assert "the limit of 2.09 rad/s^2" in found["limits"].text


def test_displacement_is_held_against_the_highest_speed_that_prints_alike() -> None:
    # 0.8 rad in 0.7625 s are 1.0492 rad/s on average: beyond 1.04, within what prints as "1.0"
    times = np.array([1.2, 0.8 / 1.0492, 1.2])
    kinds = {
        speed: {f.kind for f in faults(paper_of(W, times, velocity=speed, acceleration='"90"'))}
        for speed in ("1.04", '"1.0"')
    }
    assert "displacement" in kinds["1.04"]
    assert "displacement" not in kinds['"1.0"']


def test_position_limits_have_half_digits_too() -> None:
    times = np.array([0.3, 1.4, 0.3])  # swings to 1.92671 beyond its last waypoint

    def kinds(high: str) -> set[str]:
        position = f"position = [[-9, {high}]]"
        paper = paper_of(W, times, velocity="9", acceleration="99", position=position)
        return {f.kind for f in faults(paper)}

    assert kinds("1.92") == kinds('"1.92"') == {"limits"}  # "1.92" is 1.925 at most
    assert kinds("1.9") == {"limits"}
    assert kinds('"1.9"') == set()
    assert kinds("1.93") == set()


def test_other_limits_are_not_inferred_from_a_limit_that_may_print_so() -> None:
    # made under 1.46 rad/s^2, "1.5" is printed: from 1.45 on the print explains it
    times = optimum(9.0, 1.46)
    exact = paper_of(W, times, velocity="9", acceleration="1.54")
    rounded = paper_of(W, times, velocity="9", acceleration='"1.5"')
    assert [f.kind for f in faults(exact)] == ["other limits"]
    assert faults(rounded) == []


def test_the_rule_is_held_against_the_highest_limits_that_print_alike() -> None:
    def paper(limit: str) -> Paper:
        times = '[["1.0000", "1.0000", "1.0000"], ["1.0000", "1.0000", "1.0000"]]'
        return parse_papers(
            f"""
family = "3-5-3"
limited = ["velocity", "acceleration"]
[waypoints]
unit = "rad"
rows = [[0, 0], [0.4, 0.3], [1.2, 0.9], [1.5, 1.3]]
[[limits]]
name = "T"
unit = "rad"
velocity = [99, 99]
acceleration = [{limit}, 99]
[[table]]
where = "R"
limits = "T"
joints = [1, 2]
times = {times}
longest = ["0.9500", "0.9500", "0.9500"]
""",
            "rule",
        )[0]

    def kinds(limit: str) -> set[str]:
        p = paper(limit)
        motions = [PrintedMotion.of(p, row) for row in p.rows]
        return {f.kind for f in rule_findings(motions[-1], motions)}

    alone, together = (PrintedMotion.of(p, p.rows[i]).peaks[0] for p in [paper("99")] for i in (0, 2))
    # "2.9" is 2.95 at most, "3" up to 3.5
    assert alone.high[1] < 2.8
    assert 2.95 < together.low[1] < together.high[1] < 3.01
    assert kinds("2.9") == kinds('"2.9"') == kinds("3") == {"rule"}
    assert kinds('"3"') == set()


@pytest.mark.long
def test_rounded_limits_alone_never_make_a_verdict() -> None:
    rng, optima = np.random.default_rng(23), []
    for _ in range(20):
        w = np.cumsum(rng.uniform(-1.0, 1.0, (4, 1)), axis=0)
        problem = Problem.of(w, Limits.of(rng.uniform(0.5, 2.0), rng.uniform(0.5, 3.0), dof=1))
        found = minimum(problem)
        assert found.durations is not None
        optima.append((problem, found.durations))
    naive = 0
    for run in range(1000):
        problem, t = optima[run % len(optima)]
        # the same optimum on other scales of angle and time: other digits of the limits
        x, s = rng.uniform(0.3, 3.0), rng.uniform(0.3, 3.0)
        v = float(problem.limits.velocity[0]) * x / s
        a = float(problem.limits.acceleration[0]) * x / s**2
        digits = (1, 2, 3)[run % 3]
        unit, scale = (("rad", 1.0), ("deg", DEG))[run % 2]
        shown = [f'"{limit / scale:.{digits}f}"' for limit in (v, a)]
        if any(float(text.strip('"')) == 0.0 for text in shown):
            continue
        paper = paper_of(
            x * problem.waypoints[:, 0], s * t,
            velocity=shown[0], acceleration=shown[1], unit=unit,
        )  # fmt: skip
        motion = PrintedMotion.of(paper, paper.rows[0])
        naive += motion.verdict.stretch > 1.0 + 1e-5
        found_faults = faults(paper)
        assert not found_faults, (run, shown, unit, found_faults)
    assert naive > 300  # taken as exact, the printed limits accuse a third of them
