"""Problem files (TOML): read, with everything they may refer to, and written anew.

problem_file   a file or a shipped case -> Problem
limit_table    the table [limits]; toml_values: typed values with one-line errors
poses          Cartesian waypoints; robot_files: URDF, limits and waypoints that the file names
new_file       the text of a new problem file
"""
