"""Certified lower bounds of spline families: branch and bound in outward rounded arithmetic.

outward             rounded arithmetic, and the lemma all proofs rest on
rows, log           the conditions that are posed, the events that make a certificate
proof               an attempt at one bound, run in slices so that a time limit is kept
multipliers         a tiny linear program that proposes multipliers (nothing rests on it)
three_five_three*   the 3-5-3 spline: domain, Lagrangian, rows, search, short middle segment
four_three_four*    the 4-3-...-3-4 spline: domain, velocities, Lagrangian, rows, search
certificate         a proof as plain data, and on disk
"""
