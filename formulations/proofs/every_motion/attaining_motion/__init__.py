"""A motion whose duration meets the lower bound: its segment durations, its waypoint states, itself.

durations   segment durations near those of the relaxation that a motion can have
states      velocities and accelerations at the waypoints for given durations
motion      the motion between these states

The bound does not depend on any of this: the motion is judged by the independent check.
"""
