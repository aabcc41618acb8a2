"""The process of an isolated algorithm, ``python -m metaheuristics.driver.child``.

It gets one message of the process that started it, and then either runs an algorithm (``run``), whose
objective asks the other side, or says which parameters a plug-in has (``describe``).
"""

from __future__ import annotations

import io
import pickle
import runpy
import socket
import sys
from typing import Any

import numpy as np

from metaheuristics.driver.channel import Channel
from metaheuristics.driver.judge import minimise
from metaheuristics.driver.plug_in import UnknownAlgorithmError, defaults, load
from metaheuristics.driver.reason import printable, reason
from metaheuristics.driver.task import Array, Status

MOST = 1 << 40  # bytes of a message from the other side, which is trusted


def main() -> None:
    """Do what the first message says."""
    channel = Channel(_end())
    header, data = channel.receive(MOST)
    channel.send({"kind": "ready"})
    sys.path[:] = header["path"]
    try:
        work: Any = _Loader(data, header["main"]).load()
    except BaseException as error:  # of foreign modules: whatever they raise
        note = f"cannot be loaded: {reason(error)}"
        channel.send({"kind": "end", "status": Status.raised.value, "note": note})
        return
    if header["kind"] == "describe":
        _describe(channel, work)
    else:
        _run(channel, *work)


def _end() -> socket.socket:
    if sys.platform == "win32":
        return socket.fromshare(sys.stdin.buffer.read())
    end = socket.socket(fileno=int(sys.argv[1]))
    end.set_inheritable(False)
    return end


class _Loader(pickle.Unpickler):
    """Finds what is defined in the script of the other side, as `multiprocessing` does."""

    def __init__(self, data: bytes, place: list[str]) -> None:
        super().__init__(io.BytesIO(data))
        self._place = place
        self._main: dict[str, Any] | None = None

    def find_class(self, module: str, name: str) -> Any:
        """Find a name of a module."""
        if module != "__main__" or not self._place:
            return super().find_class(module, name)
        if self._main is None:
            kind, where = self._place
            find = runpy.run_module if kind == "module" else runpy.run_path
            self._main = find(where, run_name="__mp_main__")
        return self._main[name]


def _run(
    channel: Channel,
    algorithm: Any,
    parameters: dict[str, Any],
    lo: Array,
    hi: Array,
    budget: int,
    seed: np.random.SeedSequence,
    start: Array,
) -> None:
    def remote(x: Array) -> Array:
        channel.send({"kind": "x"}, x.tobytes())
        return np.frombuffer(channel.receive(MOST)[1])

    result = minimise(algorithm, remote, lo, hi, budget=budget, seed=seed, start=start, **parameters)
    channel.send({"kind": "end", "status": result.status.value, "note": result.note})


def _describe(channel: Channel, name: str) -> None:
    try:
        parameters = defaults(load(name))
    except UnknownAlgorithmError as error:
        channel.send({"kind": "unknown", "reason": printable(str(error))})
        return
    plain = {key: value for key, value in parameters.items() if type(value) in (bool, int, float, str)}
    channel.send({"kind": "known", "parameters": plain})


if __name__ == "__main__":
    main()
