"""Why there is no motion: the conditions that were asked for, and the nearest times that are possible."""

from __future__ import annotations

import numpy as np

from formulations.optima.free_form.mesh_refinement import MeshRefinement
from formulations.optima.free_form.nlp.arcs import ArcMotion
from formulations.optima.free_form.nlp.conditioned import ConditionedProblem
from formulations.problem.conditions import Conditions

_MET = 1e-9  # of a time


def named(asked: Conditions) -> str:
    """Name the conditions that were asked for, by their keys.

    Parameters
    ----------
    asked : Conditions

    Returns
    -------
    str
    """
    return ", ".join(f"conditions.{key}" for key in asked.asked) or "the limits"


def why_not(search: MeshRefinement) -> str:
    """Say in one line which conditions are not kept and, where times are too short, the nearest possible.

    Parameters
    ----------
    search : MeshRefinement
        That found no motion.

    Returns
    -------
    str
    """
    asked = search.task.conditions
    last = next((stage.status for stage in reversed(search.stages) if stage.status), "")
    if asked.none:
        return (
            f"no motion passes the check, as the numbers are too far apart for double precision: {last}"
        )
    line = f"no motion found that keeps {named(asked)}"
    if search.nearest is not None and search.missed > 0.0:
        return f"{line}; the nearest one found {'; '.join(_nearest(search.task, search.nearest))}"
    return f"{line}; the last one tried: {last}"


def _nearest(task: ConditionedProblem, motion: ArcMotion) -> list[str]:
    """What a motion takes for what was asked to be done within a time; waypoints count from 1."""
    found = np.concatenate([[0.0], np.cumsum(motion.times)]) + task.waited
    lines = []
    for waypoint, (early, late) in enumerate(task.demands.passages[1:].tolist(), start=1):
        time = found[task.waypoint_of[waypoint]]
        if early == late:
            lines.append(f"passes waypoint {waypoint + 1} at {time:.9g} s, {late:.9g} s asked for")
        elif not early * (1.0 - _MET) <= time <= late * (1.0 + _MET):
            lines.append(
                f"passes waypoint {waypoint + 1} at {time:.9g} s, [{early:.9g}, {late:.9g}] s asked for"
            )
    for k, segment in enumerate(task.segments.tolist()):
        greatest = task.durations[k, 1]
        if motion.times[k] > greatest * (1.0 + _MET):
            lines.append(
                f"takes {motion.times[k]:.9g} s for segment {segment + 1}, at most {greatest:.9g} s asked for"
            )
    return lines
