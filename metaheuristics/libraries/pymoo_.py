"""Single-objective optimisers of pymoo by class name."""

from __future__ import annotations

import pkgutil
import re
from pathlib import Path
from typing import Any

import numpy as np

from metaheuristics.driver.task import Moves, Task
from metaheuristics.libraries.shared import finite, library, seed_of

FOLDER = "pymoo.algorithms.soo.nonconvex"


def pymoo(name: str, task: Task, *, population: int = 50) -> Moves:
    """Run a single-objective optimiser of pymoo with its own defaults.

    Parameters
    ----------
    name : str
        Name of its class.
    task : Task
        Box, random numbers, budget.
    population : int
        Population size.

    Returns
    -------
    Moves
        Points to be evaluated, a batch at a time.
    """
    evaluator = library("pymoo", "pymoo.core.evaluator").Evaluator(skip_already_evaluated=False)
    static = library("pymoo", "pymoo.problems.static").StaticProblem
    problem = library("pymoo", "pymoo.core.problem").Problem(
        n_var=task.dim, n_obj=1, xl=task.lo, xu=task.hi
    )
    search = find(name)(pop_size=population)
    search.setup(problem, termination=("n_eval", task.budget), seed=seed_of(task), verbose=False)
    while search.has_next():
        points = search.ask()
        fitness = yield task.clip(np.atleast_2d(np.asarray(points.get("X"), dtype=np.float64)))
        evaluator.eval(static(problem, F=finite(fitness)[:, None]), points)
        search.tell(infills=points)
    return None


def find(name: str) -> Any:
    """Return a single-objective optimiser of pymoo.

    Parameters
    ----------
    name : str
        Name of its class.

    Returns
    -------
    Any
        The class.

    Raises
    ------
    AttributeError
        There is none.
    """
    folder = library("pymoo", FOLDER)
    for module in pkgutil.iter_modules(folder.__path__):
        # its text is read before it is imported: some modules need libraries that others do not
        source = Path(folder.__path__[0], f"{module.name}.py")
        if source.exists() and f"class {name}(" in source.read_text("utf-8"):
            return getattr(library("pymoo", f"{FOLDER}.{module.name}"), name)
    raise AttributeError(f"pymoo has no {name} in {FOLDER}")


def names() -> list[str]:
    """Return the names of all of them.

    Returns
    -------
    list of str
    """
    folder = Path(library("pymoo", FOLDER).__path__[0])
    texts = (path.read_text("utf-8") for path in sorted(folder.glob("*.py")))
    return [name for text in texts for name in re.findall(r"^class (\w+)\(", text, re.MULTILINE)]
