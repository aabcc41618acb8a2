"""The arms of the papers: forward kinematics, inverse kinematics with all solutions, and reach.

dh_table     a DH table as printed: standard or modified form, units
arm          the printed DH table of each arm beside the one that fits its paper's own numbers (NAME.toml)
kinematics   forward kinematics, Jacobian and poses
inverse      joint positions for a pose
reach        the workspace, and how far a pose is out of reach
"""

from __future__ import annotations

from formulations.arms.arm import ARMS, Arm, load_arm
from formulations.arms.dh_table import DHTable
from formulations.arms.inverse import branches, joints_of, nearest
from formulations.arms.kinematics import Chain, pose_of, rpy_of
from formulations.arms.reach import distance_in_pose, distance_to, random_joints, workspace

__all__ = [
    "ARMS",
    "Arm",
    "Chain",
    "DHTable",
    "branches",
    "distance_in_pose",
    "distance_to",
    "joints_of",
    "load_arm",
    "nearest",
    "pose_of",
    "random_joints",
    "rpy_of",
    "workspace",
]
