"""The problem: waypoints, limits and conditions, and the files that they are read from.

problem        Problem and Limits
conditions     passage times, stops, velocities at the ends, limits of single segments
problem_file   TOML files and the shipped cases; poses and toml_values are its parts
errors         what is raised for misuse
arrays         the array types that all signatures share
"""
