"""The recipe "Add a swarm" of CONTRIBUTING, followed word by word in a copy of the project."""

from __future__ import annotations

import csv
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NAME = "newcomer"
SMALL = ["--quick", "--cases", "sr4c", "--codings", "stretched", "--seeds", "2", "--jobs", "1"]


def copy_of_project(folder: Path) -> Path:
    """Copy the three packages with their compiled kernels, which are valid for equal times of change."""
    for package in ("formulations", "metaheuristics", "compare"):
        shutil.copytree(ROOT / package, folder / package)
    return folder


def recipe() -> str:
    """The section of CONTRIBUTING, with the name filled in."""
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    section = re.search(r"## Add a swarm\n(.*?)(?=\n## |\Z)", text, re.DOTALL)
    assert section is not None
    return re.sub(r"\bNAME\b", NAME, section[1])


def blocks(text: str) -> list[str]:
    """The code blocks of a section, without their indentation."""
    found = re.findall(r"^   ```python\n(.*?)^   ```$", text, re.DOTALL | re.MULTILINE)
    return [re.sub(r"^   ", "", block, flags=re.MULTILINE) for block in found]


def python(folder: Path, *words: str) -> str:
    """Run a command in the copy; return what it prints."""
    environment = os.environ | {"PYTHONPATH": str(folder)}
    done = subprocess.run(
        [sys.executable, *words],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / "rows.csv").open(encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


@pytest.mark.long
def test_the_recipe_for_a_swarm(tmp_path: Path) -> None:
    text = recipe()
    folder = copy_of_project(tmp_path)

    # 1. write the file
    place = re.search(r"Write `([^`]+\.py)`", text)
    assert place is not None
    code, entry = blocks(text)
    (folder / place[1]).write_text(code, "utf-8")

    # without a line anywhere: as a plug-in, by the module's name
    module = place[1].removesuffix(".py").replace("/", ".")
    plug_in = f"{module}:{NAME}"
    python(folder, "-m", "compare.all", *SMALL, "--swarms", f"{plug_in},pso", "--out", "plugged")
    plugged = rows(folder / "plugged")
    assert [row["swarm"] for row in plugged] == [plug_in] * 2 + ["pso"] * 2
    assert {row["status"] for row in plugged} == {"ok"}

    # 2. enter it in the registry
    registry = folder / re.search(r"Enter it in `([^`]+)`", text)[1]  # type: ignore[index]
    lines = registry.read_text("utf-8")
    imported = f"from {module} import {NAME}\n"
    lines = lines.replace("from metaheuristics.swarms.", f"{imported}from metaheuristics.swarms.", 1)
    before = "_ENTRIES = [\n"
    assert before in lines
    registry.write_text(lines.replace(before, f"{before}    {entry.strip()},\n", 1), "utf-8")

    # 3. grade it, by the command of the recipe
    words = re.search(r"`timebound (all --swarms [^`:]+)` grades it", text)
    assert words is not None
    assert f"--swarms {NAME},pso" in words[1]
    python(folder, "-m", "compare", *words[1].split(), *SMALL, "--out", "report")
    graded = rows(folder / "report")
    assert [row["swarm"] for row in graded] == [NAME] * 2 + ["pso"] * 2
    assert {row["status"] for row in graded} == {"ok"}
    assert all(float(row["gap"]) >= 0.0 for row in graded)
    assert NAME in (folder / "report" / "report.md").read_text("utf-8")
    listed = "from metaheuristics import ALGORITHMS as a; print(a['newcomer'].parameters)"
    assert python(folder, "-c", listed) == "{'population': 50, 'share': 0.1}\n"
    where = re.search(r"oracle written with loops to\s+`([^`]+)`", text)
    assert where is not None
    assert (ROOT / where[1]).is_dir()
