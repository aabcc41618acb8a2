"""Papers made for the tests of the audit: true ones, and ones with planted faults."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

import numpy as np

from compare.audit import Paper, audit, parse_papers
from formulations import Limits, Problem, family_optimum

DEG = np.pi / 180.0


def one_joint(
    waypoints: Iterable[str],
    times: Iterable[str],
    total: str,
    *,
    velocity: str,
    acceleration: str,
    unit: str = "rad",
    position: str = "",
) -> Paper:
    """A paper of one joint, every number as it stands: "90" with its quotes is rounded, 90 is exact."""
    shown = ", ".join(times)
    return parse_papers(
        f"""
family = "3-5-3"
limited = ["velocity", "acceleration"]
[waypoints]
unit = "rad"
rows = [{", ".join(f"[{x}]" for x in waypoints)}]
[[limits]]
name = "T"
unit = "{unit}"
velocity = [{velocity}]
acceleration = [{acceleration}]
{position}
[[table]]
where = "R"
limits = "T"
joints = [1]
times = [[{shown}]]
totals = [{total}]
[[totals]]
where = "S"
limits = "T"
joint = 1
values = [{total}]
""",
        "true",
    )[0]


@cache
def truth() -> tuple[Problem, list[np.ndarray]]:
    """Two joints, four waypoints, limits in deg: each joint's own optimum."""
    w = np.array([[0.1, -0.5], [0.5, -0.2], [1.3, 0.6], [1.6, 1.2]])
    problem = Problem.of(w, Limits.of([60 * DEG, 80 * DEG], [90 * DEG, 70 * DEG], dof=2))
    return problem, [family_optimum(problem.joint(j), starts=3).durations for j in range(2)]


TRUE = """
family = "3-5-3"
arm = "ARM"
limited = ["velocity", "acceleration"]
[waypoints]
unit = "rad"
rows = [["0.1000", "-0.5000"], ["0.5000", "-0.2000"], ["1.3000", "0.6000"], ["1.6000", "1.2000"]]
[[limits]]
name = "Table 1"
unit = "deg"
velocity = [60, 80]
acceleration = [90, 70]
[[table]]
where = "Table 2"
by = "ours"
limits = "Table 1"
joints = [1, 2]
times = [TIMES]
totals = [TOTALS]
longest = [LONGEST]
longest_where = "Table 2, last row"
total = "TOTAL"
[[totals]]
where = "Table 3"
by = "theirs"
limits = "Table 1"
joint = 1
values = ["RUN1", "RUN2"]
mean = "MEAN"
[[claim]]
where = "sec. 4"
says = "shorter than 9 s"
rule = "reduction"
of = [9, "TOTAL"]
equals = "SHARE"
"""


def synthetic(**planted: str) -> str:
    """A paper whose numbers are true, but for those that are given."""
    _, times = truth()
    longest = np.max(times, axis=0)

    def row(t: np.ndarray) -> str:
        return "[" + ", ".join(f'"{x:.4f}"' for x in t) + "]"

    best = times[0].sum()
    words = {
        "TIMES": ", ".join(row(t) for t in times),
        "TOTALS": ", ".join(f'"{t.sum():.4f}"' for t in times),
        "LONGEST": row(longest)[1:-1],
        "TOTAL": f"{longest.sum():.4f}",
        "RUN1": f"{1.03 * best:.4f}",
        "RUN2": f"{1.01 * best:.4f}",
        "MEAN": f"{1.02 * best:.4f}",
        "SHARE": f"{100.0 * (1.0 - longest.sum() / 9.0):.2f}",
    }
    text = TRUE.replace('arm = "ARM"\n', "")
    for word, value in (words | planted).items():
        text = text.replace(word, value)
    return text


def faults(text: str) -> dict[str, list[str]]:
    """Kinds of fault in a paper, and where."""
    (paper,) = parse_papers(text, "synthetic")
    found: dict[str, list[str]] = {}
    for finding in audit(paper).faults:
        found.setdefault(finding.kind, []).append(finding.where)
    return found


def times_of(factors: list[list[float]]) -> str:
    """Rows of the true times, times factors per joint and segment."""
    _, times = truth()
    return ", ".join(
        "[" + ", ".join(f'"{x:.4f}"' for x in t * np.array(f)) + "]"
        for t, f in zip(times, factors, strict=True)
    )


def only(text: str) -> dict[str, list[str]]:
    """Kinds and places, less what the rule does of its own."""
    return {
        kind: kept
        for kind, where in faults(text).items()
        if kind != "rule" and (kept := [place for place in where if place != "Table 2, last row"])
    }
