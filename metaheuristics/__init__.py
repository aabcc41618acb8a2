"""Metaheuristics for any f on a box, behind one driver that counts and keeps the score.

Conventions, for whatever a paper leaves open:

- every evaluation counts, the first population, mutants and scouts included, and the papers' k/K is
  evaluations used / budget at the time of the move;
- random numbers are drawn per coordinate, unless the algorithm's file says otherwise;
- positions are clipped to the box, velocities are left as they are there;
- velocities start at zero and are clamped to +-0.2 (hi - lo) per coordinate;
- updates are synchronous: a population moves, then it is evaluated, then bests are renewed;
- a best is replaced by the strictly better only; +inf is never better than anything, so a swarm
  that has seen nothing finite follows its first particle.
"""

from metaheuristics.by_name import algorithm
from metaheuristics.driver.archive import Result
from metaheuristics.driver.isolation import apart
from metaheuristics.driver.judge import minimise
from metaheuristics.driver.plug_in import UnknownAlgorithmError
from metaheuristics.driver.task import ObjectiveError, Status, Task, TaskError
from metaheuristics.entry import GROUPS, Algorithm, NotReproducible
from metaheuristics.libraries.shared import MissingLibraryError
from metaheuristics.registry import ALGORITHMS, NOT_REPRODUCIBLE

__all__ = [
    "ALGORITHMS",
    "GROUPS",
    "NOT_REPRODUCIBLE",
    "Algorithm",
    "MissingLibraryError",
    "NotReproducible",
    "ObjectiveError",
    "Result",
    "Status",
    "Task",
    "TaskError",
    "UnknownAlgorithmError",
    "algorithm",
    "apart",
    "minimise",
]
