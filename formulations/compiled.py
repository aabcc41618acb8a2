"""Compiled formulas, and how a first run gets by without the compiler.

The compiler takes ten seconds for what a small proof does in a hundredth; its code is kept on disk, so
only a first run pays. ``Late`` is the ski-rental rule: interpret a function until the time spent is
worth a compilation, then compile it. It is for functions of + - * / and square roots, which give the
same bits either way.
"""

from __future__ import annotations

import time
from collections.abc import Callable
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
    """A compiled function, and the compiled functions it calls, as plain Python."""
    source = function.py_func if isinstance(function, Dispatcher) else function
    scope = dict(source.__globals__)
    for name in source.__code__.co_names:
        if isinstance(scope.get(name), Dispatcher):
            scope[name] = interpreted(scope[name])
    return FunctionType(source.__code__, scope, source.__name__, source.__defaults__)


class Late:
    """A compiled function that is interpreted until compiling it pays."""

    def __init__(self, function: Any) -> None:
        self._compiled = function
        self._plain: Callable[..., Any] | None = None
        self._spent = np.inf if _on_disk(function) else 0.0

    def __call__(self, *arguments: Any) -> Any:
        """The function's answer."""
        if self._spent >= _PATIENCE:
            return self._compiled(*arguments)
        if self._plain is None:
            self._plain = interpreted(self._compiled)
        started = time.perf_counter()
        with np.errstate(all="ignore"):
            answer = self._plain(*arguments)
        self._spent += time.perf_counter() - started
        return answer


def _on_disk(function: Any) -> bool:
    """Whether an earlier run left machine code behind; if it is out of date, it is made again."""
    if not isinstance(function, Dispatcher):
        return True  # compilation is switched off
    folder = Path(str(function.stats.cache_path))
    source = function.py_func
    stem = f"{Path(source.__code__.co_filename).stem}.{source.__qualname__}"
    return any(folder.glob(f"{stem}-*.nbi"))
