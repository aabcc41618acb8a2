"""A temporary copy of the repository, in which a recipe of CONTRIBUTING is followed word by word."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("formulations", "metaheuristics", "compare", "tests")


class Copy:
    """A copy of the sources, with their compiled kernels; what it runs knows no other copy."""

    def __init__(self, folder: Path) -> None:
        self.root = folder / "copy"
        for name in FOLDERS:
            shutil.copytree(ROOT / name, self.root / name)
        shutil.copy2(ROOT / "pyproject.toml", self.root)

    def write(self, path: str, text: str) -> None:
        """Write a new file; a recipe never overwrites one."""
        target = self.root / path
        assert not target.exists(), f"{path} is there already"
        target.write_text(text, "utf-8")

    def insert(self, path: str, before: str, text: str) -> None:
        """Put a line of text before the first line that starts with ``before``, its indent aside."""
        target = self.root / path
        lines = target.read_text("utf-8").splitlines(keepends=True)
        places = [k for k, line in enumerate(lines) if line.lstrip().startswith(before)]
        assert places, f"{path} has no line {before!r}"
        old = lines[places[0]]
        lines.insert(places[0], old[: len(old) - len(old.lstrip())] + text + "\n")
        target.write_text("".join(lines), "utf-8")

    def run(self, *arguments: str) -> str:
        """Output of ``python *arguments`` in the copy; fails with all that was said if it fails."""
        environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        done = subprocess.run(
            [sys.executable, *arguments],
            cwd=self.root,
            env=environment,
            capture_output=True,
            text=True,
            timeout=500,
        )
        assert done.returncode == 0, f"{arguments}:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}"
        return done.stdout

    def test(self, *arguments: str) -> str:
        """Run tests of the copy, in one process."""
        return self.run("-m", "pytest", "-q", "-n", "0", "-p", "no:cacheprovider", *arguments)
