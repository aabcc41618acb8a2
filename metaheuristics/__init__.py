"""Metaheuristics for any f on a box, behind one driver that counts evaluations and keeps the best.

`minimise` runs an algorithm; `algorithm` finds one by its name; `ALGORITHMS` holds those of the papers and the
controls; `apart` runs one in a process of its own.  ``driver`` holds the judge of algorithms, ``swarms``
one file per published variant, ``libraries`` the adapters of SciPy, cmaes, mealpy, pymoo, nevergrad and
minionpy.

Conventions, for whatever a paper leaves open:

- every evaluation counts, the first population, mutants and scouts included; k/K of the papers is
  evaluations used / budget at the time of the move;
- random numbers are drawn per coordinate, unless the file of the algorithm says otherwise;
- positions are clipped to the box, and velocities stay as they are there;
- velocities start at zero and are clamped to +-0.2 (hi - lo) per coordinate;
- updates are synchronous: a population moves, then it is evaluated, then the bests are renewed;
- a best is replaced only by something strictly better; +inf is never better than anything, so a swarm
  that has found nothing feasible follows its first particle.
"""

from metaheuristics.by_name import algorithm
from metaheuristics.driver.archive import Result
from metaheuristics.driver.isolation import apart
from metaheuristics.driver.judge import minimise
from metaheuristics.driver.plug_in import UnknownAlgorithmError
from metaheuristics.driver.task import ObjectiveError, Status, Task, TaskError
from metaheuristics.entry import GROUPS, TIME_LIMIT, Algorithm, NotReproducible
from metaheuristics.libraries.shared import MissingLibraryError
from metaheuristics.registry import ALGORITHMS, NOT_REPRODUCIBLE

__all__ = [
    "ALGORITHMS",
    "GROUPS",
    "NOT_REPRODUCIBLE",
    "TIME_LIMIT",
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
