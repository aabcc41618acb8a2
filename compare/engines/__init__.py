"""Engines: where the calls of a comparison run. The answers are the same, bit for bit, whatever the engine.

here.py          worker processes on this machine
cluster.py       the workers of a Dask cluster
this_process.py  no workers at all
calls.py         `each`: many calls on an engine, under a progress bar; a call whose worker died is made again
"""

from contextlib import AbstractContextManager

from compare.engines.calls import Engine, WorkerLostError, each
from compare.engines.cluster import on_cluster
from compare.engines.here import workers
from compare.engines.this_process import ThisProcess


def start(jobs: int, cluster: str | None) -> AbstractContextManager[Engine]:
    """Start the engine that the options of a command ask for.

    Parameters
    ----------
    jobs : int
        Number of worker processes here.
    cluster : str or None
        Address of the scheduler of a Dask cluster, whose workers take the place of those here.

    Returns
    -------
    context manager of Engine
    """
    return workers(jobs) if cluster is None else on_cluster(cluster)


__all__ = ["Engine", "ThisProcess", "WorkerLostError", "each", "on_cluster", "start", "workers"]
