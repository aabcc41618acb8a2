"""A real Dask cluster on this machine, for tests: a scheduler and its workers, each a process of its own."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path


class Processes:
    """A scheduler and its workers, each a process of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
        self.scheduler = self.start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
                                    "--scheduler-file", str(folder / "scheduler.json"))  # fmt: skip
        self.workers = [self.worker(), self.worker()]

    def start(self, *words: str) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, "-m", "dask", *words], cwd=self.folder, env=self.environment,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        )  # fmt: skip

    def worker(self) -> subprocess.Popen[bytes]:
        return self.start("worker", "--scheduler-file", "scheduler.json", "--nthreads", "1", "--no-dashboard",
                          "--host", "127.0.0.1", "--local-directory", str(self.folder))  # fmt: skip

    @property
    def address(self) -> str:
        for _ in range(600):
            try:
                return str(json.loads((self.folder / "scheduler.json").read_text())["address"])
            except (OSError, ValueError):
                time.sleep(0.2)
        raise TimeoutError("no scheduler")

    def kill(self, process: subprocess.Popen[bytes]) -> None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()

    def replace_worker(self) -> None:
        """Kill a worker and start another one."""
        self.kill(self.workers.pop(0))
        self.workers.append(self.worker())

    def __enter__(self) -> Processes:
        return self

    def __exit__(self, *error: object) -> None:
        self.end()

    def end(self) -> None:
        for process in (*self.workers, self.scheduler):
            if process.poll() is None:
                self.kill(process)
