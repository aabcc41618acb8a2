"""An algorithm in a process of its own: it may hang, exit or crash, and only its own row shows it.

The process sends points and gets their fitness.  The objective, the archive and the count of evaluations
stay on this side, where the algorithm cannot reach them.  The process (`metaheuristics.driver.child`) runs
the driver too, so that every fault of the algorithm has its name; this side checks the points again.

What the process is given: the box, the budget, the seed, the points to start from, the algorithm, its
parameters, and where modules are found.  Its working directory is an empty temporary folder, its environment
a short list of variables, its standard streams are closed, and its command line names no file of the
comparison.  It runs with the rights of the user all the same: see docs/reference/driver.md.
"""

from __future__ import annotations

import contextlib
import inspect
import os
import pickle
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from metaheuristics.driver.channel import Channel, MessageError
from metaheuristics.driver.reason import printable
from metaheuristics.driver.task import Array, BudgetSpent, Fault, Moves, Search, Status, Task, TaskError

T = TypeVar("T")

START = 60.0  # s that a process may take to start; not counted
LAST_WORDS = 2.0  # s that a process which closed its channel has to end

# variables that a process needs to find its libraries and to read text as this one does
KEPT = (
    "PATH", "LANG", "LC_ALL", "LC_CTYPE", "LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "SYSTEMROOT",
    "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS",
)  # fmt: skip
HARMLESS = (Status.ok, Status.stopped_early, Status.no_feasible_point)  # this side sees these itself


def apart(algorithm: Search, *, seconds: float) -> Search:
    """Return the same algorithm, run in a process of its own.

    Parameters
    ----------
    algorithm : Search
        A generator function ``(task, **parameters)``.  It and its parameters must be picklable.
    seconds : float
        Time limit of the algorithm's own work in one run [s]; the time of the objective is not counted.

    Returns
    -------
    Search
        Run it by `minimise` like any other.  With the same seed it finds the same points as in this
        process; a run that exceeds its time has the status ``timed-out``, a process that ends has
        ``exited``, and `Result.isolated` is true.

    Raises
    ------
    TaskError
        The time limit is not positive.

    Examples
    --------
    >>> import numpy as np
    >>> from metaheuristics import algorithm, apart, minimise
    >>> swarm = apart(algorithm("pso").function, seconds=60.0)
    >>> found = minimise(swarm, lambda x: (x**2).sum(axis=1), [-1, -1], [1, 1], budget=500, seed=0)
    >>> found.status, found.isolated, found.evaluations
    (<Status.ok: 'ok'>, True, 500)
    """
    if not seconds > 0.0:
        raise TaskError(f"seconds needs a positive time limit, got {seconds!r}")
    return Apart(algorithm, seconds)


class Apart:
    """What `apart` returns; the driver knows an isolated run by this class."""

    def __init__(self, algorithm: Search, seconds: float) -> None:
        self.__signature__ = inspect.signature(algorithm)  # its parameters stay visible
        self._algorithm, self._seconds = algorithm, seconds

    def __call__(self, task: Task, **parameters: object) -> Moves:
        """Yield the points that the process asks for."""
        seed: Any = task.rng.bit_generator.seed_seq
        work = self._algorithm, parameters, task.lo, task.hi, task.budget, seed, task.start
        child = Child("run", work, self._seconds, most=8 * task.dim * task.budget)
        try:
            fitness: Array | None = None
            while True:
                header, data = child.exchange(fitness)
                if header.get("kind") == "end":
                    _end(header)
                    return None
                x = _points(header, data, task.dim)
                try:
                    fitness = yield x
                except BudgetSpent as last:
                    fitness = last.fitness
        finally:
            child.kill()


def _points(header: dict[str, Any], data: bytes, dim: int) -> Array:
    if header.get("kind") != "x" or len(data) % (8 * dim):
        raise _bad(f"{len(data)} bytes for points of {dim} coordinates")
    return np.frombuffer(data).reshape(-1, dim)


def _end(header: dict[str, Any]) -> None:
    """Raise the fault that the process reports, if it is one."""
    word, note = header.get("status"), header.get("note")
    if not isinstance(word, str) or word not in list(Status) or not isinstance(note, str):
        raise _bad("an end without a status")
    if Status(word) not in HARMLESS:
        raise Fault(Status(word), printable(note))


def _bad(what: str) -> Fault:
    return Fault(Status.bad_message, f"its process sent {what}")


class Child:
    """The process, seen from this side.

    Parameters
    ----------
    kind : str
        ``"run"`` or ``"describe"``: see `metaheuristics.driver.child`.
    work : object
        What it needs for that; it is pickled for the process, never by it.
    seconds : float
        Time limit of its own work [s].
    most : int
        Bytes of data that its messages may have.

    Raises
    ------
    Fault
        The process did not start.
    """

    def __init__(self, kind: str, work: object, seconds: float, *, most: int) -> None:
        data = pickle.dumps(work)  # first: what cannot be pickled is the caller's error
        self._limit = self._left = seconds
        self._most = most
        self._folder = tempfile.mkdtemp(prefix="timebound-")
        here, there = socket.socketpair()
        self._channel = Channel(here)
        try:
            with there:
                self._process = _start(there, self._folder)
        except BaseException:
            here.close()
            shutil.rmtree(self._folder, ignore_errors=True)
            raise
        try:
            path = dict.fromkeys([*map(os.path.abspath, sys.path), os.getcwd()])
            header = {"kind": kind, "path": list(path), "main": _main(data)}
            late = f"took more than {START:g} s to start"
            self._carry(lambda: self._channel.send(header, data, START), late)
            self._carry(lambda: self._channel.receive(0, START), late)  # ready
        except BaseException:
            self.kill()
            raise

    def exchange(self, fitness: Array | None) -> tuple[dict[str, Any], bytes]:
        """Send fitness, if there is any, and wait for the next message.

        Parameters
        ----------
        fitness : Array, shape (n,), optional
            Of the points that the process asked for last.

        Returns
        -------
        header : dict[str, Any]
            What the process says: foreign, to be checked.
        data : bytes
            What follows it.

        Raises
        ------
        Fault
            The process is late, gone, or sends something else than a message.
        """
        started = time.perf_counter()

        def both() -> tuple[dict[str, Any], bytes]:
            if fitness is not None:
                self._channel.send({}, np.ascontiguousarray(fitness).tobytes(), self._left)
            left = self._left - (time.perf_counter() - started)
            return self._channel.receive(self._most, max(left, 0.0))

        found = self._carry(both, f"took more than {self._limit:g} s of its own")
        self._left = max(self._left - (time.perf_counter() - started), 1e-9)
        return found

    def _carry(self, talk: Callable[[], T], late: str) -> T:
        try:
            return talk()
        except TimeoutError:
            raise Fault(Status.timed_out, late) from None
        except MessageError as error:
            raise _bad(str(error)) from None
        except (EOFError, OSError):
            raise Fault(Status.exited, self._last_words()) from None

    def _last_words(self) -> str:
        try:
            code = self._process.wait(LAST_WORDS)
        except subprocess.TimeoutExpired:
            return "its process closed its channel"
        if code < 0:
            with contextlib.suppress(ValueError):
                return f"its process was ended by {signal.Signals(-code).name}"
        return f"its process ended with exit code {code}"

    def kill(self) -> None:
        """End the process and those that it started, and remove its folder."""
        self._channel.close()
        if sys.platform != "win32":
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, signal.SIGKILL)
        self._process.kill()
        self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)


def _start(there: socket.socket, folder: str) -> subprocess.Popen[bytes]:
    """Start the process with one end of the channel and as little else as it needs."""
    environment = {name: os.environ[name] for name in KEPT if name in os.environ}
    environment |= dict.fromkeys(("HOME", "USERPROFILE", "TMPDIR", "TEMP", "TMP"), folder)
    environment["PYTHONPATH"] = str(Path(__file__).resolve().parents[2])
    environment["PYTHONHASHSEED"] = "0"  # a plug-in that runs through a set repeats itself
    command = [sys.executable, "-m", "metaheuristics.driver.child"]
    closed = subprocess.DEVNULL
    if sys.platform == "win32":  # an end is shared with a process by its number, once it runs
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=closed, stderr=closed, cwd=folder, env=environment
        )
        process.stdin.write(there.share(process.pid))
        process.stdin.close()
        return process
    number = there.fileno()
    return subprocess.Popen(
        [*command, str(number)],
        stdin=closed,
        stdout=closed,
        stderr=closed,
        cwd=folder,
        env=environment,
        pass_fds=(number,),
        start_new_session=True,  # the terminal's Ctrl-C is for this side; what it starts ends with it
    )


def _main(data: bytes) -> list[str]:
    """How the process finds what is defined in the script that runs here: a kind and a place, or nothing."""
    main = sys.modules["__main__"]
    if b"__main__" not in data:
        return []
    if main.__spec__ is not None:
        return ["module", main.__spec__.name]
    file = getattr(main, "__file__", None)
    return [] if file is None else ["file", os.path.abspath(file)]
