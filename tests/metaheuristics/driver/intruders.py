"""Optimisers that look for what is not theirs: the objective, the comparison, the channel."""

from __future__ import annotations

import gc
import json
import os
import pickle
import socket
import struct
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from metaheuristics.driver.task import Moves, Task

MARK = Path("/tmp") / "timebound-intruder"  # not the temporary folder of the environment


def thief(task: Task, *, many: int = 1000) -> Moves:
    """Evaluate the objective found in the frames of the caller, many points for one."""
    while True:
        frame = sys._getframe()
        best = task.sample(1)
        while frame.f_back is not None:
            frame = frame.f_back
            f = getattr(frame.f_locals.get("self"), "f", None)
            if callable(f):
                try:
                    x = task.sample(many)
                    best = x[[np.argmin(f(x))]]
                    break
                except Exception:
                    pass
        yield best


def spy(task: Task) -> Moves:
    """Work if there is nothing to see here, else raise what there is."""
    seen: dict[str, object] = {}
    allowed = {
        "PATH", "LANG", "LC_ALL", "LC_CTYPE", "LD_LIBRARY_PATH", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS",
        "MKL_NUM_THREADS", "HOME", "USERPROFILE", "TMPDIR", "TEMP", "TMP", "PYTHONPATH", "PYTHONHASHSEED",
    }  # fmt: skip
    seen["environment"] = sorted(set(os.environ) - allowed)
    seen["files"] = os.listdir(".")
    seen["arguments"] = [word for word in sys.argv[1:] if not word.isdigit()]
    seen["modules"] = sorted({name.split(".")[0] for name in sys.modules} & {"compare", "formulations"})
    seen["streams"] = [os.fstat(n).st_rdev != os.stat(os.devnull).st_rdev for n in range(3)].count(True)
    seen["home"] = [] if os.environ["HOME"] == os.getcwd() else os.environ["HOME"]
    if any(seen.values()):
        raise RuntimeError(json.dumps(seen))
    while True:
        yield task.sample(4)


def litterer(task: Task) -> Moves:
    """Write a file where it stands, and say where."""
    Path("litter").write_text("x")
    yield task.sample(4)
    raise RuntimeError(os.getcwd())


def printer(task: Task) -> Moves:
    """Print to each stream, by Python and by number."""
    while True:
        print("intruder out", flush=True)
        print("intruder err", file=sys.stderr, flush=True)
        os.write(1, b"intruder one")
        yield task.sample(4)


def _channel() -> socket.socket:
    """The socket that leads out of this process."""
    return next(found for found in gc.get_objects() if type(found) is socket.socket)


def _message(header: bytes, data: bytes = b"") -> bytes:
    return struct.pack("!IQ", len(header), len(data)) + header + data


class Marker:
    """Leaves a mark wherever it is unpickled."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Make a file."""
        return Path.touch, (MARK,)


WORDS: dict[str, Callable[[socket.socket], Any]] = {
    "noise": lambda end: end.sendall(b"\xff" * 4096),
    "a pickle": lambda end: end.sendall(pickle.dumps(Marker())),
    "a pickle in a message": lambda end: end.sendall(_message(pickle.dumps(Marker()))),
    "a pickle behind a header": lambda end: end.sendall(
        _message(b'{"kind": "x"}', pickle.dumps(Marker()))
    ),
    "a long header": lambda end: end.sendall(struct.pack("!IQ", 2**32 - 1, 0)),
    "a long message": lambda end: end.sendall(struct.pack("!IQ", 2, 2**63)),
    "a deep header": lambda end: end.sendall(_message(b"[" * 60_000)),
    "no object": lambda end: end.sendall(_message(b"[1]")),
    "no kind": lambda end: end.sendall(_message(b"{}")),
    "a kind of another type": lambda end: end.sendall(_message(b'{"kind": {"x": 1}}')),
    "no whole points": lambda end: end.sendall(_message(b'{"kind": "x"}', b"1234567")),
    "no status": lambda end: end.sendall(_message(b'{"kind": "end"}')),
    "an unknown status": lambda end: end.sendall(
        _message(b'{"kind": "end", "status": "fine", "note": ""}')
    ),
    "a note of another type": lambda end: end.sendall(
        _message(b'{"kind": "end", "status": "raised", "note": [1]}')
    ),
    "a status of another type": lambda end: end.sendall(
        _message(b'{"kind": "end", "status": ["ok"], "note": ""}')
    ),
}


def forger(task: Task, *, what: str) -> Moves:
    """Say one of `WORDS` to the other side, past the driver."""
    yield task.sample(4)
    WORDS[what](_channel())
    time.sleep(1000.0)


def drifter(task: Task) -> Moves:
    """Ask for points outside the box, past the driver of this process."""
    yield task.sample(4)
    _channel().sendall(_message(b'{"kind": "x"}', np.full((1, task.dim), 1e9).tobytes()))
    time.sleep(1000.0)


def honeyed(task: Task) -> Moves:
    """Evaluate by the channel itself, past the count of this process, and say that all went well."""
    yield task.sample(4)
    end = _channel()
    for _ in range(10):
        end.sendall(_message(b'{"kind": "x"}', task.sample(100).tobytes()))
        end.recv(1 << 20)
    end.sendall(_message(b'{"kind": "end", "status": "ok", "note": ""}'))
    time.sleep(1000.0)


def hesitant(task: Task) -> Moves:
    """Begin a message and hang."""
    yield task.sample(4)
    _channel().sendall(struct.pack("!IQ", 100, 0) + b"{")
    time.sleep(1000.0)


def hanger_up(task: Task) -> Moves:
    """Close the channel and hang."""
    yield task.sample(4)
    _channel().close()
    time.sleep(1000.0)


def parent(task: Task) -> Moves:
    """Leave a process that holds the channel open and makes a file later; then hang."""
    yield task.sample(4)
    if os.fork() == 0:
        time.sleep(2.0)
        MARK.touch()
        os._exit(0)
    time.sleep(1000.0)


def runaway(task: Task) -> Moves:
    """Leave a process of another session that holds the channel open for a while; then hang."""
    yield task.sample(4)
    if os.fork() == 0:
        os.setsid()
        time.sleep(3.0)
        os._exit(0)
    time.sleep(1000.0)
