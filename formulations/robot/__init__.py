"""An engineer's robot and waypoints from the files there are: URDF, SRDF, joint_limits.yaml, CSV, messages."""

from __future__ import annotations

from formulations.robot.assembly import robot_of, robot_of_joints
from formulations.robot.joints import Joint, JointKind, Mimic
from formulations.robot.robot import Robot
from formulations.robot.waypoints import joint_names_in, waypoints_of

__all__ = [
    "Joint",
    "JointKind",
    "Mimic",
    "Robot",
    "joint_names_in",
    "robot_of",
    "robot_of_joints",
    "waypoints_of",
]
