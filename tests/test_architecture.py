"""Every import stands in the table of docs/ARCHITECTURE.md, and the table has no row that nothing needs."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("formulations", "metaheuristics", "compare")


@cache
def table() -> dict[str, tuple[str, ...]]:
    """The rows: folder or file -> what it may import."""
    text = (ROOT / "docs" / "ARCHITECTURE.md").read_text("utf-8")
    rows = re.findall(r"^\| `([^`]+)` \|(.*)\|$", text, re.MULTILINE)
    return {path: tuple(re.findall(r"`([\w/.]+)`", allowed)) for path, allowed in rows}


def row_of(path: str) -> str:
    """The longest row that a file lies in; the file itself where there is none."""
    rows = [row for row in table() if path == row or path.startswith(f"{row}/")]
    return max(rows, key=len, default=path)


def file_of(module: str) -> str | None:
    """The file of a module of the project, relative to the root; None if it is none."""
    path = Path(*module.split("."))
    for candidate in (path.with_suffix(".py"), path / "__init__.py"):
        if (ROOT / candidate).is_file():
            return candidate.as_posix()
    return None


def imports_of(path: Path) -> set[str]:
    """Files of the project that a file imports."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            modules = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            # a name may be a module of the package, or a name in it
            modules = [
                name if file_of(name := f"{node.module}.{alias.name}") else node.module
                for alias in node.names
            ]
        else:
            continue
        found |= {file for module in modules if (file := file_of(module))}
    return found


def edges() -> list[tuple[str, str]]:
    """All imports between two rows, as files."""
    return [
        (path.relative_to(ROOT).as_posix(), target)
        for package in PACKAGES
        for path in (ROOT / package).rglob("*.py")
        for target in imports_of(path)
        if row_of(path.relative_to(ROOT).as_posix()) != row_of(target)
    ]


def test_every_import_stands_in_the_table() -> None:
    found = edges()
    assert len(found) > 100
    wrong = [
        f"{path} imports {target}"
        for path, target in found
        if not any(
            target == allowed or target.startswith(f"{allowed}/")
            for allowed in table().get(row_of(path), ())
        )
    ]
    assert not wrong, "\n".join(wrong)


def test_every_file_lies_in_a_row_and_every_row_is_there() -> None:
    files = {
        path.relative_to(ROOT).as_posix()
        for package in PACKAGES
        for path in (ROOT / package).rglob("*.py")
    }
    homeless = {file for file in files if row_of(file) not in table()}
    assert all(file.endswith("__init__.py") and not imports_of(ROOT / file) for file in homeless)
    assert not [row for row in table() if not (ROOT / row).exists()]


def test_the_table_allows_nothing_that_nobody_imports() -> None:
    found = edges()
    idle = [
        f"{row}: {allowed}"
        for row, targets in table().items()
        for allowed in targets
        if not any(
            row_of(path) == row and (target == allowed or target.startswith(f"{allowed}/"))
            for path, target in found
        )
    ]
    assert not idle, idle


def test_the_picture_shows_every_folder() -> None:
    text = (ROOT / "docs" / "ARCHITECTURE.md").read_text("utf-8")
    for package in PACKAGES:
        for folder in (ROOT / package).iterdir():
            if folder.is_dir() and (folder / "__init__.py").exists():
                assert f"{folder.name}/" in text, folder
