"""What a rival is, and what its function returns: a motion as exact pieces, or the reason why there is none."""

from __future__ import annotations

from dataclasses import dataclass

from formulations import Trajectory
from formulations.problem.arrays import Array
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
