"""Engines: workers with one thread each, and calls that survive the death of the worker that made them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from compare.engines import WorkerLostError, each, workers


def environment(name: str) -> str | None:
    return os.environ.get(name)


def square(x: int) -> int:
    return x * x


def die_once(x: int, mark: str) -> int:
    """Die by SIGKILL at the first attempt of each third call."""
    path = Path(mark, str(x))
    if x % 3 == 0 and not path.exists():
        path.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return x * x


def die(x: int) -> int:
    if x == 3:
        os._exit(1)
    return x


def arguments() -> list[str]:
    return sys.argv[1:]


def test_workers_are_the_only_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")  # somebody's own choice
    names = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"]
    with workers(1) as engine:
        assert [engine.submit(environment, name).result() for name in names] == ["1", "3"]
        assert engine.submit(arguments).result() == []
    assert "OMP_NUM_THREADS" not in os.environ


def test_each_call_is_made_once_and_few_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    taken = 0

    def calls() -> Iterator[tuple[int]]:
        nonlocal taken
        for x in range(500):
            taken += 1
            yield (x,)

    with workers(2) as engine:
        answers = []
        for answer in each(engine, "squares", square, calls(), total=500):
            answers.append(answer)
            assert taken <= len(answers) + 2 * 64  # memory does not grow with the number of calls
    assert sorted(answers) == [x * x for x in range(500)]


def test_calls_of_a_worker_that_is_killed_are_made_again(tmp_path: Path) -> None:
    with workers(2) as engine:
        found = list(each(engine, "calls", die_once, [(x, str(tmp_path)) for x in range(7)]))
    assert sorted(found) == [x * x for x in range(7)]
    assert len(list(tmp_path.iterdir())) == 3


def test_a_call_that_always_ends_its_worker_is_named() -> None:
    found = []
    with workers(2) as engine, pytest.raises(WorkerLostError, match=r"\(3,\)") as error:
        found.extend(each(engine, "calls", die, [(x,) for x in range(5)]))
    assert error.value.call == (3,)


def interrupted() -> None:
    with workers(1) as engine:
        next(each(engine, "calls", square, [(2,)]))
        engine.submit(time.sleep, 600)
        raise KeyboardInterrupt


def test_an_interrupt_ends_the_calls_at_once() -> None:
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert time.monotonic() - start < 120


def test_workers_end_with_the_process_that_started_them(tmp_path: Path) -> None:
    script = (
        "import os, sys, time\n"
        "from compare.engines import workers\n"
        "if __name__ == '__main__':\n"
        "    with workers(1) as engine:\n"
        "        print(engine.submit(os.getpid).result(), flush=True)\n"
        "        engine.submit(time.sleep, 2)\n"
        "        time.sleep(600)\n"
    )
    path = tmp_path / "started.py"
    path.write_text(script)
    with subprocess.Popen(
        [sys.executable, str(path)], stdout=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    ) as process:  # fmt: skip
        assert process.stdout is not None
        worker = int(process.stdout.readline())
        process.kill()
    for _ in range(300):
        if not Path(f"/proc/{worker}").exists():
            return
        time.sleep(0.2)
    os.kill(worker, signal.SIGKILL)
    pytest.fail("the worker outlives the process that started it")
