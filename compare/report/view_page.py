"""The page of one problem, or of one motion beside its problem: what ``timebound view`` opens."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from compare.report.asked_words import sentences
from compare.report.charts.case_motions import judged
from compare.report.charts.ladder import ladder_chart
from compare.report.charts.motions import ShownMotion, arm_chart, motions_chart
from compare.report.frame import CHARTS, environment
from compare.report.judged import FoundTable, fault_tables, holding, opening
from compare.report.view_answers import answers_of, headline, what_is_wrong
from compare.report.viewed import Viewed
from formulations import RUNGS, Limits, Problem
from formulations.assessment import Assessment
from formulations.motion.verdict import QUANTITIES
from formulations.problem.joint_words import factors, shown_unit

_OF = "view"  # under which the charts of the page are found


def view_page(viewed: Viewed) -> str:
    """Return the page as HTML that needs nothing else.

    Parameters
    ----------
    viewed : Viewed

    Returns
    -------
    str
    """
    problem, given, record = viewed.problem, viewed.given, viewed.record
    charts = {"ladder": ladder_chart(record, more=_more_lines(viewed))}
    motions = _motions(viewed)
    if motions:
        charts["motion"] = motions_chart(problem, motions, viewed.conditions)
        worst = [] if given is None else [one.joint for one in given.judgement.violations]
        if any(joint >= 0 for joint in worst):  # the joint to be shown first; the tool is none
            charts["motion"]["first"] = next(joint for joint in worst if joint >= 0)
        if viewed.arm is not None and viewed.arm.dof == problem.dof:
            charts["arm"] = arm_chart(viewed.arm, motions, problem, viewed.conditions)
    context = {
        "scripts": CHARTS,
        "charts": {_OF: charts},
        "of": _OF,
        "problem": problem,
        "case": problem.name,
        "ladders": {problem.name: record},
        "meanings": {key: rung.meaning for key, rung in RUNGS.items()},
        "headline": headline(viewed),
        "answers": answers_of(viewed),
        "file": viewed.file,
        "given": given,
        "opening": [] if given is None else opening(given),
        "faults": [] if given is None else [*fault_tables(given), *_unkept(given)],
        "held": None if given is None else holding(given),
        "conditions": sentences(viewed.problem, viewed.conditions),
        "limits": limits_table(problem, problem.limits),
        "segment_limits": [
            (f"From waypoint {k + 1} to {k + 2}", limits_table(problem, limits))
            for k, limits in sorted(viewed.conditions.segment_limits.items())
        ],
        "waypoints": waypoints_table(problem),
        "remarks": viewed.remarks,
        "versions": record["versions"],
    }
    return environment(Path()).get_template("view.html.j2").render(context)


def _unkept(given: Assessment) -> list[FoundTable]:
    """Times, waits and cycles that are not kept, if there are any."""
    lines = [[line] for line in given.judgement.unkept]
    return [FoundTable(["condition that is not kept"], lines, ())] if lines else []


def limits_table(problem: Problem, limits: Limits) -> FoundTable:
    """Return the limits of each joint in the problem's units.

    Parameters
    ----------
    problem : Problem
        Its names and units.
    limits : Limits
        Of the whole motion, or of a segment.

    Returns
    -------
    FoundTable
    """
    scales = factors(problem.units, problem.display_unit)
    units = [
        [shown_unit(unit, problem.display_unit, order) for unit in problem.units] for order in range(4)
    ]
    heads = [
        f"{name} [{names[0]}]" if len(set(names)) == 1 else name
        for name, names in zip(QUANTITIES, units, strict=True)
    ]
    rows = []
    for j in range(problem.dof):
        low, high = limits.position[j] / scales[j]
        unlimited = np.isinf(low) and np.isinf(high)
        cells = ["none" if unlimited else f"{low:.6g} to {high:.6g}"]
        cells += [_limit(*interval) for interval in limits.ranges[:, j] / scales[j]]
        rows.append([_label(problem, j)])
        for order, cell in enumerate(cells):
            alone = len(set(units[order])) == 1 or cell == "none"
            rows[-1].append(cell if alone else f"{cell} {units[order][j]}")
    return FoundTable(["joint", *heads], rows, (1, 2, 3, 4))


def _limit(low: float, high: float) -> str:
    if np.isinf(low) and np.isinf(high):
        return "none"
    return f"{high:.6g}" if low == -high else f"{low:.6g} to {high:.6g}"


def waypoints_table(problem: Problem) -> FoundTable:
    """Return the waypoints in the problem's units.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    FoundTable
        A row per waypoint, counted from 1.
    """
    shown = problem.waypoints / factors(problem.units, problem.display_unit)
    heads = [
        f"{_label(problem, j)} [{shown_unit(problem.units[j], problem.display_unit)}]"
        for j in range(problem.dof)
    ]
    rows = [[f"{k}", *(f"{value:.6g}" for value in row)] for k, row in enumerate(shown, start=1)]
    return FoundTable(["waypoint", *heads], rows, tuple(range(1, problem.dof + 1)))


def _label(problem: Problem, joint: int) -> str:
    return f"{joint + 1} {problem.names[joint]}" if problem.names else f"{joint + 1}"


def _motions(viewed: Viewed) -> list[ShownMotion]:
    """The given motion, the best spline of the family, the fastest motion: those that there are."""
    problem, found = viewed.problem, []
    if viewed.given is not None:
        motion = viewed.given.judgement.motion
        title = f"{viewed.file}, {motion.seconds:.4f} s, {what_is_wrong(viewed.given)}"
        found.append(ShownMotion("given", title, motion))
    spline, fastest = viewed.ladder.trajectories.get("family"), viewed.fastest
    if spline is not None:
        title = f"best {problem.family} spline, {judged(problem, spline)}"
        found.append(ShownMotion("family", title, spline))
    if fastest is not None and fastest is not spline:
        said = f"{fastest.seconds:.4f} s, keeps limits and conditions"
        title = "fastest motion, " + (said if viewed.is_conditional else judged(problem, fastest))
        found.append(ShownMotion("fastest", title, fastest))
    return found


def _more_lines(viewed: Viewed) -> Sequence[dict[str, Any]]:
    """Lines of the ladder beyond its rungs: the given motion, as it is and mended; that of the conditions."""
    lines: list[tuple[str, float, str]] = []
    given = viewed.given
    if given is not None:
        found = given.judgement
        if found.feasible:
            lines.append((viewed.file, found.seconds, "given"))
        else:
            lines.append((viewed.file, found.seconds, "faulty"))
            if np.isfinite(found.stretch):
                name = f"{viewed.file}, slowed down by {found.stretch:.4g}"
                lines.append((name, found.stretch * found.seconds, "given"))
    if viewed.is_conditional and viewed.seconds is not None:
        lines.append(("motion under the conditions", viewed.seconds, "upper"))
    if viewed.is_conditional and viewed.bound and viewed.conditions.total is None:
        lines.append(("bound under the conditions", viewed.bound, "lower"))
    return [
        {"name": name, "seconds": seconds, "kind": kind, "first": True} for name, seconds, kind in lines
    ]
