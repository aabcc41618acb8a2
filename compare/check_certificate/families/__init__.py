"""One checker per family: it states the conditions anew and replays the events of a certificate.

three_five_three, four_three_four   a search tree (``tree``) of boxes
quintic                             a chain of cells
velocity_acceleration               one sum that holds for every motion, from velocities and accelerations
relaxation                          inequalities that hold for every motion, jerks included
"""
