"""Many calls on an engine: answers as they come, and no call lost with the worker that made it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from itertools import islice
from typing import Any, Protocol, TypeVar

from compare.screen import bar

T = TypeVar("T")
Call = tuple[Any, ...]

_WAITING = 64  # calls handed to the workers at a time, enough to keep all of them busy
_ATTEMPTS = 3  # a call that ends its worker so often, with no other call beside it, is to blame


class Engine(Protocol):
    """Where calls run.

    Attributes
    ----------
    lost : tuple of type
        What the answer of a call raises if its worker died.
    """

    @property
    def lost(self) -> tuple[type[Exception], ...]: ...  # noqa: D102

    def submit(self, function: Callable[..., T], /, *arguments: Any) -> Future[T]:
        """Hand a call to the workers.

        Parameters
        ----------
        function : callable
            A function of a module, so that workers can import it.
        *arguments : object
            Its arguments.

        Returns
        -------
        Future
            Its result raises one of ``lost`` if the worker died.
        """

    def restart(self) -> None:
        """Start the workers again after one of them died."""


class WorkerLostError(RuntimeError):
    """A call ended its worker every time it was made.

    Attributes
    ----------
    call : tuple
        The arguments of the call.
    """

    def __init__(self, call: Call) -> None:
        super().__init__(
            f"the worker process died in {_ATTEMPTS} of {_ATTEMPTS} attempts at {call}"[:400]
        )
        self.call = call


def each(
    engine: Engine,
    title: str,
    function: Callable[..., T],
    calls: Iterable[Call],
    *,
    total: int | None = None,
) -> Iterator[T]:
    """Call a function in the workers, under a progress bar with the time left.

    At most 64 calls wait at a time, so that memory does not grow with their number. When a worker dies,
    the calls that it takes with it are made again, one at a time.

    Parameters
    ----------
    engine : Engine
    title : str
        Words beside the bar.
    function : callable
        A function of a module, so that workers can import it.
    calls : iterable of tuple
        Its arguments, call by call.
    total : int, optional
        Number of calls; counted if left out.

    Yields
    ------
    object
        What the function returns, as the calls end.

    Raises
    ------
    WorkerLostError
        If one call ends its worker three times, with no other call beside it.
    """
    if total is None:
        calls = list(calls)
        total = len(calls)
    fresh = iter(calls)
    suspects: deque[tuple[Call, int]] = deque()  # calls that a dead worker took with it, and attempts
    running: dict[Future[T], tuple[Call, int]] = {}
    with bar(title, total) as advance:
        while True:
            if not suspects:
                for call in islice(fresh, _WAITING - len(running)):
                    running[engine.submit(function, *call)] = call, 0
            elif not running:  # alone, so that it is known which call ends its worker
                call, attempts = suspects.popleft()
                if attempts == _ATTEMPTS:
                    raise WorkerLostError(call)
                running[engine.submit(function, *call)] = call, attempts + 1
            if not running:
                return
            lost = False
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                entry = running.pop(future)
                try:
                    answer = future.result()
                except engine.lost:
                    suspects.append(entry)
                    lost = True
                    continue
                advance()
                yield answer
            if lost:
                engine.restart()
