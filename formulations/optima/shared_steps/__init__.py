"""The fastest motion under limits that tie the joints together: the tool's speed and place, and torques.

program        the nonlinear program on steps that all joints share
tool_symbols   the tool point and its speed as CasADi functions
steps          motions as steps: sampled as a start, slowed down, assembled to a trajectory
search         slowed-down motion, program, margins; the best that passes the check
at_points      the same with steps of whole periods, for a file of points
answer         what ``free_form`` answers
"""

from __future__ import annotations

from formulations.optima.shared_steps.answer import fastest_within

__all__ = ["fastest_within"]
