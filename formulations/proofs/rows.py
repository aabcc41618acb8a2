"""A row: one necessary condition g <= 0 and its multiplier; rows (n, WIDTH) are plain floats.

KIND says which condition, JOINT, SEGMENT, ORDER and PLACE where it is posed: derivative ORDER
(0: position) of that piece at normalised time PLACE; SIGN +1 for the upper limit, -1 for the lower.
The multiplier of g is the float MULTIPLIER / SCALE; SCALE > 0 makes rows comparable, which only the
choice of multipliers needs.
"""

KIND, JOINT, SEGMENT, ORDER, PLACE, SIGN, SCALE, MULTIPLIER, WIDTH = 0, 1, 2, 3, 4, 5, 6, 7, 8

# the kinds: a limit inside a piece; the durations add up; the first and last cube of 3-5-3; the jerk
# across a segment on which nothing moves, from the accelerations at its ends (4-3-4)
PIECE, TOTAL, FIRST, LAST, JUMP = 0.0, 1.0, 2.0, 3.0, 4.0

# A Lagrangian must exceed this (rows are of size 1) to discard a box. Zero would be sound; the margin
# lets a checker that orders its operations in another way agree.
MARGIN = 1e-12
