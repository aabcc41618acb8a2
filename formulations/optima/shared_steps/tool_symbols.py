"""The tool point and its velocity as CasADi functions of the joints."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi

from formulations.kinematics.link_chain import LinkChain
from formulations.kinematics.tool_point import tool_point


@lru_cache(maxsize=32)
def point_function(chain: LinkChain) -> Any:
    """Make the tool point, (3,) [m], a function of the joint positions (dof,).

    Parameters
    ----------
    chain : LinkChain

    Returns
    -------
    casadi.Function
    """
    q = casadi.SX.sym("q", chain.dof)
    point = tool_point(chain, casadi.vertsplit(q), casadi.sin, casadi.cos, casadi.SX)
    return casadi.Function("tool_point", [q], [casadi.vertcat(*point)])


@lru_cache(maxsize=32)
def square_speed(chain: LinkChain) -> Any:
    """Make the square of the tool's speed a function of joint positions and velocities, (dof,) each.

    Parameters
    ----------
    chain : LinkChain

    Returns
    -------
    casadi.Function
    """
    q, v = casadi.SX.sym("q", chain.dof), casadi.SX.sym("v", chain.dof)
    velocity = casadi.jtimes(point_function(chain)(q), q, v)
    return casadi.Function("square_speed", [q, v], [casadi.sumsqr(velocity)])
