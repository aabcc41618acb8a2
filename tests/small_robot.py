"""A small robot with a prismatic axis: its files, and a problem file that names them."""

from __future__ import annotations

ARM = """<robot name="arm"><link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/>
  <limit lower="-3" upper="3" velocity="2" effort="1"/></joint>
<joint name="bend" type="revolute"><parent link="l1"/><child link="l2"/><axis xyz="0 1 0"/>
  <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
<joint name="slide" type="prismatic"><parent link="l2"/><child link="l3"/><axis xyz="0 0 1"/>
  <limit lower="0" upper="0.2" velocity="0.5" effort="1"/></joint></robot>
"""
YAML = """joint_limits:
  turn: {has_acceleration_limits: true, max_acceleration: 4, has_jerk_limits: true, max_jerk: 40}
  bend: {has_acceleration_limits: true, max_acceleration: 3, has_jerk_limits: true, max_jerk: 30}
  slide: {has_acceleration_limits: true, max_acceleration: 2, has_jerk_limits: true, max_jerk: 20}
"""
CSV = "bend,turn,slide\n10,0,0\n-20,45,0.1\n30,90,0.2\n"
FILE = """unit = "deg"
robot = "robots/arm.urdf"
limits_file = "robots/joint_limits.yaml"
waypoints_file = "path.csv"
"""
