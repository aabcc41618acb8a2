"""What is graded, by name: ``mine.py:swarm``, ``module:function``, ``library:Name``, or one of the registry."""

from __future__ import annotations

import ast
import importlib.util
import sys
from difflib import get_close_matches
from pathlib import Path

from metaheuristics import ALGORITHMS, NOT_REPRODUCIBLE, UnknownAlgorithmError, algorithm


def swarm_name(typed: str) -> str:
    """Return the name by which `metaheuristics.algorithm` knows what was typed, loaded once.

    Parameters
    ----------
    typed : str
        ``FILE.py:function``, or a name that `metaheuristics.algorithm` takes. The folder of the file is
        added to the places where modules are looked for.

    Returns
    -------
    str

    Raises
    ------
    UnknownAlgorithmError
        There is none; the message says why and which name is near.
    MissingLibraryError
        Its library is not installed.
    """
    place, colon, attribute = typed.rpartition(":")
    if typed.endswith(".py") or place.endswith(".py"):
        path, attribute = (Path(place), attribute) if colon and place else (Path(typed), "")
        name = _of_file(typed, path, attribute)
    else:
        name = typed
    try:
        algorithm(name)
    except UnknownAlgorithmError as error:
        hint = "" if ":" in name or name in NOT_REPRODUCIBLE else _near(name, list(ALGORITHMS))
        raise UnknownAlgorithmError(f"{error}{hint}") from None
    return name


def _of_file(typed: str, path: Path, attribute: str) -> str:
    """``module:function`` of a file, whose folder becomes a place of modules."""
    if not path.is_file():
        folder = path.parent
        beside = sorted(p.name for p in folder.glob("*.py")) if folder.is_dir() else []
        raise UnknownAlgorithmError(f"{typed}: there is no file {path}{_near(path.name, beside)}")
    defined, others = _names_in(typed, path)
    if attribute.partition(".")[0] not in (*defined, *others):
        missing = (
            f"{path} defines no {attribute!r}" if attribute else "a name is missing after the file"
        )
        listed = f" ({path.name} defines {', '.join(defined) or 'no function and no class'})"
        raise UnknownAlgorithmError(f"{typed}: {missing}{_near(attribute, defined)}{listed}")
    module, home = path.stem, str(path.resolve().parent)
    if home not in sys.path:
        sys.path.append(home)
    importlib.invalidate_caches()
    found = None if not module.isidentifier() else importlib.util.find_spec(module)
    if found is None or found.origin is None or Path(found.origin).resolve() != path.resolve():
        reason = f"another module is called {module}" if found else f"{module} is no name of a module"
        raise UnknownAlgorithmError(f"{typed}: {reason}; rename the file")
    return f"{module}:{attribute}"


def _names_in(typed: str, path: Path) -> tuple[list[str], list[str]]:
    """Functions and classes that a file defines, and other names in it; the file is read and not run."""
    try:
        tree = ast.parse(path.read_bytes())
    except (SyntaxError, ValueError) as error:
        line = f", line {error.lineno}" if isinstance(error, SyntaxError) else ""
        raise UnknownAlgorithmError(
            f"{typed}: {path} is no Python file{line}: {error.args[0]}"
        ) from None
    defined: list[str] = []
    others: list[str] = []
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            defined.append(node.name)
        elif isinstance(node, ast.ImportFrom | ast.Import):
            others += [(alias.asname or alias.name).partition(".")[0] for alias in node.names]
        elif isinstance(node, ast.Assign):
            others += [target.id for target in node.targets if isinstance(target, ast.Name)]
    return [name for name in defined if not name.startswith("_")], others


def _near(name: str, names: list[str]) -> str:
    near = get_close_matches(name, names, 1, cutoff=0.5)
    return f"; did you mean {near[0]!r}?" if near else ""
