"""B-splines: boxes of the times of the inner waypoints.

tree            replays the events exactly, and hands on what they claim
travel          what speed and acceleration leave of a box, for every motion
knots           the basis functions as Taylor models, over many boxes at once
taylor          the arithmetic of these models
interpolation   the control points
conditions      lower bounds of sums of limits
"""
