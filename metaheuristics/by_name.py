"""Any algorithm by its name: published, of another library, or somebody's own."""

from __future__ import annotations

from functools import partial

from metaheuristics.driver.plug_in import UnknownAlgorithmError, plug_in
from metaheuristics.entry import Algorithm, defaults
from metaheuristics.libraries import mealpy_, pymoo_
from metaheuristics.libraries.shared import library
from metaheuristics.libraries.minion_ import minion
from metaheuristics.libraries.nevergrad_ import nevergrad
from metaheuristics.registry import ALGORITHMS, NOT_REPRODUCIBLE

LIBRARIES = {
    "mealpy": ("mealpy", mealpy_.mealpy),
    "pymoo": ("pymoo", pymoo_.pymoo),
    "nevergrad": ("nevergrad", nevergrad),
    "minion": ("minionpy", minion),
}


def algorithm(name: str) -> Algorithm:
    """Return the algorithm of this name: of `ALGORITHMS`, ``library:Name``, or ``module:function``.

    Raises `UnknownAlgorithmError`, or `MissingLibraryError` if its library is not installed.
    """
    if name in ALGORITHMS:
        found = ALGORITHMS[name]
        for distribution in found.libraries:
            library(distribution)
        return found
    if name in NOT_REPRODUCIBLE:
        raise UnknownAlgorithmError(f"{name} is not reproducible: {NOT_REPRODUCIBLE[name].reason}")
    place, _, attribute = name.partition(":")
    if not place or not attribute:
        known = f"known: {', '.join(ALGORITHMS)}; or library:Name; or module:function"
        raise UnknownAlgorithmError(f"{name!r} is not known ({known})")
    if place not in LIBRARIES:
        function = plug_in(name)
        return Algorithm(name, "plugged in", name, function, defaults(function), "rivals")
    _require(place, attribute)
    distribution, search = LIBRARIES[place]
    bound = partial(search, attribute)
    title = f"{attribute} of {distribution}"
    return Algorithm(name, title, distribution, bound, defaults(bound), "rivals", (distribution,))


def _require(place: str, attribute: str) -> None:
    """Raises `UnknownAlgorithmError` if a library has nothing of this name."""
    there = library(LIBRARIES[place][0])
    try:
        if place == "pymoo":
            pymoo_.find(attribute)
        elif place == "mealpy":
            mealpy_.find(attribute)
        elif place == "nevergrad":
            there.optimizers.registry[attribute]
        elif not issubclass(getattr(there, attribute), there.MinimizerBase):
            raise AttributeError(f"{attribute} is no minimiser")
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise UnknownAlgorithmError(f"{place}:{attribute} is not known: {error}") from None
