"""What a rival is, what it can be asked for, and what it answers: a motion as exact pieces, or why not."""

from __future__ import annotations

from dataclasses import dataclass, replace

from formulations import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.errors import UnsupportedProblem
from formulations.problem.problem import Problem


@dataclass(frozen=True)
class Rival:
    """Another program that times or plans a motion through waypoints.

    Attributes
    ----------
    key : str
        Its name on the command line.
    name : str
        Its name in tables and pages.
    target : str
        Its function ``(problem, seconds) -> RivalAnswer`` as ``module:function``; empty where it cannot be run.
    package : str
        Name on the package index.
    modules : tuple of str
        The modules to be loaded before the clock starts.
    optimises : str
        What it optimises.
    cannot : str
        What it cannot be asked for.
    refusal : str
        Why it is not run at all; empty for those that are.
    zones : bool
        Whether it passes inner waypoints within zones, and cannot pass them exactly.
    """

    key: str
    name: str
    target: str
    package: str
    modules: tuple[str, ...]
    optimises: str
    cannot: str
    refusal: str = ""
    zones: bool = False


@dataclass(frozen=True)
class RivalAnswer:
    """What a rival answers.

    Attributes
    ----------
    motion : Trajectory or None
        Exact pieces of its motion; None where it has found none.
    claimed : float or None
        The time that the program itself states [s].
    bound : float or None
        The lower bound that the program itself states for its own program [s].
    note : str
        One line.
    """

    motion: Trajectory | None
    claimed: float | None = None
    bound: float | None = None
    note: str = ""


def moving_waypoints(problem: Problem) -> Array:
    """Return the waypoints without those that repeat the one before, which no path parameter tells apart.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    Array, shape (n, dof) [rad]
    """
    moves = (problem.displacements != 0.0).any(axis=1)
    return problem.waypoints[[True, *moves.tolist()]]


def require_askable(problem: Problem, rival: Rival) -> None:
    """Refuse a task that a program cannot be asked for.

    Parameters
    ----------
    problem : Problem
        Without zones, where the program knows none.
    rival : Rival

    Raises
    ------
    UnsupportedProblem
        The message says what cannot be asked for.
    """
    if not rival.zones:
        problem.require_plain(rival.name)
        return
    if problem.n_segments > 1 and not problem.conditions.tolerance:
        raise UnsupportedProblem(
            f"{rival.name}: passes no inner waypoint exactly; see the task with zones"
        )
    plain = replace(problem, conditions=replace(problem.conditions, tolerance={}))
    plain.require_plain(rival.name)


def has_zones(problem: Problem) -> bool:
    """Say whether a task has waypoints that may be passed within a zone.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    bool
    """
    return bool(problem.conditions.boxes(problem.dof))


def without_zones(problem: Problem) -> Problem:
    """Return the task whose motions pass the points exactly: they are motions of the task with zones too.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    Problem
    """
    return replace(problem, conditions=replace(problem.conditions, tolerance={}, tool_zones={}))
