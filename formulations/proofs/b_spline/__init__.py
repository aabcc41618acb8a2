"""B-splines: a search over boxes of waypoint times.

taylor, products, least     Taylor models of third order
basis            waypoint times and knots as linear forms; models of the basis functions
control_points   models of the control points
conditions       the limits, and their models
travel           what holds for every motion cuts a box
search, bound    branch and bound, and the attempt to prove one bound
"""
