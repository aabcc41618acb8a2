"""The library toppra, loaded without matplotlib.

toppra imports pyplot for plots of its own, which nobody here draws, and that takes longer than most
solves. While toppra is imported, stand-ins take the place of the two modules: they load the real ones
when something of them is used, so toppra's plots still work.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import Any

_PLOTTING = ("matplotlib", "matplotlib.pyplot")


class _LoadedOnUse(ModuleType):
    """Stands for a module until something of it is used."""

    def __getattr__(self, name: str) -> Any:
        """Look the name up in the module itself."""
        return getattr(import_module(self.__name__), name)


def _without_plotting() -> ModuleType:
    if any(name in sys.modules for name in _PLOTTING):
        return import_module("toppra")
    library, pyplot = stand_ins = [_LoadedOnUse(name) for name in _PLOTTING]
    vars(library)["pyplot"] = pyplot
    sys.modules.update(zip(_PLOTTING, stand_ins, strict=True))
    try:
        return import_module("toppra")
    finally:
        for name in _PLOTTING:
            del sys.modules[name]


toppra: Any = _without_plotting()
