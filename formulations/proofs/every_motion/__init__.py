"""The certified lower bound of all motions: a linear relaxation in closed form, no mesh.

closed_forms   bounds that need no solver
task           segments and joints that matter, limits every motion keeps
reach          how far and how fast one joint gets in one segment: the inequalities
switches       the motions for which those are tight
cuts, rows     the rows in numbers: where they are posed, their coefficients, their rounding
separation     the rows that cut a point off
program        the linear program, solved by HiGHS row by row
safe_dual      its bound, safe against rounding and the solver
tightening     narrower boxes, each bound certified the same way
prices         what each limit costs
descent        durations of a motion near those of the relaxation
states, motion a motion with these durations, for whoever checks it
search         all of it, step by step
"""
