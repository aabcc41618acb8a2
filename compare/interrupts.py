"""Ctrl-C asks a computation to end with the best that it has; a second one ends it at once."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def ctrl_c_stops() -> Iterator[Callable[[], bool]]:
    """Make Ctrl-C a request, where it would otherwise raise KeyboardInterrupt.

    Yields
    ------
    Callable
        Says whether there was a request: the option ``stop`` of the solvers.
    """
    asked = False

    def ask(number: int, frame: FrameType | None) -> None:
        nonlocal asked
        if asked:
            raise KeyboardInterrupt
        asked = True

    if threading.current_thread() is not threading.main_thread():  # signals reach the main thread only
        yield lambda: False
        return
    before = signal.signal(signal.SIGINT, ask)
    try:
        yield lambda: asked
    finally:
        signal.signal(signal.SIGINT, before)
