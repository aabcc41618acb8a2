"""Any algorithm by its name: of the registry, of another library, or somebody's own."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from functools import partial
from typing import Any, NamedTuple

from metaheuristics.driver.plug_in import UnknownAlgorithmError, defaults, plug_in
from metaheuristics.driver.task import Moves
from metaheuristics.entry import Algorithm
from metaheuristics.libraries import mealpy_, minion_, nevergrad_, pymoo_
from metaheuristics.libraries.shared import library
from metaheuristics.registry import ALGORITHMS, NOT_REPRODUCIBLE


class Library(NamedTuple):
    """A library of optimisers: its distribution, what runs one, finds one or raises, and lists all."""

    distribution: str
    search: Callable[..., Moves]
    find: Callable[[str], Any]
    names: Callable[[], list[str]]


LIBRARIES = {
    "mealpy": Library("mealpy", mealpy_.mealpy, mealpy_.find, mealpy_.names),
    "pymoo": Library("pymoo", pymoo_.pymoo, pymoo_.find, pymoo_.names),
    "nevergrad": Library("nevergrad", nevergrad_.nevergrad, nevergrad_.find, nevergrad_.names),
    "minion": Library("minionpy", minion_.minion, minion_.find, minion_.names),
}


def algorithm(name: str) -> Algorithm:
    """Return the algorithm of this name.

    Parameters
    ----------
    name : str
        A name of `ALGORITHMS`; ``library:Name`` with mealpy, pymoo, nevergrad or minion; or
        ``module:function`` for an optimiser of your own, which is described by a process of its own and
        not imported here.

    Returns
    -------
    Algorithm
        Run it by ``minimise(a.search(), f, ..., **a.parameters)``.

    Raises
    ------
    UnknownAlgorithmError
        Nothing goes by this name, or the plug-in cannot be loaded; the message says why.
    MissingLibraryError
        Its library is not installed; the message says how to install it.

    Examples
    --------
    >>> from metaheuristics import algorithm
    >>> algorithm("whale").parameters
    {'population': 50, 'b': 1.0}
    >>> algorithm("ipso")
    Traceback (most recent call last):
        ...
    metaheuristics.driver.plug_in.UnknownAlgorithmError: ipso is not reproducible: ...
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
    if place in LIBRARIES:
        return _of_library(place, attribute)
    function, parameters = plug_in(name)
    return Algorithm(name, "plugged in", name, function, parameters, "rivals", trusted=False)


def _of_library(place: str, attribute: str) -> Algorithm:
    """Return an optimiser of a library; raises `UnknownAlgorithmError` if it has none of this name."""
    distribution, search, find, names = LIBRARIES[place]
    library(distribution)
    try:
        find(attribute)
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        hint = _hint(place, attribute, names())
        raise UnknownAlgorithmError(f"{place}:{attribute} is not known: {error}{hint}") from None
    bound = partial(search, attribute)
    title = f"{attribute} of {distribution}"
    return Algorithm(
        f"{place}:{attribute}", title, distribution, bound, defaults(bound), "rivals", (distribution,)
    )


def _hint(place: str, attribute: str, names: list[str]) -> str:
    """Names of the library that hold what was typed, the shortest first; else those that are near it."""
    holding = [name for name in names if attribute and attribute.lower() in name.lower()]
    holding.sort(key=lambda name: (name != f"Original{attribute}", len(name), name))
    near = holding[:4] or get_close_matches(attribute, names, 3)
    return f"; did you mean {' or '.join(f'{place}:{name}' for name in near)}?" if near else ""
