"""How many waypoints the searches take: more are refused at once, not worked on for hours."""

from __future__ import annotations

from formulations.problem.errors import UnsupportedProblem
from formulations.problem.problem import Problem

MOST_WAYPOINTS = 2000


def require_moderate(problem: Problem) -> None:
    """Refuse a problem with too many waypoints.

    Parameters
    ----------
    problem : Problem

    Raises
    ------
    UnsupportedProblem
        In one line, with the number there is and the number that is allowed.
    """
    n = problem.n_segments + 1
    if n > MOST_WAYPOINTS:
        raise UnsupportedProblem(
            f"waypoints: {n} are too many for an optimum, at most {MOST_WAYPOINTS}: so many are a path whose "
            "timing is wanted; give those that the motion has to pass"
        )
