"""The fastest spline of a family: the exact nonlinear program, solved from many starts."""
