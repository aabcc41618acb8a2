"""The checker of a bound of every motion: inequalities that each motion keeps, and sums of them.

course         the waypoints that are kept, and the limits of what lies between two of them
implied        limits that follow from others
accelerations  the acceleration at a waypoint, from the durations of the two segments that meet there
setting        the variables, and the boxes that hold them at first
terms          what an inequality of one joint on one leg consists of
inequalities   every row, built anew
relaxation     boxes, and the events that narrow them
"""
