"""The workers of a Dask cluster: ``pip install 'timebound[cluster]'``.

A worker of Dask makes calls in threads, beside its own traffic. Each call is therefore handed on to a
process beside the worker, which is one of `compare.engines.here`: what runs there runs as it does on one
machine. Dask gives the calls of a worker that died to the others.
"""

from __future__ import annotations

import functools
import multiprocessing
import platform
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any, TypeVar

from compare.engines.here import Workers
from compare.sources import source_digest
from formulations import InputError
from formulations.climb import versions

T = TypeVar("T")
_LOCK = threading.Lock()
_PATIENCE = 30.0  # [s] for the scheduler, and for its first worker


class Cluster:
    """The workers of a Dask cluster.

    Parameters
    ----------
    client : distributed.Client
    """

    def __init__(self, client: Any) -> None:
        from distributed import KilledWorker

        self.lost = (BrokenProcessPool, KilledWorker)
        self._calls = client.get_executor(pure=False)

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
        found: Future[T] = self._calls.submit(_beside_the_worker, function, *arguments)
        return found

    def restart(self) -> None:
        """Do nothing: the cluster starts its workers itself."""


@contextmanager
def on_cluster(address: str) -> Iterator[Cluster]:
    """Connect to a cluster whose workers run the same code and versions as this process.

    Parameters
    ----------
    address : str
        Of its scheduler, such as ``tcp://127.0.0.1:8786``.

    Yields
    ------
    Cluster

    Raises
    ------
    InputError
        If there is no scheduler, no worker, or a worker with another version of anything.
    """
    try:
        from distributed import Client
    except ImportError:
        raise InputError("--cluster: needs Dask: pip install 'timebound[cluster]'") from None
    try:
        client = Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(f"--cluster {address}: no scheduler answers: {reason}") from None
    with client:
        try:
            client.wait_for_workers(1, timeout=_PATIENCE)
        except TimeoutError:
            raise InputError(f"--cluster {address}: the scheduler has no workers") from None
        _same_everywhere(client.run(environment), address)
        yield Cluster(client)


def environment() -> dict[str, str]:
    """Return what the numbers of a worker depend on beside its machine, name by name."""
    return {"python": platform.python_version(), "source": source_digest()} | versions()


def _same_everywhere(found: dict[str, dict[str, str]], address: str) -> None:
    here = environment()
    for worker, there in found.items():
        for name, value in here.items():
            if there.get(name) != value:
                raise InputError(
                    f"--cluster {address}: worker {worker} has {name} {there.get(name)}, not {value}"
                )


def _beside_the_worker(function: Callable[..., T], *arguments: Any) -> T:
    """Make a call in a process beside this worker."""
    beside = _processes()
    try:
        return beside.submit(function, *arguments).result()
    except BrokenProcessPool:
        with _LOCK:
            _started.cache_clear()
        raise


def _processes() -> Workers:
    with _LOCK:
        return _started()


@functools.cache
def _started() -> Workers:
    from distributed import get_worker

    # a worker is marked as a daemon, which may have no children; these end with it all the same
    multiprocessing.current_process()._config["daemon"] = False  # type: ignore[attr-defined]
    return Workers(get_worker().state.nthreads)
