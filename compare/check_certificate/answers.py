"""The two answers beside "certified": the proof does not hold, or the file is no certificate."""

from __future__ import annotations


class Refused(Exception):  # noqa: N818  # an answer, not a failure
    """The proof does not hold; the message says where."""


class BadInput(Exception):  # noqa: N818
    """The file is no certificate; the message says why."""


def need(holds: object, reason: str) -> None:
    """Refuse the certificate unless a statement holds.

    Parameters
    ----------
    holds : object
        The statement; a comparison of balls is true only if it is so for all their numbers.
    reason : str
        What does not hold.

    Raises
    ------
    Refused
        If the statement does not hold.
    """
    if not holds:
        raise Refused(reason)
