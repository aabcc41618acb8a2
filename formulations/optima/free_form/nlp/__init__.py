"""The nonlinear program of all motions with piecewise constant jerk, and its solvers."""
