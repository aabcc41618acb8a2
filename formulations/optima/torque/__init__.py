"""The fastest motion within torque limits.

program    the nonlinear program on steps that all joints share, with the dynamics of the arm
steps      motions as steps: sampled as a start, assembled to a trajectory
search     kinematic optimum, stretched motion, program; the best that passes the check
"""

from __future__ import annotations

from formulations.optima.torque.search import torque_feasible

__all__ = ["torque_feasible"]
