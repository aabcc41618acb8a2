"""A function of time with its first two derivatives: what the tool's velocity and acceleration come from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from formulations.kinematics.link_chain import LinkChain
from formulations.kinematics.tool_point import tool_point
from formulations.problem.arrays import Array


@dataclass(frozen=True)
class Jet:
    """Value and derivatives, arrays that broadcast."""

    value: Any
    first: Any
    second: Any

    def __add__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.value + other, self.first, self.second)
        return Jet(self.value + other.value, self.first + other.first, self.second + other.second)

    def __rsub__(self, other: float) -> Jet:
        return Jet(other - self.value, -self.first, -self.second)

    def __mul__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.value * other, self.first * other, self.second * other)
        return Jet(
            self.value * other.value,
            self.first * other.value + self.value * other.first,
            self.second * other.value + 2.0 * self.first * other.first + self.value * other.second,
        )


def _sine(q: Jet) -> Jet:
    s, c = np.sin(q.value), np.cos(q.value)
    return Jet(s, c * q.first, c * q.second - s * q.first**2)


def _cosine(q: Jet) -> Jet:
    s, c = np.sin(q.value), np.cos(q.value)
    return Jet(c, -s * q.first, -s * q.second - c * q.first**2)


def tool_motion(chain: LinkChain, q: Array, v: Array, a: Array) -> tuple[Array, Array, Array]:
    """Compute position, velocity and acceleration of the tool point.

    Parameters
    ----------
    chain : LinkChain
    q, v, a : Array, shape (n, dof)
        Positions, velocities and accelerations of the joints [rad or m, s].

    Returns
    -------
    position, velocity, acceleration : Array, shape (3, n)
        In the base link [m, s].
    """
    zero = np.zeros(len(q))
    joints = [Jet(q[:, j], v[:, j], a[:, j]) for j in range(q.shape[1])]
    found = tool_point(chain, joints, _sine, _cosine, lambda x: Jet(x + zero, zero, zero))
    return (
        np.stack([component.value for component in found]),
        np.stack([component.first for component in found]),
        np.stack([component.second for component in found]),
    )
