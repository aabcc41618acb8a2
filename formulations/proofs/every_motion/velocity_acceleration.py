"""A lower bound of every motion from rest to rest under velocity and acceleration limits.

Of a joint, let q be its motion, m(t) linear on each segment with values mu_0 .. mu_n at the waypoints,
and p(t) any function of bounded variation. As q' vanishes at both ends,

    sum_k (mu_{k-1} - mu_k) d_k / T_k  =  int m q''  =  int p q'' + int (p - m)' q'
                                      <=  A int |p| + V int |(p - m)'|.

Let p be linear on N equal cells of each segment, p_i at their ends. Then int |p| over segment k is at
most T_k w_k, w_k the mean of |p|, and the last integral is sum |p_i - p_{i-1} - (mu_k - mu_{k-1}) / N|
whatever the durations. Summed over the joints, the total time is at least

    sum_k T_k + a_k / T_k - w_k T_k - const  >=  sum_k 2 sqrt(a_k (1 - w_k)) - const

for any mu, p with all a_k >= 0 and w_k <= 1. The best mu, p solve a convex program, the dual of the
fastest motion under velocity and acceleration limits. The bound is valid for inexact solutions too. Jerk
and position limits are not used.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi
import numpy as np

from formulations.problem.arrays import Array
from formulations.problem.problem import Problem
from formulations.proofs.arithmetic.intervals import (
    Interval,
    down,
    exact,
    least_sum,
    plus,
    sum_error,
    times,
    up,
)
from formulations.proofs.domain import data_of

CELLS = 8  # per segment
_SAFE = 1e-7  # least value of a and b, above the solver's tolerance
_IPOPT: dict[str, Any] = {
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "print_time": False,
    "ipopt.max_iter": 300,
    "error_on_fail": False,
    "show_eval_warnings": False,
}


@dataclass(frozen=True)
class VelocityAccelerationBound:
    """The bound and the numbers that prove it.

    Attributes
    ----------
    seconds : float [s]
    mu : Array, shape (n_segments + 1, n)
        Of the n moving joints.
    p : Array, shape (N n_segments + 1, n)
    """

    seconds: float
    mu: Array
    p: Array

    def events(self, moving: list[int]) -> list[list[Any]]:
        """Write the proof as events of a certificate.

        Parameters
        ----------
        moving : list of int
            The moving joints.

        Returns
        -------
        list
            One event ["M", joint, mu, p] for each joint, floats as hexadecimal text.
        """
        return [
            ["M", joint, *([x.hex() for x in values[:, j].tolist()] for values in (self.mu, self.p))]
            for j, joint in enumerate(moving)
        ]


def velocity_acceleration_bound(problem: Problem, cells: int = CELLS) -> VelocityAccelerationBound:
    """Prove a lower bound on the total time of all motions.

    Parameters
    ----------
    problem : Problem
        At least one joint moves.
    cells : int
        N, the number of cells per segment.

    Returns
    -------
    VelocityAccelerationBound
        Of 0 seconds at worst.
    """
    mu, p = _dual(problem, cells)
    return VelocityAccelerationBound(proved(problem, mu, p), mu, p)


def proved(problem: Problem, mu: Array, p: Array) -> float:
    """Evaluate the bound that mu and p prove, rounded down.

    Parameters
    ----------
    problem : Problem
    mu : Array, shape (n_segments + 1, n)
    p : Array, shape (N n_segments + 1, n)

    Returns
    -------
    float [s]
    """
    data = data_of(problem)
    n = len(data.d)
    velocity, acceleration, _ = data.derivatives
    steps = _minus(mu[:-1], mu[1:])
    shares = np.where(data.d == 0.0, 0.0, times(steps, (data.d_lo, data.d_hi))[0])
    a = least_sum(shares.ravel(), np.repeat(np.arange(n), shares.shape[1]), n)
    b = down(1.0 - _shares(p, acceleration, n))
    cells = (len(p) - 1) // n
    even = times(steps, (down(1.0 / cells), up(1.0 / cells)))
    lo, hi = (np.repeat(end, cells, axis=0) for end in even)
    turns = plus(_minus(p[1:], p[:-1]), (lo, hi))
    held = up(up(np.maximum(-turns[0], turns[1])) * velocity)
    if not ((a >= 0.0).all() and (b >= 0.0).all()):
        return 0.0
    terms = down(2.0 * down(np.sqrt(down(a * b))))
    terms = np.concatenate([np.maximum(terms, 0.0), -held.ravel()])
    return max(float(terms.sum() - sum_error(len(terms), np.abs(terms).sum())), 0.0)


def _minus(a: Array, b: Array) -> Interval:
    """Enclosure of a - b, exactly 0 where they are equal."""
    lo, hi = plus(exact(a), exact(-b))
    return np.where(a == b, 0.0, lo), np.where(a == b, 0.0, hi)


def _shares(p: Array, acceleration: Array, n: int) -> Array:
    """Upper bounds of w_k: sum over the joints of A times the mean of |p|, (n,)."""
    means = (np.abs(p[1:]) + np.abs(p[:-1])) / 2.0
    terms = np.where(means > 0.0, means * np.where(means > 0.0, acceleration, 0.0), 0.0)
    terms = terms.reshape(n, -1) * (n / (len(p) - 1))
    return np.asarray(terms.sum(axis=1) + sum_error(4 + terms.shape[1], terms.sum(axis=1)))


def _dual(problem: Problem, cells: int) -> tuple[Array, Array]:
    """Solve for mu and p approximately, in units in which a segment takes about 1 and top speed is 1."""
    data = data_of(problem)
    n, dof = data.d.shape
    velocity, acceleration, _ = data.derivatives
    unit = float((np.abs(data.d) / velocity).max(axis=1).mean())
    d, most = data.d / (velocity * unit), acceleration * unit / velocity
    limited = np.isfinite(most)
    mu = casadi.SX.sym("mu", n + 1, dof)
    p = casadi.SX.sym("p", n * cells + 1, dof)
    size = casadi.SX.sym("size", n * cells + 1, dof)  # of p
    turn = casadi.SX.sym("turn", n * cells, dof)  # of p - m
    root = casadi.SX.sym("root", n)
    fall = mu[:-1, :] - mu[1:, :]
    steps = p[1:, :] - p[:-1, :] + casadi.SX(np.repeat(np.eye(n), cells, axis=0)) @ fall / cells
    mean = casadi.SX(np.repeat(np.eye(n), cells, axis=1)) @ (size[1:, :] + size[:-1, :]) / (2 * cells)
    a = casadi.sum2(casadi.SX(d) * fall)
    b = 1.0 - mean @ casadi.SX(np.where(limited, most, 0.0))
    positive = [a * b - root**2, a - _SAFE * (data.d != 0.0).any(axis=1), b - _SAFE]
    positive += [casadi.vec(part) for part in (size - p, size + p, turn - steps, turn + steps)]
    free = [casadi.vec(part) for part in (mu, p, size, turn, root)]
    reach = np.repeat(
        np.where(limited, np.inf, 0.0), n * cells + 1
    )  # p is 0 without an acceleration limit
    others = np.full(sum(part.numel() for part in free[2:]), np.inf)
    pinned = np.where(np.arange(mu.numel()) % (n + 1) == 0, 0.0, np.inf)  # only differences of mu count
    bounds = np.concatenate([pinned, reach, others])
    solver = casadi.nlpsol(
        "dual",
        "ipopt",
        {
            "x": casadi.vertcat(*free),
            "f": casadi.sum1(casadi.sum2(turn)) - 2.0 * casadi.sum1(root),
            "g": casadi.vertcat(*positive),
        },
        _IPOPT,
    )
    start = np.where(np.isfinite(bounds), 0.0, 0.01)
    answer = solver(x0=start, lbx=-bounds, ubx=bounds, lbg=0.0)
    values = np.nan_to_num(np.array(answer["x"]).ravel(), posinf=0.0, neginf=0.0)
    found_mu, found_p = np.split(values[: mu.numel() + p.numel()], [mu.numel()])
    # mu and p multiply q', so that they are divided by the joint's unit of velocity
    return (
        found_mu.reshape(dof, n + 1).T * unit / velocity,
        found_p.reshape(dof, n * cells + 1).T * unit / velocity,
    )
