"""Optimisers whose claims, exceptions and points are traps for whoever reads them.

Each is a plain generator function of this module, so that it can run in a process of its own too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from metaheuristics.driver.task import Array, Fault, Moves, Status, Task


class Bomb:
    """An object that raises whatever anybody does with it."""

    def __init__(self, error: BaseException) -> None:
        self.error = error

    def _raise(self, *_: object) -> Any:
        raise self.error

    __float__ = __str__ = __repr__ = __len__ = __iter__ = __array__ = __bool__ = __eq__ = _raise
    __hash__ = None  # type: ignore[assignment]


class Lying:
    """An object that calls itself a tuple."""

    @property  # type: ignore[misc]
    def __class__(self) -> type:
        """Lie."""
        return tuple


class Tuple(tuple[Any, ...]):
    """A tuple that lies about its length and its second entry."""

    __slots__ = ()

    def __len__(self) -> int:
        """Say two, whatever there is."""
        return 2

    def __getitem__(self, key: Any) -> Any:
        """Raise instead."""
        raise ZeroDivisionError


class Shouting(str):
    """A text whose methods raise."""

    __slots__ = ()

    def _raise(self, *_: object, **__: object) -> Any:
        raise ZeroDivisionError

    split = encode = __format__ = __len__ = __iter__ = translate = isprintable = _raise  # type: ignore[assignment]


class Mute(Exception):  # noqa: N818
    """An exception whose text cannot be had."""

    def __str__(self) -> str:
        """Raise instead."""
        raise ZeroDivisionError


class Numeric(Exception):  # noqa: N818
    """An exception whose text is no text."""

    def __str__(self) -> str:
        """Return bytes."""
        return b"bytes"  # type: ignore[return-value]


class Deep(Exception):  # noqa: N818
    """An exception whose text asks for its own text."""

    def __str__(self) -> str:
        """Recurse."""
        return f"{self}"


class Quiet(Exception):  # noqa: N818
    """An exception whose text is a trap itself."""

    def __str__(self) -> str:
        """Return a text whose methods raise."""
        return Shouting("quiet")


class Nameless(type):
    """A class of classes whose name cannot be had."""

    @property
    def __name__(cls) -> str:
        """Raise instead."""
        raise ZeroDivisionError


class Masked(Exception, metaclass=Nameless):  # noqa: N818
    """An exception that hides its name and pretends to be a fault."""

    @property  # type: ignore[misc]
    def __class__(self) -> type:
        """Lie."""
        return Fault


class Forged(Fault):
    """A fault whose status cannot be read."""

    def __init__(self) -> None:
        Exception.__init__(self, "forged")

    @property
    def status(self) -> Status:  # type: ignore[override]
        """Raise instead."""
        raise ZeroDivisionError


def _stop() -> BaseException:
    return SystemExit(Bomb(ValueError("no code")))


EXCEPTIONS: dict[str, Callable[[], BaseException]] = {
    "__str__ raises": Mute,
    "__str__ gives bytes": Numeric,
    "__str__ never ends": Deep,
    "__str__ gives a trap": Quiet,
    "a class without a name": Masked,
    "a lone surrogate": lambda: ValueError("\ud800 half a letter"),
    "a NUL and an escape": lambda: ValueError("\x00 \x1b[31m red"),
    "a line separator": lambda: ValueError("one\u2028two\r\nthree"),
    "a huge text": lambda: ValueError("x" * 10_000_000),
    "a fault with a text for a status": lambda: Fault("ok", "all is well"),  # type: ignore[arg-type]
    "a fault with a trap for a note": lambda: Fault(Status.raised, Bomb(ValueError())),  # type: ignore[arg-type]
    "a fault with a status that raises": Forged,
    "KeyboardInterrupt": KeyboardInterrupt,
    "GeneratorExit": GeneratorExit,
    "SystemExit with a trap for a code": _stop,
    "MemoryError": MemoryError,
    "BaseException": BaseException,
    "a group": lambda: BaseExceptionGroup("many", [Mute(), KeyboardInterrupt()]),
}

CLAIMS: dict[str, Callable[[], Any]] = {
    "10**400": lambda: 10**400,
    "-10**400": lambda: -(10**400),
    "an integer of a million digits": lambda: 1 << 3_000_000,
    "__float__ raises": lambda: Bomb(ZeroDivisionError()),
    "__float__ raises KeyboardInterrupt": lambda: Bomb(KeyboardInterrupt()),
    "__float__ raises SystemExit": lambda: Bomb(SystemExit(0)),
    "a lone surrogate": lambda: "\udfff",
    "a text that is a trap": lambda: Shouting("trap"),
    "bytes": lambda: b"\xff\xfe",
    "a complex number": lambda: 1j,
    "None": lambda: None,
    "NaN": lambda: np.float32("nan"),
    "not a time": lambda: np.datetime64("NaT"),
    "an array of objects": lambda: _objects((1,), Bomb(ValueError())),
    "a trap in an array of no dimension": lambda: _objects((), Bomb(ValueError())),
    "an array of three": lambda: np.arange(3.0),
    "a list that holds itself": lambda: _circle(),
    "a class": lambda: Bomb,
}

RETURNED: dict[str, Callable[[], Any]] = {
    "an object that calls itself a tuple": Lying,
    "a tuple that lies": lambda: Tuple((1, 2)),
    "a tuple that lies about its length": lambda: Tuple(()),
    "a trap": lambda: Bomb(ZeroDivisionError()),
    "a tuple of three": lambda: (1, 2, 3),
}

POINTS: dict[str, Callable[[], Any]] = {
    "a trap": lambda: Bomb(ZeroDivisionError()),
    "a trap that interrupts": lambda: Bomb(KeyboardInterrupt()),
    "a trap that exits": lambda: Bomb(SystemExit(0)),
    "an array of traps": lambda: _objects((1, 3), Bomb(KeyboardInterrupt())),
    "no dimension": lambda: np.array(3.0),
    "a time": lambda: np.datetime64("NaT"),
    "complex numbers": lambda: np.ones((2, 3)) * 1j,
    "letters": lambda: np.array([["\ud800"] * 3]),
    "large integers": lambda: [[10**400] * 3],
    "an object that calls itself a tuple": Lying,
}

SPOILS: dict[str, Callable[[Any], None]] = {
    "another shape": lambda fitness: setattr(fitness, "shape", (2, 2)),
    "times": lambda fitness: setattr(fitness, "dtype", "M8[s]"),
    "letters": lambda fitness: setattr(fitness, "dtype", "S8"),
    "records": lambda fitness: setattr(fitness, "dtype", [("a", "<f8")]),
    "integers": lambda fitness: setattr(fitness, "dtype", "<i8"),
    "nothing": lambda fitness: fitness.resize(0, refcheck=False),
}


def _objects(shape: tuple[int, ...], entry: object) -> Any:
    array = np.empty(shape, dtype=object)
    for index in np.ndindex(shape):
        array[index] = entry
    return array


def _circle() -> list[Any]:
    ring: list[Any] = []
    ring.append(ring)
    return ring


def raiser(task: Task, *, what: str) -> Moves:
    """Raise one of `EXCEPTIONS` after four points."""
    yield task.sample(4)
    raise EXCEPTIONS[what]()


def claimer(task: Task, *, what: str) -> Moves:
    """Claim one of `CLAIMS` as the fitness that it found."""
    yield task.sample(4)
    return task.lo, CLAIMS[what]()


def returner(task: Task, *, what: str) -> Moves:
    """Return one of `RETURNED`."""
    yield task.sample(4)
    return RETURNED[what]()


def pointer(task: Task, *, what: str) -> Iterator[Any]:
    """Yield one of `POINTS` after four good ones."""
    yield task.sample(4)
    yield POINTS[what]()


def spoiler(task: Task, *, what: str) -> Moves:
    """Change the array of fitness in one of the ways of `SPOILS`."""
    while True:
        fitness: Array = yield task.sample(4)
        SPOILS[what](fitness)


def box_spoiler(task: Task) -> Moves:
    """Make the ends of the box something else than floats."""
    for end in (task.lo, task.hi):
        end.dtype = np.dtype("M8[s]")
    while True:
        yield np.array([[0.0, 2.1, -2.0]] * 4)
