"""The fastest motion under limits on the tool.

answer          what ``free_form`` answers
search          programs on finer meshes, limits drawn in where the check finds more
lines           a start with the tool on straight lines
program         the nonlinear program on steps that all joints share
symbols         the tool point and its speed as CasADi functions
stepped         a motion on such steps: from a trajectory, and assembled to one
"""
