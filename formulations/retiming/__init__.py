"""A path of dense points, timed anew: on the path as it is, or freely within a tolerance of it."""
