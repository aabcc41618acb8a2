"""Run a command of the project in a process of its own, as a person would."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]


def command(name: str, *options: str, **how: float) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "compare", name, *options],
        capture_output=True, text=True, cwd=ROOT, timeout=how.get("timeout", 300.0), check=False,
    )  # fmt: skip
