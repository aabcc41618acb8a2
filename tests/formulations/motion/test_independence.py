"""The judge shares no code with what it judges."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from formulations import motion

FILES = sorted(Path(motion.__file__).parent.glob("*.py"))
# chains and dynamics tell what the arm does; no motion is made with them
ALLOWED = (
    "formulations.motion",
    "formulations.problem",
    "formulations.kinematics",
    "formulations.dynamics",
)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_check_shares_no_code_with_the_kernels(path: Path) -> None:
    text = path.read_text()
    assert "families" not in text
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            modules = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            modules = [node.module or ""]
        else:
            continue
        for module in modules:
            assert not module.startswith("formulations") or module.startswith(ALLOWED), module


def test_the_files_of_the_check_are_there() -> None:
    assert {"extremes", "trajectory", "verdict", "interpolation"} <= {path.stem for path in FILES}
