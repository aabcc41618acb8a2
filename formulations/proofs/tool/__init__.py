"""Lower bounds under limits on the tool.

least_times     the shortest way of the tool between two waypoints, at its greatest speed
passing         places that the tool cannot avoid on this way
enclosed        numbers known to lie in an interval, rounded outward, on which the kinematics run
"""
