"""Safe text about unsafe objects: whatever an algorithm raised or claimed, as one printable line.

An exception of foreign code may refuse to be printed, may print a letter that no file can encode, or may
print ten million of them.  Every note of a `Result` that shows foreign text goes through this file.
"""

from __future__ import annotations

from typing import Any

from metaheuristics.driver.task import Fault, Status

LONGEST = 300  # characters of a text that are shown

_NAME: Any = type.__dict__["__name__"]  # the true name; a metaclass may hide it


def printable(text: str) -> str:
    """Return a text on one line, in characters that every screen and every encoding takes.

    Parameters
    ----------
    text : str
        Any text, also of a subclass of str whose methods raise.

    Returns
    -------
    str
        At most `LONGEST` characters and an ellipsis.  Runs of white space are one space, and control
        characters and lone surrogates are backslash escapes.
    """
    plain = str.__str__(text)
    line = " ".join(plain[: 2 * LONGEST].split())
    shown = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in line)
    cut = len(shown) > LONGEST or len(plain) > 2 * LONGEST
    return shown[:LONGEST] + "..." if cut else shown


def shown(value: object) -> str:
    """Return the representation of any object as one printable line.

    Parameters
    ----------
    value : object
        Anything, also an object whose ``__repr__`` raises.

    Returns
    -------
    str
        ``repr(value)`` made `printable`; the class in angle brackets if there is no representation.
    """
    try:
        return printable(repr(value))
    except BaseException:  # of the object
        return f"<{_kind(value)}>"


def reason(error: BaseException) -> str:
    """Return type and message of any exception as one printable line.

    Parameters
    ----------
    error : BaseException
        Any exception, also one whose ``__str__`` raises.

    Returns
    -------
    str
        ``"Type: message"``, made `printable`; the type alone if there is no message.
    """
    try:
        message = printable(str(error))
    except BaseException:  # of the exception's own code
        message = "(its message cannot be read)"
    return f"{_kind(error)}: {message}" if message else _kind(error)


def fault_of(error: BaseException) -> Fault:
    """Return the fault that an exception out of an algorithm stands for.

    Parameters
    ----------
    error : BaseException
        What an algorithm let out: a `Fault` of the driver's own adapters, a forged one, or anything.

    Returns
    -------
    Fault
        A new one with a `Status` and a printable note, whatever ``error`` holds.
    """
    if type(error) is Fault:  # a subclass may define what its attributes are
        status, note = getattr(error, "status", None), getattr(error, "note", None)
        if type(status) is Status and isinstance(note, str):
            return Fault(status, printable(note))
    kind = type(error)  # the true one; `isinstance` believes `__class__`
    return Fault(Status.exited if issubclass(kind, SystemExit) else Status.raised, reason(error))


def _kind(value: object) -> str:
    return printable(_NAME.__get__(type(value)))
