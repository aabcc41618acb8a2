"""Certified lower bound of quintic splines: conditions that form a chain, on a grid of cells."""
