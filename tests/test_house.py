"""The house: data flows one way, the README keeps its promises."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DRAWS = ROOT / "formulations" / "motion" / "picture.py"
SHOWS = ROOT / "formulations" / "planning.py"  # its method says which type the picture has


def imported(path: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add((node.module or "").split(".")[0])
    return names


@pytest.mark.parametrize(
    ("package", "forbidden"),
    [
        ("formulations", {"metaheuristics", "compare", "matplotlib"}),
        ("metaheuristics", {"formulations", "compare", "matplotlib", "numba", "casadi"}),
    ],
)
def test_data_flows_one_way(package: str, forbidden: set[str]) -> None:
    files = list((ROOT / package).rglob("*.py"))
    assert files
    for path in files:
        allowed = {"matplotlib"} if path in (DRAWS, SHOWS) else set()
        assert not imported(path) & (forbidden - allowed), path


@pytest.mark.parametrize("path", [DRAWS, SHOWS], ids=lambda p: p.stem)
def test_matplotlib_is_loaded_when_a_picture_is_drawn_and_not_before(path: Path) -> None:
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            assert "matplotlib" not in ast.unparse(node)
        if isinstance(node, ast.If):
            assert ast.unparse(node.test) == "TYPE_CHECKING"


def test_the_check_shares_no_code_with_the_kernels() -> None:
    assert "families" not in (ROOT / "formulations" / "motion" / "trajectory.py").read_text()


def test_the_readme_shows_exactly_two_set_up_and_run_lines() -> None:
    lines = [line for line in (ROOT / "README.md").read_text().splitlines() if "-m venv" in line]
    assert len(lines) == 2
    assert lines[0].endswith("-m compare.all")
    assert lines[1].endswith("-m pytest")
    assert all("-c constraints.txt" in line for line in lines)
