"""Waypoints of a robot from files: joint positions as CSV or JointTrajectory, or Cartesian poses."""

from __future__ import annotations

from formulations.robot.waypoints.reader import joint_names_in, waypoints_of

__all__ = ["joint_names_in", "waypoints_of"]
