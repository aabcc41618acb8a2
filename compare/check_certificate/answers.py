"""The answers but one: a proof that does not hold, a file that is none."""

from __future__ import annotations


class Refused(Exception):  # noqa: N818  # an answer, not a failure
    """The proof does not hold; the message says where."""


class BadInput(Exception):  # noqa: N818
    """Not a certificate."""


def need(holds: object, reason: str) -> None:
    """Refuse unless it holds."""
    if not holds:
        raise Refused(reason)
