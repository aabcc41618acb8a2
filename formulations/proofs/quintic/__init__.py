"""Certified lower bound of quintic splines: conditions that form a chain, on a grid of cells.

bound         domain, search and certificate
conditions    the conditions of a piece
chain         cells of variables that are tied to their neighbours, and the discards on them
separable     least value of one variable's share of a sum on each of many cells
multipliers   linear programs that propose multipliers (no proof depends on them)
"""
