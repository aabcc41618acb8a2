"""The fastest motion through waypoints under velocity, acceleration and jerk limits."""

from __future__ import annotations

from formulations.conditions import Conditions
from formulations.errors import InputError, NoFeasibleMotion, UnsupportedProblem
from formulations.families import FAMILIES
from formulations.family_bound import FamilyBound, family_bound
from formulations.family_optimum import (
    FamilyOptimum,
    each_joint_alone,
    family_optimum,
    longest_segment,
)
from formulations.free_form import FreeForm, Sensitivity, free_form
from formulations.free_form_bound import FreeFormBound, free_form_bound
from formulations.ladder import Ladder, ladder
from formulations.problem import Limits, Problem
from formulations.problem_file import CASES, load, parse
from formulations.references import REFERENCES
from formulations.trajectory import Trajectory, Verdict, check

__all__ = [
    "CASES",
    "FAMILIES",
    "REFERENCES",
    "Conditions",
    "FamilyBound",
    "FamilyOptimum",
    "FreeForm",
    "FreeFormBound",
    "InputError",
    "Ladder",
    "Limits",
    "NoFeasibleMotion",
    "Problem",
    "Sensitivity",
    "Trajectory",
    "UnsupportedProblem",
    "Verdict",
    "check",
    "each_joint_alone",
    "family_bound",
    "family_optimum",
    "free_form",
    "free_form_bound",
    "ladder",
    "load",
    "longest_segment",
    "parse",
]
