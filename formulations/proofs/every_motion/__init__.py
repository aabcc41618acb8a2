"""The certified lower bound of all motions, by a linear relaxation in closed form and without a mesh.

bound                   ``free_form_bound``, which others call, and its answer
horizons                the search: closed forms, the relaxation, a motion that meets it, narrower boxes
parts                   boxes that cannot be narrowed any more, split
ending                  how the search ended
relaxation/             the linear program: its rows, its safe dual bound, narrower boxes
attaining_motion/       the motion that meets the bound, where the relaxation is tight
interior_point          quadratic and linear programs in a band
closed_forms            bounds that need no solver
prices                  what each limit costs, from the multipliers
recorded                the bound once more, for a checker
events                  the proof as plain data, for a checker that builds every row itself
"""
