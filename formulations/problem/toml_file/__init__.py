"""Problem files (TOML): read, with everything they may refer to, and written anew.

problem_file   a file or a shipped case -> Problem
toml_text      TOML text -> a table; toml_values: its typed values, with one-line errors
limit_table    the table [limits]
poses          Cartesian waypoints; robot_files: URDF, limits and waypoints that the file names
new_file       the text of a new problem file
"""
