"""The fastest motion through waypoints under velocity, acceleration and jerk limits."""

from __future__ import annotations

from formulations.climb import Ladder
from formulations.families import FAMILIES
from formulations.motion.files.motion_file import read_motion, read_points, write_motion
from formulations.motion.trajectory import Trajectory
from formulations.motion.verdict import Verdict, check
from formulations.optima.at_rate.export import Export, export_motion
from formulations.optima.family.chord_lengths import chord_lengths
from formulations.optima.family.optimum import FamilyOptimum, family_optimum
from formulations.optima.family.papers_rule import longest_segment
from formulations.optima.free_form import FreeForm, Sensitivity, free_form, proved_motion
from formulations.planning import PlannedMotion, plan
from formulations.problem.conditions import Conditions
from formulations.problem.errors import InputError, NoFeasibleMotion, NotFoundInTime, UnsupportedProblem
from formulations.problem.problem import Limits, Problem
from formulations.problem.toml_file.problem_file import CASES, load, parse
from formulations.problem.toml_file.problem_text import save
from formulations.proofs.each_joint import each_joint_alone
from formulations.proofs.every_motion.bound import FreeFormBound, free_form_bound
from formulations.proofs.family import FamilyBound, family_bound, proved_optimum
from formulations.robot import Robot, robot_of, waypoints_of
from formulations.rungs import REFERENCES, RUNGS, ladder

__all__ = [
    "CASES",
    "FAMILIES",
    "REFERENCES",
    "RUNGS",
    "Conditions",
    "Export",
    "FamilyBound",
    "FamilyOptimum",
    "FreeForm",
    "FreeFormBound",
    "InputError",
    "Ladder",
    "Limits",
    "NoFeasibleMotion",
    "NotFoundInTime",
    "PlannedMotion",
    "Problem",
    "Robot",
    "Sensitivity",
    "Trajectory",
    "UnsupportedProblem",
    "Verdict",
    "check",
    "chord_lengths",
    "each_joint_alone",
    "export_motion",
    "family_bound",
    "family_optimum",
    "free_form",
    "free_form_bound",
    "ladder",
    "load",
    "longest_segment",
    "parse",
    "plan",
    "proved_motion",
    "proved_optimum",
    "read_motion",
    "read_points",
    "robot_of",
    "save",
    "waypoints_of",
    "write_motion",
]
