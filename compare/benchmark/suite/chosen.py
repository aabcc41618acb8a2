"""The instances that somebody names: shipped cases, and problem files of their own."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from compare.benchmark.suite.catalogue import suite
from compare.benchmark.suite.instance import Instance, Split
from formulations import CASES, InputError, load

_NAME = re.compile(r"[\w][\w .+()-]{0,79}")


def chosen(names: Iterable[str]) -> list[Instance]:
    """Return the instances behind names of cases and paths of problem files.

    Parameters
    ----------
    names : iterable of str

    Returns
    -------
    list of Instance
        In the order given.

    Raises
    ------
    InputError
        If a file cannot be read, its problem has conditions, or two instances have one name.
    """
    found: dict[str, Instance] = {}
    for text in names:
        one = _shipped(text) if text in CASES else _own(text)
        if one.name in found:
            raise InputError(f"--cases: {text}: there are two instances of the name {one.name!r}")
        found[one.name] = one
    return list(found.values())


def _shipped(case: str) -> Instance:
    return next(one for one in suite(len(CASES)) if one.name == case)


def _own(path: str) -> Instance:
    problem = load(path)
    problem.require_plain(f"--cases: {path}: the comparison of swarms")
    name = problem.name
    if name in CASES:
        raise InputError(f"--cases: {path}: name: {name!r} is that of a shipped case; give it another")
    if not _NAME.fullmatch(name):
        raise InputError(
            f"--cases: {path}: name: {name!r} names files too; use letters, digits, space and . + - ( )"
        )
    return Instance(name, replace(problem, name=name), Split.own, "file", problem.source or path)
