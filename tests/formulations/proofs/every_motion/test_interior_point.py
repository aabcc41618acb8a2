"""The interior point method in a band, beside HiGHS and beside the optimality conditions themselves."""

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.sparse import csr_array, diags_array

from formulations.deadlines import Deadline
from formulations.proofs.every_motion.interior_point import minimise_in_band


def banded_program(seed, n=40):
    """A feasible random program whose rows touch three neighbours."""
    rng = np.random.default_rng(seed)
    rows = np.zeros((n - 2, n))
    for i in range(n - 2):
        rows[i, i : i + 3] = rng.normal(size=3)
    inside = rng.uniform(-0.5, 0.5, n)
    upper = rows @ inside + rng.uniform(0.0, 0.3, n - 2)
    return rng.normal(size=n), rows, upper, np.tile([-1.0, 1.0], (n, 1))


@pytest.mark.parametrize("seed", range(8))
def test_a_linear_program_has_the_optimum_of_highs(seed):
    cost, rows, upper, box = banded_program(seed)
    found = minimise_in_band(cost, csr_array(rows), upper, box, tolerance=1e-10)
    truth = linprog(cost, A_ub=rows, b_ub=upper, bounds=box).fun
    assert found.converged
    assert cost @ found.x == pytest.approx(truth, abs=1e-7)


@pytest.mark.parametrize("seed", range(8))
def test_a_quadratic_program_meets_its_optimality_conditions(seed):
    cost, rows, upper, box = banded_program(seed)
    quadratic = diags_array(np.linspace(0.5, 2.0, len(cost))).tocsr()
    found = minimise_in_band(cost, csr_array(rows), upper, box, csr_array(quadratic), tolerance=1e-11)
    x, y = found.x, found.multipliers
    assert found.converged
    assert (rows @ x <= upper + 1e-8).all()
    assert (y >= 0.0).all()
    slope = cost + quadratic @ x + rows.T @ y
    inner = (x > -1.0 + 1e-5) & (x < 1.0 - 1e-5)
    assert np.abs(slope[inner]).max(initial=0.0) < 1e-4
    assert (slope[x <= -1.0 + 1e-5] > -1e-4).all()
    assert (slope[x >= 1.0 - 1e-5] < 1e-4).all()
    assert np.abs(y * (upper - rows @ x)).max() < 1e-6


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("where", [0.0, 0.7, 5.0])
def test_the_optimum_does_not_depend_on_the_start(seed, where):
    cost, rows, upper, box = banded_program(seed)
    start = np.full(len(cost), where)  # also on or beyond the boxes' ends
    found = minimise_in_band(cost, csr_array(rows), upper, box, tolerance=1e-10, start=start)
    assert found.converged
    assert cost @ found.x == pytest.approx(linprog(cost, rows, upper, bounds=box).fun, abs=1e-7)


def test_the_deadline_ends_the_solve():
    cost, rows, upper, box = banded_program(0)
    found = minimise_in_band(
        cost, csr_array(rows), upper, box, tolerance=1e-10, deadline=Deadline(stop=lambda: True)
    )
    assert not found.converged
