"""What a run watches and puts back: the two global random generators, and the user's interrupt."""

from __future__ import annotations

import random
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

import numpy as np


@contextmanager
def global_random(rng: np.random.Generator) -> Iterator[Callable[[], bool]]:
    """Seed ``numpy.random`` and ``random`` for the time of a run, watch them, and put them back.

    An algorithm that draws from them repeats itself all the same, cannot disturb the next run, and is
    found out.  (A generator that it makes itself, without a seed, shows as two different runs of one
    seed.)

    Parameters
    ----------
    rng : numpy.random.Generator
        The generator of the run.  Its seed fixes both global states; nothing is drawn from it.

    Yields
    ------
    Callable[[], bool]
        After the run: whether anybody drew from a global generator or seeded it.
    """
    before = _states()
    sequence: Any = rng.bit_generator.seed_seq
    word = int(np.random.SeedSequence(sequence.entropy, spawn_key=sequence.spawn_key)
               .generate_state(1)[0])  # fmt: skip
    np.random.seed(word)
    random.seed(word)
    start = _states()
    end = start
    try:
        yield lambda: not _equal(start, end)
    finally:
        end = _states()
        np.random.set_state(before[0])
        random.setstate(before[1])


def _states() -> tuple[Any, Any]:
    return np.random.get_state(), random.getstate()


def _equal(one: tuple[Any, Any], other: tuple[Any, Any]) -> bool:
    (_, words, *rest), (_, other_words, *other_rest) = one[0], other[0]
    numpys = rest == other_rest and words.tobytes() == other_words.tobytes()
    return numpys and bool(one[1] == other[1])


class Interrupt:
    """Whether the user has interrupted the run."""

    def __init__(self) -> None:
        self._error: BaseException | None = None

    def check(self) -> None:
        """Raise what the user's interrupt raised, also if the algorithm caught it."""
        if self._error is not None:
            raise self._error

    def _through(self, handler: Callable[[int, FrameType | None], Any]) -> Callable[..., None]:
        def recorded(number: int, frame: FrameType | None) -> None:
            try:
                handler(number, frame)
            except BaseException as error:
                self._error = error
                raise

        return recorded


@contextmanager
def user_interrupt() -> Iterator[Interrupt]:
    """Tell the user's Ctrl-C from a ``KeyboardInterrupt`` that an algorithm raises itself.

    Ctrl-C delivers the signal SIGINT, and Python runs its handler in the main thread.  For the time of a
    run the handler that is in force is wrapped, so that what it raises is known.  In any other thread,
    and where the signal is ignored, no ``KeyboardInterrupt`` can be the user's.

    Yields
    ------
    Interrupt
        Its ``check`` raises if the user has interrupted.
    """
    found = Interrupt()
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield found
        return
    signal.signal(signal.SIGINT, found._through(before))
    try:
        yield found
    finally:
        signal.signal(signal.SIGINT, before)
