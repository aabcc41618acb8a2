"""Problem files (TOML): read, with everything they may refer to, and written anew.

problem_file       a file or a shipped case -> Problem; problem_text: a Problem -> the text of a file
toml_text          TOML text -> a table; toml_values: its typed values, with one-line errors
joint_values       values of all joints, of a list of them, or of those that a table names
limit_table        the table [limits]
condition_table    the table [conditions]; plain_conditions: conditions -> the table
poses              Cartesian waypoints; robot_files: URDF, limits and waypoints that the file names
new_file           the text of a new problem file
"""
