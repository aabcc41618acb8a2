"""No workers: the calls are made by the process that asks, where a few short ones are not worth a worker."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, TypeVar

T = TypeVar("T")


class ThisProcess:
    """An engine that makes each call as it is handed over."""

    lost: tuple[type[Exception], ...] = ()

    def submit(self, function: Callable[..., T], /, *arguments: Any) -> Future[T]:
        """Make a call; see `compare.engines.calls.Engine`.

        Parameters
        ----------
        function : callable
        *arguments : object

        Returns
        -------
        Future
            It is done.
        """
        made: Future[T] = Future()
        try:
            made.set_result(function(*arguments))
        except Exception as error:  # the caller raises it when it asks for the result
            made.set_exception(error)
        return made

    def restart(self) -> None:
        """Do nothing: there is no worker that can die."""
