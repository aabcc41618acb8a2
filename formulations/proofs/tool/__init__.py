"""Lower bounds under limits on the tool.

least_times     the straight distance of the tool between two waypoints, at its greatest speed
enclosed        numbers known to lie in an interval, rounded outward, on which the kinematics run
"""
