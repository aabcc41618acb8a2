"""Certified lower bound of 4-3-...-3-4 splines: branch and bound over inverse durations."""
