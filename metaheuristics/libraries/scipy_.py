"""Optimisers of SciPy, and scrambled quasi-random points.

Each optimiser starts again when it ends, until the budget is spent.  Nelder-Mead and SLSQP work on the unit
box, from uniform starts.

References
----------
Sobol I. (1967), `sobol`.  Storn R., Price K. (1997), `differential_evolution`.  Xiang Y. et al. (1997),
`dual_annealing`.  Nelder J., Mead R. (1965), `nelder_mead`.  Kraft D. (1988), `slsqp`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from metaheuristics.driver.bridge import inverted
from metaheuristics.driver.task import Array, Moves, Task
from metaheuristics.libraries.shared import finite

STEP = 1.5e-8
"""Step of a finite difference on the unit box: about the root of the rounding error."""
BLOCK = 1024
"""Sobol points that are drawn at once; they are balanced in powers of two."""


def _optimize() -> Any:
    """Return `scipy.optimize`, which takes longer to load than the rest of this package."""
    from scipy import optimize

    return optimize


def sobol(task: Task, *, population: int = 50) -> Moves:
    """Draw a scrambled Sobol sequence; the batch size does not change the points.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    population : int
        Points per batch.

    Yields
    ------
    Array, shape (population, dim)
        Points to be evaluated.
    """
    points = _sobol_points(task)
    while True:
        z = np.array([next(points) for _ in range(population)])
        yield task.clip(task.lo + (task.hi - task.lo) * z)


def _sobol_points(task: Task) -> Iterator[Array]:
    from scipy.stats import qmc  # takes longer to load than the rest of the package

    engine = qmc.Sobol(task.dim, rng=task.rng)
    while True:
        yield from engine.random(BLOCK)


def differential_evolution(
    task: Task, *, popsize: int = 15, strategy: str = "best1bin", tol: float = 1e-12
) -> Moves:
    """Run DE with the defaults of SciPy, but whole generations at once, no early stop, no polish.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    popsize : int
        Population as a multiple of the dimension.
    strategy : str
        Name of the mutation.
    tol : float
        Relative spread of the fitness at which it starts again.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    optimize = _optimize()

    def call(f: Callable[[Array], Array]) -> None:
        while True:
            optimize.differential_evolution(
                lambda x: f(task.clip(x.T)),
                optimize.Bounds(task.lo, task.hi),
                strategy=strategy,
                popsize=popsize,
                tol=tol,
                maxiter=task.budget,
                polish=False,
                rng=task.rng,
                updating="deferred",
                vectorized=True,
            )

    return inverted(task, call, endless=True)


def dual_annealing(task: Task) -> Moves:
    """Run generalised simulated annealing with local searches, with the defaults of SciPy.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    optimize = _optimize()

    def call(f: Callable[[Array], Array]) -> None:
        while True:
            optimize.dual_annealing(
                lambda x: float(finite(f(task.clip(x)[None]))[0]),
                optimize.Bounds(task.lo, task.hi),
                maxiter=task.budget,
                maxfun=2 * task.budget,
                rng=task.rng,
            )

    return inverted(task, call, endless=True)


def nelder_mead(task: Task, *, xatol: float = 1e-10, fatol: float = 1e-12) -> Moves:
    """Run Nelder-Mead from uniform starts.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    xatol, fatol : float
        Size and spread of the simplex at which it starts again.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    return _from_many_starts(
        task, "Nelder-Mead", {"xatol": xatol, "fatol": fatol, "maxfev": task.budget}
    )


def slsqp(task: Task, *, ftol: float = 1e-12) -> Moves:
    """Run sequential quadratic programming from uniform starts; a gradient is one batch.

    Parameters
    ----------
    task : Task
        Box, random numbers, budget.
    ftol : float
        Progress at which it starts again.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    return _from_many_starts(task, "SLSQP", {"ftol": ftol}, gradient=True)


def _from_many_starts(
    task: Task, method: str, options: dict[str, float], *, gradient: bool = False
) -> Moves:
    optimize = _optimize()

    def call(f: Callable[[Array], Array]) -> None:
        def unit(z: Array) -> Array:
            return finite(f(task.clip(task.lo + (task.hi - task.lo) * z)))

        last: dict[bytes, float] = {}  # a gradient uses the value that was found just before

        def value(z: Array) -> float:
            last.clear()
            last[z.tobytes()] = found = float(unit(z[None])[0])
            return found

        def slope(z: Array) -> Array:
            base = last[z.tobytes()] if z.tobytes() in last else value(z)
            step = np.where(z < 0.5, STEP, -STEP)  # away from the nearer wall
            return np.asarray((unit(z + np.diag(step)) - base) / step)

        bounds = optimize.Bounds(np.zeros(task.dim), np.ones(task.dim))
        jac = slope if gradient else None
        while True:
            start = task.rng.random(task.dim)
            optimize.minimize(value, start, method=method, jac=jac, bounds=bounds, options=options)

    return inverted(task, call, endless=True)
