"""Ruckig with a full stop at each waypoint: the rung ``ruckig_stop_and_go`` as a rival."""

from __future__ import annotations

from compare.rivals.rival import RivalAnswer
from formulations import REFERENCES
from formulations.problem.problem import Problem


def ruckig_stops(problem: Problem, seconds: float) -> RivalAnswer:
    """Plan each segment from rest to rest.

    Parameters
    ----------
    problem : Problem
    seconds : float
        Not used: it takes microseconds.

    Returns
    -------
    RivalAnswer
    """
    found = REFERENCES["ruckig_stop_and_go"](problem)
    return RivalAnswer(found.trajectory, found.seconds, note=found.note)
