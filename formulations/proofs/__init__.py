"""Certified lower bounds of the total time; every operation that a bound rests on is rounded outward.

family              the optimum and the bound of a spline family, and the registry of provers
each_joint          the optimum of every joint by itself
alternation         proof and nonlinear program in turn, until they meet
proof               an attempt to prove one bound, run in slices
domain              displacements, limits and the domain of the durations, rounded outward
conditions, events  the rows that are posed, the events that make a certificate
multipliers         a small linear program that proposes multipliers (no proof depends on it)
certificate         a proof as plain data, and on disk

arithmetic          rounded arithmetic: scalars in compiled code, and intervals on whole arrays
three_five_three, four_three_four, quintic, b_spline     the provers of the families, a folder each
every_motion        bounds that hold for every motion
"""
