"""The nonlinear program of the free-form motion on a mesh, and its two solvers.

conditioned   the problem under its conditions, without segments and joints that cannot matter
arcs          a motion as arcs of constant jerk
passed_at_once  which waypoints are passed at one time
blocks        what a program is made of: its shape, blocks with bounds, parameters
equations     the program: variables, parameters and rows, each registered with its bounds
scaled        the numbers of one problem in the program's units
program       equations and numbers together; motions to points and back
ipopt, slp    the solvers: IPOPT, and sequential linear programs on HiGHS
assembly      a motion as a trajectory of polynomial pieces, exact to rounding
"""
