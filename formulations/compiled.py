"""Compilation by numba, and functions that are interpreted until compiling them pays.

The compiler takes ten seconds for a proof that runs in a hundredth of a second. Its code is kept on disk, so
that only a first run pays. ``Late`` follows the ski-rental rule: it interprets a function until the time
spent equals that of a compilation, and then compiles it. It is for functions of + - * / and square roots,
which give the same bits either way.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from types import FunctionType
from typing import Any

import numpy as np
from numba import njit
from numba.core.dispatcher import Dispatcher

# IEEE division: a candidate with a zero duration is infeasible (inf or NaN), not an exception
compiled = njit(cache=True, error_model="numpy")
# a part of one compiled function: inlined, as passing large named tuples takes time
inlined = njit(inline="always", error_model="numpy")

_PATIENCE = 5.0  # s of interpretation that are worth a compilation


def interpreted(function: Any) -> Callable[..., Any]:
    """Return a compiled function, and the compiled functions that it calls, as plain Python.

    Parameters
    ----------
    function : callable
        What ``compiled`` returned.

    Returns
    -------
    callable
        With the same arguments.
    """
    source = function.py_func if isinstance(function, Dispatcher) else function
    scope = dict(source.__globals__)
    for name in source.__code__.co_names:
        if isinstance(scope.get(name), Dispatcher):
            scope[name] = interpreted(scope[name])
    return FunctionType(source.__code__, scope, source.__name__, source.__defaults__)


class Late:
    """A compiled function that is interpreted until compiling it pays.

    Parameters
    ----------
    function : callable
        What ``compiled`` returned.
    """

    def __init__(self, function: Any) -> None:
        self._compiled = function
        self._spent = np.inf if _on_disk(function) else 0.0

    @cached_property
    def _plain(self) -> Callable[..., Any]:
        return interpreted(self._compiled)

    def __call__(self, *arguments: Any) -> Any:
        """Call the function."""
        if self._spent >= _PATIENCE:
            return self._compiled(*arguments)
        started = time.perf_counter()
        with np.errstate(all="ignore"):
            answer = self._plain(*arguments)
        self._spent += time.perf_counter() - started
        return answer


def _on_disk(function: Any) -> bool:
    """Whether an earlier run left machine code behind; the compiler replaces code that is out of date."""
    if not isinstance(function, Dispatcher):
        return True  # compilation is switched off
    folder = Path(str(function.stats.cache_path))
    source = function.py_func
    stem = f"{Path(source.__code__.co_filename).stem}.{source.__qualname__}"
    return any(folder.glob(f"{stem}-*.nbi"))
