"""An engineer's robot and waypoints from the files there are: URDF, SRDF, joint_limits.yaml, CSV, messages."""

from __future__ import annotations

from formulations.robot.assembly import limits_of, robot_of
from formulations.robot.joints import Joint, JointKind, Mimic
from formulations.robot.robot import Robot
from formulations.robot.waypoints import waypoints_of

__all__ = ["Joint", "JointKind", "Mimic", "Robot", "limits_of", "robot_of", "waypoints_of"]
