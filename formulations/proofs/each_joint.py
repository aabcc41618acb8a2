"""The optimum of every joint by itself, as the papers plan."""

from __future__ import annotations

from formulations.deadlines import Deadline
from formulations.deadlines.deadline import Stop
from formulations.optima.family.optimum import FamilyOptimum
from formulations.problem.problem import Problem
from formulations.proofs.family import proved_optimum


def each_joint_alone(
    problem: Problem,
    *,
    starts: int | None = None,
    seed: int = 0,
    time_limit: float | None = None,
    stop: Stop | None = None,
) -> tuple[FamilyOptimum | None, ...]:
    """Find the optimum of every joint by itself.

    Parameters
    ----------
    problem : Problem
        Waypoints and limits of all joints.
    starts, seed : optional
        As in ``proved_optimum``.
    time_limit, stop : optional
        As in ``proved_optimum``, for all joints together.

    Returns
    -------
    tuple of (FamilyOptimum or None), length dof
        None for a joint that does not move.

    Raises
    ------
    UnsupportedProblem
        The problem has conditions, which splines do not know.
    """
    problem.require_plain("each joint alone")
    deadline = Deadline(time_limit, stop)
    return tuple(
        proved_optimum(problem.joint(j), starts=starts, seed=seed, time_limit=deadline.left, stop=stop)[
            0
        ]
        if j in problem.moving_joints
        else None
        for j in range(problem.dof)
    )
