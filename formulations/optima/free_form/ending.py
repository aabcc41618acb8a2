"""How the search for the fastest motion ended."""

from __future__ import annotations

from enum import StrEnum


class SearchStatus(StrEnum):
    """How the search for the fastest motion ended."""

    OK = "ok"  # a local solve converged to the time of the motion, within the tolerance
    NOT_CONVERGED = "not converged"  # the motion is verified, but no local solve converged to its time
    TIME_LIMIT = "time limit"  # the time limit ended the search; the motion is the best verified so far
    INTERRUPTED = "interrupted"  # somebody ended the search; the motion is the best verified so far


class SearchEnded(Exception):  # noqa: N818  # the time is over, which is no error
    """The deadline is over: the search takes no further step."""
