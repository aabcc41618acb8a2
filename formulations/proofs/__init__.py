"""Certified lower bounds of spline families: branch and bound, or a chain of cells, in
outward rounded arithmetic.

outward             rounded arithmetic, and the lemma all proofs rest on
rows, log           the conditions that are posed, the events that make a certificate
proof               an attempt at one bound, run in slices so that a time limit is kept
multipliers         a tiny linear program that proposes multipliers (nothing rests on it)
quintic*            the quintic spline: domain, search, rows, multipliers
chain, separable    cells of variables tied to their neighbours, and sums of shares on them
intervals           interval arithmetic on whole arrays
every_motion        what holds for every motion, so for B-splines
three_five_three*   the 3-5-3 spline: domain, Lagrangian, rows, search, short middle segment
four_three_four*    the 4-3-...-3-4 spline: domain, velocities, Lagrangian, rows, search
certificate         a proof as plain data, and on disk
"""
