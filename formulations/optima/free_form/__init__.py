"""The fastest motion through waypoints, of all with bounded velocity, acceleration and jerk.

fastest           ``free_form``, which others call
proved            its bound, and the search once more from there: ``proved_motion``
answer            its answer
ending            how the search ended
stage             one step of the search
mesh_refinement   the search: programs on finer and finer meshes, each motion judged by the check
vanishing         zones that are passed at one time
why_not           why there is no motion, and the nearest times that are possible
stop_and_go       the motion that is always there, in closed form
many_waypoints    through many waypoints: a search that takes time in proportion to them
chains            what that search has to keep, and its points as motions
faults            what a motion keeps badly: position limits, times
retiming          each segment's least time between waypoint states, by Ruckig
sensitivity       what each limit costs, from the multipliers
nlp/              the nonlinear program: ``nlp.equations`` has it in one page
"""

from __future__ import annotations

from formulations.optima.free_form.answer import FreeForm
from formulations.optima.free_form.ending import SearchStatus
from formulations.optima.free_form.fastest import free_form
from formulations.optima.free_form.proved import proved_motion
from formulations.optima.free_form.sensitivity import Sensitivity
from formulations.optima.free_form.stage import Stage

__all__ = ["FreeForm", "SearchStatus", "Sensitivity", "Stage", "free_form", "proved_motion"]
