"""Bounds on the derivatives of the tool point, from bounds on those of the joints.

The point is x_k = A_k M_k(q_k) B_k x_{k+1}. For a turning joint M_k = exp(q K) with |K| = 1. Let c_i bound
the i-th derivative of q. All derivatives of exp(q(t) K) are then bounded, in norm, by those of the power
series exp(sum_i c_i t^i / i!) at t = 0, by Faa di Bruno's formula, in which every coefficient is positive.
So the power series of the product bounds the derivatives of x_k. A sliding joint adds c_i to each
derivative. Fixed poses add to the length of x_k and to no derivative.
"""

from __future__ import annotations

from math import factorial

import numpy as np

from formulations.kinematics.link_chain import LinkChain
from formulations.problem.arrays import Array

ORDERS = 5  # highest derivative of the tool point that is bounded


def derivative_bounds(chain: LinkChain, positions: Array, derivatives: Array) -> Array:
    """Bound the derivatives of the tool point.

    Parameters
    ----------
    chain : LinkChain
    positions : Array, shape (n, dof)
        Bounds on the moduli of the joint positions [rad or m]; only those of sliding joints count.
    derivatives : Array, shape (ORDERS, n, dof)
        Bounds on the moduli of the derivatives of the joint positions, from the first one.

    Returns
    -------
    Array, shape (ORDERS + 1, n)
        Bounds on the length of the tool point in the base link and on that of its derivatives.
    """
    n = positions.shape[0]
    series = np.zeros((ORDERS + 1, n))  # Taylor coefficients: derivative over factorial
    series[0] = np.linalg.norm(chain.end[:3, 3])
    over = np.array([1.0 / factorial(i) for i in range(1, ORDERS + 1)])[:, None]
    for step in reversed(chain.steps):
        series[0] += np.linalg.norm(step.after[:3, 3])
        rate = abs(step.factor) * derivatives[:, :, step.variable] * over
        if step.prismatic:
            series[0] += abs(step.factor) * positions[:, step.variable] + abs(step.offset)
            series[1:] += rate
        else:
            series = _product(_exponential(rate), series)
        series[0] += np.linalg.norm(step.before[:3, 3])
    return np.asarray(series * np.array([factorial(i) for i in range(ORDERS + 1)])[:, None])


def _exponential(rate: Array) -> Array:
    """Coefficients of exp of a series without a constant term: n e_n = sum_k k r_k e_{n-k}."""
    found = np.zeros((ORDERS + 1, rate.shape[1]))
    found[0] = 1.0
    for n in range(1, ORDERS + 1):
        found[n] = sum(k * rate[k - 1] * found[n - k] for k in range(1, n + 1)) / n
    return found


def _product(a: Array, b: Array) -> Array:
    return np.stack([(a[: n + 1] * b[n::-1]).sum(axis=0) for n in range(len(a))])


def curvatures(chain: LinkChain, positions: Array) -> Array:
    """Bound the second derivatives of the tool point by the joint positions, wherever the joints are.

    For steps i <= k from base to tip, the second derivative is the axis of i crossed with the first
    derivative by k where i turns, and 0 where i slides. The first derivative by k is no longer than its
    lever.

    Parameters
    ----------
    chain : LinkChain
    positions : Array, shape (dof,)
        Bounds on the moduli of the joint positions [rad or m]; only those of sliding joints count.

    Returns
    -------
    Array, shape (dof, dof)
        Symmetric.
    """
    found = np.zeros((chain.dof, chain.dof))
    levers = step_levers(chain, positions)
    for k, later in enumerate(chain.steps):
        for i, first in enumerate(chain.steps[: k + 1]):
            if first.prismatic:
                continue
            value = abs(first.factor) * levers[k]
            found[first.variable, later.variable] += value
            if i < k:
                found[later.variable, first.variable] += value
    return found * (1.0 + 1e-12)  # above what rounding takes off


def step_levers(chain: LinkChain, positions: Array) -> Array:
    """Bound how far the tool moves per unit of the variable of each step.

    Parameters
    ----------
    chain : LinkChain
    positions : Array, shape (dof,)
        As for ``curvatures``.

    Returns
    -------
    Array, shape (n_steps,)
        [m/rad, or 1].
    """
    found = np.zeros(len(chain.steps))
    size = float(np.linalg.norm(chain.end[:3, 3]))
    for k in reversed(range(len(chain.steps))):
        step = chain.steps[k]
        size += float(np.linalg.norm(step.after[:3, 3]))
        found[k] = abs(step.factor) * (1.0 if step.prismatic else size)
        if step.prismatic:
            size += abs(step.factor) * positions[step.variable] + abs(step.offset)
        size += float(np.linalg.norm(step.before[:3, 3]))
    return found * (1.0 + 1e-12)
