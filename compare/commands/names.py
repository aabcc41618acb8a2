"""Names that are typed: looked up, with the nearest known one where there is none of that name.

A name that cannot be used raises ValueError; ``compare.__main__`` turns it into one line that names the option.
"""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


def known(name: str, names: Iterable[str]) -> str:
    """Look a name up.

    Parameters
    ----------
    name : str
        What was typed.
    names : iterable of str
        The names there are.

    Returns
    -------
    str
        The name.

    Raises
    ------
    ValueError
        It is none of them; the message holds the nearest one and all of them.
    """
    names = list(names)
    if name in names:
        return name
    near = get_close_matches(name, names, 1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    raise ValueError(f"{name!r} is not known{hint} (known: {', '.join(names)})")


def several(text: str, names: Iterable[str]) -> tuple[str, ...]:
    """Read a comma-separated choice among known names.

    Parameters
    ----------
    text : str
        What was typed.
    names : iterable of str
        The names there are.

    Returns
    -------
    tuple of str
        The names chosen, each once, in the order typed.

    Raises
    ------
    ValueError
        One of them is not known, or none is given.
    """
    names = list(names)
    wanted = [name.strip() for name in text.split(",") if name.strip()]
    if not wanted:
        raise ValueError(f"none given (known: {', '.join(names)})")
    return tuple(dict.fromkeys(known(name, names) for name in wanted))


def found_swarms(text: str) -> tuple[str, ...]:
    """Read a comma-separated choice of algorithms, and load each one.

    Parameters
    ----------
    text : str
        Names of the registry, ``library:Name``, ``module:function`` or ``FILE.py:function``.

    Returns
    -------
    tuple of str
        The names, each once, in the order typed; a file is named by its module.

    Raises
    ------
    ValueError
        There is none of a name, with the reason, or its library is missing.
    """
    from compare.grading.names import swarm_name
    from metaheuristics import (
        ALGORITHMS,
        NOT_REPRODUCIBLE,
        MissingLibraryError,
        UnknownAlgorithmError,
    )

    wanted = tuple(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    if not wanted:
        raise ValueError(f"none given (known: {', '.join(ALGORITHMS)})")
    found = []
    for name in wanted:
        try:
            found.append(swarm_name(name))
        except (UnknownAlgorithmError, MissingLibraryError) as error:
            if ":" not in name and ".py" not in name and name not in NOT_REPRODUCIBLE:
                known(name, ALGORITHMS)  # says which name is near
            raise ValueError(str(error)) from error
    return tuple(dict.fromkeys(found))
