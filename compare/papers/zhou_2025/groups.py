"""Zhou 2025, sec. 4.2, step 1: one flock that makes both kinds of moves, or two groups."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.benchmark.grade import Graded
from compare.papers.item import Table
from compare.papers.measure import judged, summary, trials
from compare.papers.verdicts import Reproduction, more_often, pairs_won, same_times
from compare.papers.zhou_2025.paper import BUDGET
from formulations import Problem, longest_segment

READINGS = {"one": "one flock", "two": "two groups"}


def make_groups(problem: Problem, one: Sequence[Sequence[Graded]]) -> dict[str, Any]:
    """Search each joint with two groups, beside the runs with one flock.

    Parameters
    ----------
    problem : Problem
        The whole arm.
    one : sequence of (sequence of Graded)
        Runs of ISSA with one flock, by joint.

    Returns
    -------
    dict
        Per reading: found (a summary of each joint's runs), arm (the longest time per segment, judged).
    """
    two = [
        trials(problem.joint(j), "issa", BUDGET, len(runs), two_groups=True)
        for j, runs in enumerate(one)
    ]
    read = {}
    for name, by_joint in (("one", one), ("two", two)):
        found = [summary(runs) for runs in by_joint]
        rule = longest_segment(problem, [np.array(f["durations"]) for f in found])
        read[name] = {"found": found, "arm": judged(problem, rule.claimed)}
    return read


def groups_table(groups: dict[str, Any], bounds: Sequence[float], printed: Sequence[float]) -> Table:
    """Show both readings joint by joint: medians, and their gaps to the certified optimum.

    Parameters
    ----------
    groups : dict
        Of ``make_groups``.
    bounds : sequence of float [s]
        Certified optima of the joints, then of the arm.
    printed : sequence of float [s]
        Printed sums, in the same order.

    Returns
    -------
    Table
    """
    lines = []
    for j, bound in enumerate(bounds[:-1]):
        medians = [groups[name]["found"][j]["median"] for name in READINGS]
        gaps = [f"{median / bound - 1.0:.1e}" for median in medians]
        one, two = (groups[name]["found"][j]["by_seed"] for name in READINGS)
        lines.append([f"joint {j + 1}", f"{printed[j]:.3f}", *(f"{m:.4f}" for m in medians),
                      f"{bound:.4f}", *gaps, f"{pairs_won(two, one):g} of {len(one)}"])  # fmt: skip
    seconds = [groups[name]["arm"]["seconds"] for name in READINGS]
    lines.append(["longest per segment", f"{printed[-1]:.3f}", *(f"{s:.4f}" for s in seconds),
                  f"{bounds[-1]:.4f}", "", "", ""])  # fmt: skip
    header = ["sums [s]", "printed", *READINGS.values(), "certified least",
              *(f"gap, {title}" for title in READINGS.values()), "two groups lower"]  # fmt: skip
    caption = (
        "Sec. 4.2, step 1: ISSA with one flock and with two groups, medians of as many runs with as many "
        "evaluations; a tie counts half."
    )
    return Table(header, lines, caption, range(1, 8))


def groups_remark(groups: dict[str, Any], printed: Sequence[float], impossible: Sequence[bool]) -> str:
    """Say whether the other reading of step 1 ends lower, and whether it explains the printed times.

    Parameters
    ----------
    groups : dict
        Of ``make_groups``.
    printed : sequence of float [s]
        Printed sums of the joints, then of the arm.
    impossible : sequence of bool
        Whether each is proved to be too short for the limits.

    Returns
    -------
    str
        A remark of the page.
    """
    one, two = ([s for f in groups[name]["found"] for s in f["by_seed"]] for name in READINGS)
    won, n = pairs_won(two, one), len(one)
    outcome = times_by_two_groups(groups, printed, impossible)
    return (
        f"Sec. 4.2, step 1: with two groups ISSA ends lower than with one flock in {won:g} of {n} "
        f"pairs of runs, {more_often(won / n, n)}. By that reading, too, the times of Table "
        f"6 are {outcome.inside}."
    )


def times_by_two_groups(
    groups: dict[str, Any], printed: Sequence[float], impossible: Sequence[bool]
) -> Reproduction:
    """Judge the printed times by the runs with two groups.

    Parameters
    ----------
    groups : dict
        Of ``make_groups``.
    printed : sequence of float [s]
        Printed sums of the joints, then of the arm.
    impossible : sequence of bool
        Whether each is proved to be too short for the limits.

    Returns
    -------
    Reproduction
    """
    found = [f["median"] for f in groups["two"]["found"]] + [groups["two"]["arm"]["seconds"]]
    return same_times(printed, found, impossible)
