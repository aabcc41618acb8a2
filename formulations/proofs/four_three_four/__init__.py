"""Certified lower bound of 4-3-...-3-4 splines: branch and bound over inverse durations.

bound         domain and search of one attempt; states coordinates and conditions
velocities    enclosure of the velocities at the inner waypoints over a box
lagrangian    lower bounds of a weighted sum of conditions over a box: with velocities, what the proof
              rests on
search        the branch and bound
branching     which variable of a box it splits
parts         bounds of sub-chains with free end velocities, which narrow the search for a long motion
reference     the point of a box about which velocities and conditions are expanded
conditions    which conditions to try on a box (no proof depends on them)
ends          knots, variables and pieces of the whole and of a part with free ends
data          named tuples that the compiled functions share
"""
