"""The problem: waypoints, limits and conditions, and the files that they are read from.

problem        Problem; limits has Limits
joint_words    what joints and their units are called in messages
conditions     passage times, stops, velocities at the ends, limits of single segments
problem_file   TOML files and the shipped cases; poses, limit_table, robot_files and toml_values are its parts
new_file       the text of a new problem file
errors         what is raised for misuse
arrays         the array types that all signatures share
"""
