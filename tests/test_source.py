"""Rules of the source: short files, few arguments of kernels, one meaning per class name, full docstrings."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("formulations", "metaheuristics", "compare")
LONGEST = 350  # lines
MOST_ARGUMENTS = 8  # positional ones of a compiled function


@cache
def sources() -> dict[str, ast.Module]:
    """Every module of the three packages, by its path."""
    files = [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]
    return {str(path.relative_to(ROOT)): ast.parse(path.read_text("utf-8")) for path in files}


def test_no_file_is_longer_than_350_lines() -> None:
    files = [path for top in (*PACKAGES, "tests") for path in (ROOT / top).rglob("*.py")]
    lengths = {path: len(path.read_text("utf-8").splitlines()) for path in files}
    assert not {str(path): n for path, n in lengths.items() if n > LONGEST}


def test_kernels_take_at_most_eight_positional_arguments() -> None:
    kernels = [
        (path, node)
        for path, tree in sources().items()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
        and {"compiled", "inlined"} & {ast.unparse(d).split("(")[0] for d in node.decorator_list}
    ]
    assert len(kernels) > 40
    for path, node in kernels:
        count = len(node.args.posonlyargs) + len(node.args.args)
        assert count <= MOST_ARGUMENTS, (path, node.name, count)


def test_no_two_classes_have_one_name() -> None:
    homes = defaultdict(list)
    for path, tree in sources().items():
        for node in tree.body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                homes[node.name].append(path)
    assert not {name: paths for name, paths in homes.items() if len(paths) > 1}


def used_elsewhere() -> dict[str, set[str]]:
    """Names that other modules of the project import, by module; a module imported whole stands as ``*``."""
    used: dict[str, set[str]] = defaultdict(set)
    for tree in sources().values():
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] in PACKAGES:
                for alias in node.names:
                    used[str(node.module)].add(alias.name)
                    used[f"{node.module}.{alias.name}"].add("*")
    return used


def faults(function: ast.FunctionDef) -> list[str]:
    """What is missing in a docstring: sections, and parameters by name."""
    every = [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs]
    names = [argument.arg for argument in every if argument.arg not in ("self", "cls")]
    if not names:
        return []
    text = ast.get_docstring(function) or ""
    found = []
    if re.search(r"^Parameters\n-+$", text, re.MULTILINE):
        found += [
            name
            for name in names
            if not re.search(rf"^(?:.*[, ])?\*{{0,2}}{name}(?:,.*)? :", text, re.MULTILINE)
        ]
    else:
        found.append("Parameters")
    returned = function.returns
    nothing = returned is None or (isinstance(returned, ast.Constant) and returned.value is None)
    if not nothing and not re.search(r"^(Returns|Yields)\n-+$", text, re.MULTILINE):
        found.append("Returns")
    return found


def test_what_other_modules_use_has_numpy_sections() -> None:
    used = used_elsewhere()
    missing, looked_at = [], 0
    for path, tree in sources().items():
        module = path.removesuffix(".py").replace("/", ".")
        for node in tree.body:
            if not isinstance(node, ast.FunctionDef | ast.ClassDef) or node.name.startswith("_"):
                continue
            if not {"*", node.name} & used[module]:
                continue
            functions = [node] if isinstance(node, ast.FunctionDef) else node.body
            for function in functions:
                if isinstance(function, ast.FunctionDef) and not function.name.startswith("_"):
                    looked_at += 1
                    if wrong := faults(function):
                        missing.append(f"{path}: {function.name}: {', '.join(wrong)}")
    assert looked_at > 500
    assert not missing, "\n".join(missing)
