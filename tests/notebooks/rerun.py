"""Run a notebook from a clean kernel; ``python tests/notebooks/rerun.py [NAME ...]`` stores what it gives."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

ROOT = Path(__file__).parents[2]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
READ = Path("tests/data/robots")  # what notebooks read


def rerun(path: Path, clone: Path) -> Any:
    """Run a notebook in an empty folder beside a copy of what it reads, so that what it writes is not kept.

    Progress on stderr has times of this machine; it is dropped.
    """
    shutil.copytree(ROOT / READ, clone / READ)
    (clone / "notebooks").mkdir()
    notebook = nbformat.read(path, as_version=4)
    place = {"metadata": {"path": str(clone / "notebooks")}}
    client = NotebookClient(
        notebook, timeout=120, resources=place, record_timing=False, coalesce_streams=True
    )
    client.execute(env={**os.environ, "PYTHONPATH": str(ROOT)})
    notebook.metadata.language_info = {"name": "python"}  # without the version of this machine
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = [output for output in cell.outputs if output.get("name") != "stderr"]
    return notebook


def main(names: list[str]) -> None:
    """Store the outputs of the notebooks whose file names contain one of the names; of all without names."""
    for path in NOTEBOOKS:
        if not names or any(name in path.name for name in names):
            with tempfile.TemporaryDirectory() as clone:
                nbformat.write(rerun(path, Path(clone)), path)


if __name__ == "__main__":
    main(sys.argv[1:])
