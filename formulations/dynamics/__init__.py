"""Torques of an arm: its rigid-body dynamics, by Pinocchio, and the torques of a motion at all times.

model        inverse dynamics of populations of samples
growth       bounds on how fast the torques of a motion change, from masses, inertias and lengths
peaks        the greatest torques of a motion, between samples too
symbolic     the same dynamics as CasADi symbols, for programs
"""

from __future__ import annotations

from formulations.dynamics.model import ArmDynamics, dynamics_of
from formulations.dynamics.peaks import torque_peaks

__all__ = ["ArmDynamics", "dynamics_of", "torque_peaks"]
