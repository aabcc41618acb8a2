"""Displacement: no motion is faster than its largest displacements at top speed."""

from __future__ import annotations

from formulations.problem.problem import Problem
from formulations.proofs.displacement import displacement_bound, displacement_durations
from formulations.references.reference import Outcome, Rung, RungKind


def displacement(problem: Problem) -> Outcome:
    """Bound every motion through the waypoints from below (``proofs.displacement``).

    Parameters
    ----------
    problem : Problem
        Its waypoints, velocity limits and conditions.

    Returns
    -------
    Outcome
        With the least duration of each segment.
    """
    asked = problem.conditions.without_total(problem)  # how fast it could be
    return Outcome.ok(
        displacement_bound(problem, asked),
        durations=displacement_durations(problem, asked),
        note="displacement over top speed",
    )


DISPLACEMENT = Rung(
    key="displacement",
    kind=RungKind.LOWER,
    name="displacement bound",
    meaning="no motion is faster: displacement at top speed",
    find=displacement,
    certified=True,
    knows_conditions=True,
)
