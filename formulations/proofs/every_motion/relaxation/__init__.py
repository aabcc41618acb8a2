"""The linear relaxation that every motion satisfies.

kept_waypoints    the waypoints that the relaxation keeps
legs              the pairs of them between which rows are posed
relaxed_problem   the segments and joints that count, and limits that every motion keeps
boxes             intervals of the segment durations and waypoint accelerations
cuts              where rows are posed: kind, segment, joint, sign and place of each
reach             the inequalities on how far and how fast one joint gets in one segment
inequalities      rows as terms and as a sparse matrix
columns           the variables: their order, boxes and units
ties              the rows that tie the variables to one another, in numbers
rows              the rows of ``reach`` in numbers: coefficients, right hand sides
switches          the motions for which the inequalities are tight: where their jerk switches
separation        the rows that cut a given point off
linear_program    the linear program, solved by HiGHS with rows added as they are needed
in_band           the least total time of a long chain, by an interior point method
safe_dual         the safe dual bound: valid for any multipliers and all rounding
propagation       narrower boxes of the accelerations in closed form
tightening        narrower boxes, each bound certified in the same way
windows           the same by small programs, of a few segments each
"""
