"""Waypoints of a robot from files: joint positions as CSV or JointTrajectory, or Cartesian poses."""

from __future__ import annotations

from formulations.robot.waypoints.reader import waypoints_of

__all__ = ["waypoints_of"]
