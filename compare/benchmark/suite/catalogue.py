"""The list of instances: endless, and always the same; the first 60 are the suite.

The six cases of the papers come first. Of every nine that follow, two are perturbed cases and seven are
random problems of real arms. An instance keeps its name, its numbers and its split, however many are
asked for.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import count, islice

from compare.benchmark.suite.arms import arm_sheets
from compare.benchmark.suite.drawn import Recipe, drawn
from compare.benchmark.suite.instance import Instance, Split
from compare.benchmark.suite.perturbed import perturbed
from formulations import load

SIZE = 60
_OPEN = (2, 5)  # two in five are open: 24 of 60
_CYCLE, _PERTURBED = 9, (0, 4)  # places of perturbed cases in a cycle
_PAPERS = (
    "bagging",
    "cobot",
    "sr4c",
    "ur5",
    "ur5-corrected",
    "z1",
)  # a new case does not move the others
_CASES = ("sr4c", "bagging", "ur5-corrected", "cobot", "z1")
_FEWEST, _SIZES = 3, 6  # 3 to 8 segments


def suite(size: int = SIZE) -> list[Instance]:
    """Return the first instances.

    Parameters
    ----------
    size : int

    Returns
    -------
    list of Instance
    """
    return list(islice(_instances(), size))


def _instances() -> Iterator[Instance]:
    splits = _Splits()
    for case in _PAPERS:
        problem = load(case)
        split = splits.of(problem.family, case)
        yield Instance(case, problem, split, "paper", problem.source)
    perturbations, draws = count(), count()
    for place in count():
        number = len(_PAPERS) + place + 1
        if place % _CYCLE in _PERTURBED:
            case = _CASES[next(perturbations) % len(_CASES)]
            problem = perturbed(f"{number:02d}-{case}", case)
            origin = f"perturbed {case}"
        else:
            recipe = _recipe(next(draws))
            words = f"{number:02d}-{recipe.arm}-{recipe.family}-{recipe.segments}"
            problem = drawn(words + "j" * recipe.jerk + "p" * recipe.position, recipe)
            case, origin = recipe.arm, f"drawn {recipe.arm}"
        yield Instance(problem.name, problem, splits.of(problem.family, case), origin, problem.source)


def _recipe(index: int) -> Recipe:
    """Choose arm, family, segments and limits so that every pair of an arm and a family comes up.

    One in four is a B-spline.
    """
    arms = tuple(arm_sheets())
    slot, turn = (index + index // 20) % 4, index // 4
    spline = "b-spline-3" if (turn + turn // 2) % 2 == 0 else "b-spline-5"
    family = ("3-5-3", "4-3-4", "quintic", spline)[slot]
    segments = 3 if family == "3-5-3" else _FEWEST + (5 * turn + 2 * slot) % _SIZES
    jerk, position = turn % 2 == 0, (turn // 2 + slot) % 2 == 0
    return Recipe(arms[index % len(arms)], family, segments, jerk, position)


class _Splits:
    """Deals instances out so that each family and each arm has its share of open ones."""

    def __init__(self) -> None:
        self._seen: Counter[str] = Counter()
        self._open: Counter[str] = Counter()

    def of(self, family: str, arm: str) -> Split:
        """The split of the next instance."""
        keys = ("all", "all", f"family {family}", f"arm {arm}")
        self._seen.update(set(keys))
        part, of = _OPEN
        wanting = sum(part * self._seen[key] - of * self._open[key] for key in keys)
        if wanting * 2 < of * len(keys):
            return Split.held_out
        self._open.update(set(keys))
        return Split.open
