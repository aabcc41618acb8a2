"""The audit finds what is planted, and nothing else."""

from __future__ import annotations

import numpy as np
from printed_papers import faults, only, synthetic, times_of, truth

from compare.audit import parse_papers
from compare.audit.findings.other_limits import table_findings, total_findings
from compare.audit.findings.vectors import motion_faults
from compare.audit.motion.minima import minimum
from compare.audit.motion.printed_motion import PrintedMotion
from formulations import FAMILIES, family_optimum


def test_a_true_paper_has_no_fault_but_that_of_its_rule() -> None:
    # taking the longest times breaks the limits, here as in the papers: an oracle says so too
    problem, times = truth()
    longest = np.max(times, axis=0)
    assert FAMILIES["3-5-3"].stretch(problem, longest[None])[0] > 1.01
    assert longest.sum() < 0.99 * minimum(problem).seconds
    assert faults(synthetic()) == {
        kind: ["Table 2, last row"] for kind in ("minimum", "limits", "rule")
    }


def test_a_plan_that_shares_its_durations_has_none_at_all() -> None:
    problem, _ = truth()
    t = family_optimum(problem, starts=3).durations
    text = synthetic(TIMES="[" + ", ".join(f'"{x:.4f}"' for x in t) + "]", TOTALS=f'"{t.sum():.4f}"')
    text = text.replace("joints = [1, 2]", 'joints = ["all"]')
    text = "\n".join(line for line in text.splitlines() if not line.startswith(("longest", "total =")))
    assert faults(text) == {}


def test_a_limit_that_is_broken_is_found() -> None:
    _, times = truth()
    factors = [[1, 1, 1], [0.99, 0.99, 0.99]]
    totals = f'"{times[0].sum():.4f}", "{0.99 * times[1].sum():.4f}"'
    longest = np.maximum(times[0], 0.99 * times[1])
    text = synthetic(
        TIMES=times_of(factors),
        TOTALS=totals,
        LONGEST=", ".join(f'"{x:.4f}"' for x in longest),
        TOTAL=f"{longest.sum():.4f}",
        SHARE=f"{100.0 * (1.0 - longest.sum() / 9.0):.2f}",
    )
    assert only(text) == {"limits": ["Table 2, joint 2"], "minimum": ["Table 2, joint 2"]}


def test_a_limit_that_was_not_in_force_is_found() -> None:
    text = synthetic().replace("acceleration = [90, 70]", "acceleration = [90, 140]")
    assert only(text) == {"other limits": ["Table 2, joint 2"]}
    (paper,) = parse_papers(text, "p")
    (finding,) = motion_faults(PrintedMotion.of(paper, paper.rows[1]))
    assert "acceleration 70" in finding.text
    assert "where 140 is stated" in finding.text
    assert not finding.proved


def test_a_result_too_fast_for_the_limits_another_fits_is_found() -> None:
    _, times = truth()
    # both rows and runs were made under 90 deg/s^2, but one run was not; 180 is printed
    text = synthetic(RUN1=f"{0.99 * times[0].sum():.4f}", MEAN=f"{1.0 * times[0].sum():.4f}")
    text = text.replace("acceleration = [90, 70]", "acceleration = [180, 70]")
    assert only(text) == {"other limits": ["Table 2, joint 1"], "tables": ["Table 3, theirs"]}


def test_a_total_below_the_certified_minimum_is_found() -> None:
    _, times = truth()
    text = synthetic(RUN1=f"{0.997 * times[0].sum():.4f}", MEAN=f"{1.0035 * times[0].sum():.4f}")
    assert only(text) == {"minimum": ["Table 3, theirs"]}
    (paper,) = parse_papers(text, "p")
    (finding,) = total_findings(paper, paper.totals)
    assert "1 of 2 results" in finding.text
    assert "0.3 % below the certified minimum" in finding.text


def test_a_segment_faster_than_its_displacement_allows_is_found() -> None:
    _, times = truth()
    # 0.8 rad in the middle of joint 1 need 0.764 s at 60 deg/s
    short = times[0] * [1.0, 0.7 / times[0][1], 1.0]
    text = synthetic(
        TIMES=", ".join("[" + ", ".join(f'"{x:.4f}"' for x in t) + "]" for t in (short, times[1])),
        TOTALS=f'"{short.sum():.4f}", "{times[1].sum():.4f}"',
    )
    found = faults(text)
    assert "Table 2, joint 1" in found["displacement"]
    assert "Table 2, joint 1" in found["minimum"]


def test_methods_that_change_places_are_found() -> None:
    longest = np.max(truth()[1], axis=0)
    bad = longest * [0.6, 1.4, 0.6]  # shorter in sum, and far from feasible

    def table(where: str, t: np.ndarray) -> str:
        row = ", ".join(f'"{x:.4f}"' for x in t)
        return (
            f'[[table]]\nwhere = "{where}"\nby = "{where}"\nlimits = "Table 1"\njoints = [1, 2]\n'
            f'times = [[{row}], [{row}]]\nlongest_where = "{where}, whole"\n'
        )

    text = synthetic()
    text = text[: text.index("[[table]]")] + table("A", longest) + table("B", bad)
    assert bad.sum() < longest.sum()
    found = faults(text)
    assert found["ranking"] == ["Table 1"]


def test_results_under_common_limits_contradict_nothing() -> None:
    (paper,) = parse_papers(synthetic(), "p")
    motions = [PrintedMotion.of(paper, row) for row in paper.rows]
    assert table_findings(motions, paper.totals) == []
