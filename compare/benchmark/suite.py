"""What is compared: cases, swarms, codings, seeds and budgets of a default, quick and full run."""

from __future__ import annotations

from dataclasses import dataclass

from compare.benchmark.grade import Run
from compare.benchmark.objective import CODINGS
from formulations import CASES, load
from metaheuristics import ALGORITHMS


@dataclass(frozen=True)
class Budget:
    """Size of a search: its population, and how many iterations follow the first population."""

    population: int
    iterations: int

    @property
    def evaluations(self) -> int:
        """Number of evaluations; those of the first population count too."""
        return self.population * (self.iterations + 1)


# Wang 2025, Table 7; Li 2022, sec. 3; Zhou 2025, sec. 5.2; Zhang 2025, sec. 3.2; Lu 2024, sec. 3.2
PAPER_BUDGETS: dict[str, Budget] = {
    "sr4c": Budget(50, 50),
    "bagging": Budget(20, 200),
    "ur5": Budget(1000, 50),
    "ur5-corrected": Budget(1000, 50),
    "cobot": Budget(20, 200),
    "z1": Budget(30, 500),
}
DEFAULT_BUDGET = Budget(50, 50)
QUICK_BUDGET = Budget(20, 20)

SEEDS = {"default": 5, "quick": 2, "full": 30}

# unless swarms are named, those of the papers and a few controls run; rival libraries only on demand
QUICK_SWARMS = [
    "pso", "mipso", "mpso", "pso-zhang-2025", "sparrow", "issa", "whale", "whale-lu-2024", "random", "de",
]  # fmt: skip
DEFAULT_CONTROLS = ["random", "de", "cma-es"]
FULL_CONTROLS = ["random", "sobol", "de", "cma-es", "annealing", "nelder-mead", "slsqp"]
RIVALS = ["lshade", "mealpy:OriginalPSO", "mealpy:OriginalWOA", "pymoo:PSO", "nevergrad:NGOpt"]


def swarms_of(size: str) -> list[str]:
    """Return the names of the swarms of a run of this size.

    Parameters
    ----------
    size : str
        ``default``, ``quick`` or ``full``.

    Returns
    -------
    list of str
    """
    if size == "quick":
        return QUICK_SWARMS
    papers = [name for name, entry in ALGORITHMS.items() if entry.group != "controls"]
    return papers + (FULL_CONTROLS if size == "full" else DEFAULT_CONTROLS)


def quick_cases() -> list[str]:
    """Names of all cases but the B-splines, whose optimum takes longer than a quick run may."""
    return [case for case in CASES if not load(case).family.startswith("b-spline")]


def runs(
    *,
    size: str = "default",
    cases: list[str] | None = None,
    swarms: list[str] | None = None,
    codings: list[str] | None = None,
    seeds: int | None = None,
    evaluations: int | None = None,
    seconds: float | None = None,
) -> list[Run]:
    """List the runs of one comparison, in a fixed order.

    Parameters
    ----------
    size : str
        ``default``, ``quick`` or ``full``; it decides whatever is None below.
    cases, swarms, codings : list of str, optional
        Names; all cases, all codings, and the swarms of the size if left out.
    seeds : int, optional
        Number of seeds.
    evaluations : int, optional
        Budget of each search.
    seconds : float, optional [s]
        Time limit of a search in a process of its own, for every swarm.

    Returns
    -------
    list of Run
    """
    listed = []
    for case in cases if cases is not None else CASES:
        budget = DEFAULT_BUDGET
        if size == "quick":
            budget = QUICK_BUDGET
        elif size == "full":
            budget = PAPER_BUDGETS.get(case, DEFAULT_BUDGET)
        for coding in codings if codings is not None else CODINGS:
            for swarm in swarms if swarms is not None else swarms_of(size):
                for seed in range(seeds if seeds is not None else SEEDS[size]):
                    total = evaluations or budget.evaluations
                    run = Run(case, coding, swarm, seed, total, budget.population, seconds)
                    listed.append(run)
    return listed
