"""The inequalities are tight: an oracle of linear programs in time."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linprog

from formulations.problem.arrays import Array
from formulations.proofs.every_motion.relaxation.reach import distance_coefficients, speed_coefficients
from formulations.proofs.every_motion.relaxation.switches import farthest, fastest


def farthest_on_a_grid(ends: Array, V: float, A: float, J: float, n: int = 120) -> float:
    """Largest displacement in unit time with jerks constant on n steps: no more than the true one.

    Velocity bounded between the nodes too, by its middle Bernstein coefficients.
    """
    v0, W0, v1, W1 = ends
    h = 1.0 / n
    W = h * np.tril(np.ones((n + 1, n)), -1)  # of the jerks, W0 apart
    v = h * (np.tril(np.ones((n + 1, n)), -1) @ (W[:-1] + h / 2.0 * np.eye(n)))
    v_at = v0 + W0 * h * np.arange(n + 1)
    middle, middle_at = v[:-1] + h / 2.0 * W[:-1], v_at[:-1] + h / 2.0 * W0
    covered = np.ones(n) @ (h * v[:-1] + h**2 / 2.0 * W[:-1] + h**3 / 6.0 * np.eye(n))
    rows = np.concatenate([W, -W, v, -v, middle, -middle])
    steep = [np.full(n + 1, A - W0), np.full(n + 1, A + W0)]
    upper = np.concatenate([*steep, V - v_at, V + v_at, V - middle_at, V + middle_at])
    met = np.stack([W[-1], v[-1]])
    answer = linprog(-covered, rows, upper, met, [W1 - W0, v1 - v_at[-1]], (-J, J), method="highs")
    assert answer.status == 0, answer.message
    return float(covered @ answer.x + h * (v_at[:-1] + h / 2.0 * W0).sum())


@pytest.mark.parametrize("seed", range(8))
def test_distance_is_that_of_the_farthest_motion(seed: int) -> None:
    rng = np.random.default_rng(seed)
    A, J = 10.0 ** rng.uniform(0.0, 1.0), 10.0 ** rng.uniform(1.5, 2.5)
    W0, W1 = 0.3 * A * rng.uniform(-1.0, 1.0, 2)
    v0, v1 = 0.1 * A * rng.uniform(-1.0, 1.0, 2)
    V = 0.25 * A if seed % 2 else 2.0 * A
    ends, limits = np.array([v0, W0, v1, W1]), np.array([V, A, J])
    switches, cruises = farthest(*ends[:, None], *limits[:, None])
    assert bool(cruises[0]) == bool(seed % 2)
    c = np.concatenate(distance_coefficients(switches, bool(cruises[0])))
    bound = float(c @ [*ends, *limits])
    reached = farthest_on_a_grid(ends, V, A, J)
    assert bound - 3e-3 * V <= reached <= bound * (1.0 + 1e-9)
    two = fastest(ends[1:2], ends[3:], *limits[1:, None])
    gained = float(np.concatenate(speed_coefficients(two)) @ [W0, W1, A, J])
    s = np.linspace(0.0, 1.0, 100_001)
    steepest = np.minimum(np.minimum(W0 + J * s, W1 + J * (1.0 - s)), A)
    assert gained == pytest.approx(float(np.trapezoid(steepest, s)), rel=1e-8)
