"""Certified lower bound of 3-5-3 splines: branch and bound over two ratios of durations.

bound         domain and search of one attempt; states coordinates and conditions
lagrangian    lower bounds of a weighted sum of conditions over a box: what the proof rests on
search        the branch and bound
conditions    which conditions to try on a box (no proof depends on them)
short         a middle segment on which nothing moves, and which may vanish
data          named tuples that the compiled functions share
"""
