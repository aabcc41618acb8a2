"""One checker per family: it states the conditions anew and replays the events of a certificate.

three_five_three, four_three_four   a search tree (``tree``) of boxes
quintic                             a chain of cells
b_spline                            a tree of boxes, verified many at once in floats that are rounded outward
every_motion                        inequalities that hold for every motion, jerks included
"""
