"""The fastest spline of a family: an upper bound.

program       the nonlinear program, with constraints posed at given places (CasADi, IPOPT)
exchange      solves it and poses the constraints again at the extremes, until they stay (one start)
starts        where the solver starts
optimum       the best of its starts, judged by the independent check
papers_rule   the papers' rule: each joint alone, then the longest time per segment
"""
