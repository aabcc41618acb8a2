"""Worker processes on this machine."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any, TypeVar

from loky import ProcessPoolExecutor

T = TypeVar("T")
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

_MOST_GROWTH = "2e9"  # bytes beyond which a worker is replaced; compiled code alone takes 0.3 GB
_GLANCE = 1.0  # [s] between two looks at whether the parent is still there


class Workers:
    """Worker processes, started afresh on every platform.

    Parameters
    ----------
    jobs : int
        Number of processes.
    """

    lost: tuple[type[Exception], ...] = (BrokenProcessPool,)

    def __init__(self, jobs: int) -> None:
        self._jobs = jobs
        self._pool = _pool(jobs)

    def submit(self, function: Callable[..., T], /, *arguments: Any) -> Future[T]:
        """Hand a call to the workers; see `compare.engines.calls.Engine`.

        Parameters
        ----------
        function : callable
        *arguments : object

        Returns
        -------
        Future
        """
        try:
            found: Future[T] = self._pool.submit(function, *arguments)
        except BrokenProcessPool as error:  # a worker died since the last answer
            found = Future()
            found.set_exception(error)
        return found

    def restart(self) -> None:
        """Start the workers again after one of them died."""
        self._pool.shutdown(wait=True, kill_workers=True)
        self._pool = _pool(self._jobs)

    def end(self, *, at_once: bool) -> None:
        """End the workers.

        Parameters
        ----------
        at_once : bool
            Whether the calls that run are ended too.
        """
        self._pool.shutdown(wait=True, kill_workers=at_once)


@contextmanager
def workers(jobs: int) -> Iterator[Workers]:
    """Start worker processes; an interrupt ends them with the calls that they are at.

    Parameters
    ----------
    jobs : int
        Number of processes.

    Yields
    ------
    Workers
    """
    found = Workers(jobs)
    try:
        yield found
    except BaseException:
        found.end(at_once=True)
        raise
    found.end(at_once=False)


def _pool(jobs: int) -> ProcessPoolExecutor:
    # each worker has one thread: linear algebra with threads of its own would only wait for the others
    settings = {name: "1" for name in _THREADS if name not in os.environ}
    settings["LOKY_MAX_MEMORY_LEAK_SIZE"] = _MOST_GROWTH
    pool = ProcessPoolExecutor(jobs, initializer=_begin, initargs=(os.getpid(),), env=settings)
    # workers inherit that they ignore an interrupt, which is this process's to handle
    here = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGINT, signal.SIG_IGN) if here else None
    try:
        pool.submit(os.getpid)  # starts all of them
    finally:
        if here:
            signal.signal(signal.SIGINT, before)
    return pool


def _begin(parent: int) -> None:
    # processes of plug-ins inherit the command line, and must not learn from it where the report is
    del sys.argv[1:]
    # a worker that waits for calls does not notice that nobody is left to send one
    threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_GLANCE)
    os._exit(1)
