"""The keys of a problem file and what each holds; no other key is taken."""

from __future__ import annotations

PROBLEM_KEYS: dict[str, str] = {
    "name": "Short name, for messages and files.",
    "title": "One line for people.",
    "source": "Where the numbers come from, and what was assumed.",
    "unit": '`"rad"` or `"deg"`: unit of all angles; rad if left out. Lengths are in m.',
    "family": "Spline family, a key of `FAMILIES`; if left out, 3-5-3 for three segments, else 4-3-4.",
    "waypoints": "A row per waypoint and a column per joint, in the order of the joints.",
    "limits": "The table `[limits]`; with a robot it lies over the limits of the robot's files.",
    "conditions": "The table `[conditions]`: zones, times, stops, waits, states at the ends, a cycle.",
    "arm": "A shipped arm, whose kinematics solve the poses; needs the extra `arms`.",
    "pose": "Tables `[[pose]]` in place of waypoints, each solved to the joints nearest to the last one.",
    "length": '`"m"` or `"mm"`: unit of the positions of poses and of `waypoints_file`; m if left out.',
    "near": "Joint positions that the solution of the first pose is nearest to: a list, or a table by joint.",
    "joints": "Names of the joints, in order; with a robot, those that move.",
    "prismatic": "Names of the joints that slide, without a robot; their positions are in m.",
    "waypoints_file": "A CSV table of positions or poses, or a JointTrajectory; relative to this file.",
    "robot": "A URDF; relative to this file. Needs the extra `robot`.",
    "limits_file": "MoveIt's `joint_limits.yaml`, or a list of such files, the last of which counts.",
    "unlimited": '`"acceleration"`, `"jerk"` or `"position"`: what a joint may have no limit of.',
    "srdf": "MoveIt's description of the groups of joints.",
    "group": "A group of the SRDF, in place of `joints`.",
    "base": "The link that poses are measured from.",
    "tip": "The link that poses are given for.",
    "velocity_scaling": "Factor on the velocity limits of the robot's files, up to 1.",
    "acceleration_scaling": "Factor on the acceleration limits of the robot's files, up to 1.",
    "jerk_scaling": "Factor on the jerk limits of the robot's files, up to 1.",
}
"""Keys at the top of the file."""

LIMIT_KEYS: dict[str, str] = {
    "unit": '`"rad"` or `"deg"`; the unit of the file if left out. Results are shown in it.',
    "velocity": "Greatest speed [unit/s]: one number, a list with one per joint, or a table by joint. A joint "
    "whose limits differ between the directions has a pair, [least, greatest].",
    "acceleration": "Greatest acceleration [unit/s^2], in the same forms; unlimited if left out.",
    "jerk": "Greatest jerk [unit/s^3], without pairs; unlimited if left out.",
    "position": "Least and greatest position [unit] of each joint; unlimited if left out.",
}
"""Keys of the table ``[limits]``."""

POSE_KEYS: dict[str, str] = {
    "position": "x, y, z of the tip [length].",
    "rpy": "Roll, pitch and yaw [unit]: R = Rz(yaw) Ry(pitch) Rx(roll).",
}
"""Keys of a table ``[[pose]]``."""

_PER_JOINT = "one number, a list with one per joint, or a table by joint"

CONDITION_KEYS: dict[str, str] = {
    "tolerance": "Zone around each inner waypoint: how far from it each joint may pass it [unit]; "
    f"{_PER_JOINT}.",
    "stops": "Waypoints at which the motion stands still, as a list of their numbers.",
    "total": "Time of the whole motion [s]. The motion is then the smoothest in this time.",
    "cyclic": "`true`: the motion is one turn of a cycle; velocity and acceleration are the same at both ends.",
    "start_velocity": f'Velocity at the start [unit/s]: {_PER_JOINT}, or `"free"`; at rest if left out.',
    "end_velocity": "Velocity at the end, in the same forms.",
    "start_acceleration": "Acceleration at the start [unit/s^2], in the same forms; 0 if left out.",
    "end_acceleration": "Acceleration at the end, in the same forms.",
    "waypoint": "Tables `[[conditions.waypoint]]`, each about one waypoint.",
    "segment": "Tables `[[conditions.segment]]`, each about the segment between a waypoint and the next one.",
}
"""Keys of the table ``[conditions]``."""

WAYPOINT_KEYS: dict[str, str] = {
    "at": "Number of the waypoint; 0 is the start.",
    "tolerance": "Zone around this waypoint, in place of the one around all of them.",
    "pass": "Time from the start at which it is passed [s].",
    "window": "Earliest and latest time at which it is passed [s]; the latest may be `inf`.",
    "wait": "How long the motion stands still there after it has arrived [s].",
    "stop": "`true`: the motion stands still there.",
}
"""Keys of a table ``[[conditions.waypoint]]``."""

SEGMENT_KEYS: dict[str, str] = {
    "from": "Number of the waypoint at which the segment begins; 0 is the start.",
    "time": "Least and greatest time [s] between leaving this waypoint and arriving at the next one; the "
    "greatest may be `inf`.",
    "least_time": "The least time alone [s].",
    "limits": "Limits on this segment, with the keys of `[limits]`; what is left out stays as it is, and `inf` "
    "takes a limit of position away.",
}
"""Keys of a table ``[[conditions.segment]]``."""
