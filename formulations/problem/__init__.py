"""The problem: waypoints, limits and conditions, and the files that they are read from.

problem        Problem; limits has Limits
joint_words    what joints and their units are called in messages
conditions     passage times, stops, velocities at the ends, limits of single segments
toml_file      problem files and the shipped cases: readers, and the text of a new file
errors         what is raised for misuse
arrays         the array types that all signatures share
"""
