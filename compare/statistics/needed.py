"""The libraries behind the tests, and the message that says how to install the one that is missing."""

from __future__ import annotations

import importlib
from typing import Any

EXTRA = "grade"
_DISTRIBUTIONS = {
    "statsmodels": "statsmodels",
    "scikit_posthocs": "scikit-posthocs",
    "baycomp": "baycomp",
}


class MissingStatisticsError(ImportError):
    """A library of the extra ``grade`` is not installed; the message says how to install it."""


def needed(module: str) -> Any:
    """Return a library of the extra ``grade``, or one module of it.

    Parameters
    ----------
    module : str
        Full name of the module.

    Returns
    -------
    module

    Raises
    ------
    MissingStatisticsError
        Its library is not installed.
    """
    library = module.partition(".")[0]
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != library:
            raise  # something that the library itself needs
        raise MissingStatisticsError(
            f"{_DISTRIBUTIONS[library]} is not installed: pip install 'timebound[{EXTRA}]'"
        ) from None


def all_present() -> None:
    """Make sure that every library of the extra is there, before anything is computed.

    Raises
    ------
    MissingStatisticsError
        One is not installed.
    """
    for library in _DISTRIBUTIONS:
        needed(library)
