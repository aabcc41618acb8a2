"""An algorithm in a process of its own: it may hang, exit or crash, and only its own row shows it.

The process runs the driver too, so that every fault has its name; its objective asks this side, which
evaluates, counts and keeps the archive.  Nothing is unpickled that the process sent: whole messages
are a line of JSON and plain floats.
"""

from __future__ import annotations

import functools
import json
import math
import multiprocessing
import time
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from metaheuristics.driver.judge import minimise
from metaheuristics.driver.task import Array, BudgetSpent, Fault, Moves, Search, Status, Task

START = 60.0  # s that a process may take to start; not counted


def apart(algorithm: Search, *, seconds: float) -> Search:
    """Return the same algorithm, run in its own process for at most ``seconds`` of its own time.

    Same seed, same points as in this process.  ``algorithm`` and its parameters must be picklable.
    """

    @functools.wraps(algorithm)  # its parameters stay visible
    def search(task: Task, **parameters: object) -> Moves:
        child = _Child(algorithm, task, parameters, seconds)
        try:
            fitness = None
            while True:
                header, x = child.exchange(fitness)
                if header["kind"] == "end":
                    status = Status(header["status"])
                    if status not in (Status.ok, Status.stopped_early, Status.no_feasible_point):
                        raise Fault(status, str(header["note"]))
                    return None
                try:
                    fitness = yield x
                except BudgetSpent as last:
                    fitness = last.fitness
        finally:
            child.kill()

    return search


class _Child:
    """The process, seen from here."""

    def __init__(
        self, algorithm: Search, task: Task, parameters: dict[str, Any], seconds: float
    ) -> None:
        context = multiprocessing.get_context("spawn")
        self._here, there = context.Pipe()
        seed = task.rng.bit_generator.seed_seq
        arguments = (there, algorithm, parameters, task.lo, task.hi, task.budget, seed)
        self._process = context.Process(target=_work, args=arguments, daemon=True)
        self._limit, self._left = seconds, seconds
        self._process.start()
        there.close()
        self._receive(START)  # ready

    def exchange(self, fitness: Array | None) -> tuple[dict[str, Any], Array]:
        """Send fitness (n,), if there is any; return the next message."""
        started = time.perf_counter()
        if fitness is not None:
            try:
                self._here.send_bytes(np.ascontiguousarray(fitness).tobytes())
            except OSError:
                raise self._gone() from None
        message = self._receive(self._left)
        self._left -= time.perf_counter() - started
        return message

    def _receive(self, seconds: float) -> tuple[dict[str, Any], Array]:
        """Return the next message, a header and floats; raises the `Fault` of a silent process."""
        try:
            if not self._here.poll(max(seconds, 0.0)):
                raise Fault(Status.timed_out, f"took more than {self._limit:g} s of its own")
            line, _, data = self._here.recv_bytes().partition(b"\n")
        except (EOFError, OSError):
            raise self._gone() from None
        header = json.loads(line)
        shape = tuple(header.get("shape", (0,)))
        if math.prod(shape) * 8 != len(data):
            raise Fault(Status.wrong_shape, f"sent {len(data)} bytes for shape {shape}")
        return header, np.frombuffer(data).reshape(shape)

    def _gone(self) -> Fault:
        self._process.join(START)
        return Fault(Status.exited, f"its process ended with exit code {self._process.exitcode}")

    def kill(self) -> None:
        """End the process, whatever it does."""
        self._here.close()
        self._process.kill()
        self._process.join()


def _work(
    connection: Connection,
    algorithm: Search,
    parameters: dict[str, Any],
    lo: Array,
    hi: Array,
    budget: int,
    seed: np.random.SeedSequence,
) -> None:
    """Run an algorithm in this process; its objective asks the other side."""

    def send(data: bytes = b"", **header: object) -> None:
        connection.send_bytes(json.dumps(header).encode() + b"\n" + data)

    def remote(x: Array) -> Array:
        send(x.tobytes(), kind="x", shape=x.shape)
        return np.frombuffer(connection.recv_bytes())

    send(kind="ready")
    result = minimise(algorithm, remote, lo, hi, budget=budget, seed=seed, **parameters)
    send(kind="end", status=result.status.value, note=result.note)
