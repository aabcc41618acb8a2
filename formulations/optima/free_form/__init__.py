"""The fastest motion through waypoints, over all motions with bounded velocity, acceleration and jerk.

Task -> stop and go -> program on even steps -> Ruckig between its waypoint states -> program on arcs ->
trajectory -> independent check; see ``search`` for the order and ``equations`` for the program.
"""

from __future__ import annotations

from formulations.optima.free_form.fastest import FreeForm, free_form
from formulations.optima.free_form.search import Stage
from formulations.optima.free_form.sensitivity import Sensitivity

__all__ = ["FreeForm", "Sensitivity", "Stage", "free_form"]
