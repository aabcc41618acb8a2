"""The papers' arms: forward kinematics, inverse kinematics with all branches, reach."""

from __future__ import annotations

from formulations.arms.arm import ARMS, Arm, load_arm
from formulations.arms.inverse import branches, joints_of, nearest
from formulations.arms.kinematics import Chain, pose_of, rpy_of
from formulations.arms.reach import distance_in_pose, distance_to, random_joints, workspace

__all__ = [
    "ARMS",
    "Arm",
    "Chain",
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
