"""Certified lower bound of 3-5-3 splines: branch and bound over two ratios of durations."""
