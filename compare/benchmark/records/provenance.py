"""What made a row: code, parameters, versions, problem and machine; equal provenance, equal results."""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib.util
import json
import os
import platform
import sysconfig
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from compare.benchmark.coordinates import seen_in
from compare.benchmark.objective import Objective
from compare.benchmark.records.instances import tool_as_json
from formulations import Problem
from formulations.climb import versions
from formulations.problem.toml_file.plain_conditions import (
    table_of_limits,
    tables_of_conditions,
    without_infinities,
)
from metaheuristics import Algorithm, algorithm, minimise
from metaheuristics.entry import TIME_LIMIT

# what every run goes through, whatever its swarm: the driver, the coding and the coordinates
_ALWAYS = (minimise.__module__, Objective.__module__, seen_in.__module__)


@dataclass(frozen=True, slots=True)
class Provenance:
    """What a row depends on beside its run. Its fields are columns of `compare.benchmark.records.rows.Row`."""

    library: str
    parameters: str
    code: str
    isolated: bool
    time_limit: float | None
    problem: str
    versions: str

    def difference(self, made_by: Mapping[str, object]) -> str | None:
        """Say in what a row differs from this provenance.

        Parameters
        ----------
        made_by : mapping of str to object
            Columns of the row.

        Returns
        -------
        str or None
            The first difference in words, None if the row was made by the same.
        """
        for field in fields(self):
            if made_by[field.name] != getattr(self, field.name):
                return _DIFFERENCES[field.name]
        # code that cannot be read may have changed
        return None if self.code else _DIFFERENCES["code"]


_DIFFERENCES = {
    "library": "another version of the swarm's library",
    "parameters": "other parameters of the swarm",
    "code": "other code of the swarm",
    "isolated": "other isolation of the swarm",
    "time_limit": "another time limit",
    "problem": "another problem",
    "versions": "other versions of the programs",
}


def provenance_of(
    swarm: str,
    problem: Problem,
    population: int,
    time_limit: float | None,
    constants: Sequence[tuple[str, Any]] = (),
) -> Provenance:
    """Return what a run of this swarm on this problem depends on here and now.

    Parameters
    ----------
    swarm : str
    problem : Problem
    population : int
        Asked for; swarms without such a parameter ignore it.
    time_limit : float or None [s]
        Of a swarm in a process of its own. None: the swarm runs in this process if it is trusted, else
        in its own for at most `metaheuristics.entry.TIME_LIMIT`.
    constants : sequence of (str, value)
        Constants of the swarm in place of the published ones.

    Returns
    -------
    Provenance
    """
    found = algorithm(swarm)
    if time_limit is None and not found.trusted:
        time_limit = TIME_LIMIT
    return Provenance(
        library=found.versions,
        parameters=parameters_text(parameters_of(found, population, constants)),
        code=code_digest(swarm),
        isolated=time_limit is not None,
        time_limit=time_limit,
        problem=problem_digest(problem),
        versions=versions_text(),
    )


def parameters_of(
    swarm: Algorithm, population: int, constants: Sequence[tuple[str, Any]] = ()
) -> dict[str, Any]:
    """Return the parameters of a swarm, with this population if it has one.

    Parameters
    ----------
    swarm : Algorithm
    population : int
    constants : sequence of (str, value)
        In place of the published ones.

    Returns
    -------
    dict of str to Any
        Keyword arguments for ``minimise``.
    """
    parameters = dict(swarm.parameters)
    if "population" in parameters:
        parameters["population"] = population
    return parameters | dict(constants)


def parameters_text(parameters: dict[str, Any]) -> str:
    """Return parameters as JSON, in the order of their names.

    Parameters
    ----------
    parameters : dict
        A value that is no JSON is written as its ``repr``.

    Returns
    -------
    str
    """
    return json.dumps(parameters, sort_keys=True, default=repr)


@lru_cache(maxsize=256)
def code_digest(swarm: str) -> str:
    """Return a short hash of the source code that a swarm's results depend on.

    The swarm's own module, every module of ``metaheuristics`` that it imports, directly or not, the
    driver and the coding. Of a plug-in also the modules beside it that it imports.

    Parameters
    ----------
    swarm : str

    Returns
    -------
    str
        12 hexadecimal digits; empty if the source of the swarm cannot be read.
    """
    files: dict[str, Path] = {}
    waiting = [*_modules_of(swarm), *_ALWAYS]
    own = [name for name in waiting if name not in _ALWAYS]
    beside = _folder_of(own[0]) if not algorithm(swarm).trusted else None
    while waiting:
        name = waiting.pop()
        if name in files:
            continue
        path = _source_file(name, beside)
        if path is None:
            if name in own:
                return ""
            continue
        files[name] = path
        waiting += [
            found
            for found in _imported(name, path)
            if found.split(".")[0] == "metaheuristics"
            or (beside is not None and _beside(found, beside) is not None)
        ]
    whole = hashlib.sha256()
    for name in sorted(files):
        whole.update(name.encode() + b"\0" + files[name].read_bytes() + b"\0")
    return whole.hexdigest()[:12]


def _modules_of(swarm: str) -> list[str]:
    """Names of the modules that hold a swarm's code, its own first."""
    found = algorithm(swarm)
    if not found.trusted:
        return [swarm.partition(":")[0]]
    function: Any = found.function
    while isinstance(function, functools.partial):
        function = function.func
    return [str(function.__module__)]


def _folder_of(module: str) -> Path | None:
    """The folder from which a plug-in is imported; None if that is where packages are installed."""
    path = _source_file(module, None)
    if path is None:
        return None
    folder = path.parents[module.count(".") + (path.name == "__init__.py")]
    installed = {Path(sysconfig.get_path(kind)) for kind in ("stdlib", "purelib", "platlib")}
    return None if folder in installed else folder


def _source_file(module: str, beside: Path | None) -> Path | None:
    """The file of a module's source, None if it has none that can be read."""
    if beside is not None and (found := _beside(module, beside)) is not None:
        return found
    try:
        spec = importlib.util.find_spec(module)
    except (ImportError, ValueError, AttributeError):
        spec = None
    if spec is None or spec.origin is None:
        # the working directory is a place of plug-ins too
        return _beside(module, Path.cwd())
    path = Path(spec.origin)
    return path if path.suffix == ".py" and path.is_file() else None


def _beside(module: str, folder: Path) -> Path | None:
    """The file of a module below a folder."""
    stem = folder.joinpath(*module.split("."))
    for path in (stem.with_name(stem.name + ".py"), stem / "__init__.py"):
        if path.is_file():
            return path
    return None


def _imported(module: str, path: Path) -> Iterator[str]:
    """Names of the modules that a source file imports, and of what may be modules."""
    try:
        tree = ast.parse(path.read_bytes())
    except (SyntaxError, ValueError):
        return
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            parts = package.split(".")
            above = ".".join(parts[: len(parts) - node.level + 1]) if node.level else ""
            source = ".".join(part for part in (above, node.module or "") if part)
            if source:
                yield source
                yield from (f"{source}.{alias.name}" for alias in node.names)


def problem_digest(problem: Problem) -> str:
    """Return a short hash of what defines a problem: waypoints, limits, conditions, limited tool and family.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    str
        12 hexadecimal digits.
    """
    limits = problem.limits
    parts = (problem.waypoints, limits.derivatives, limits.position)
    data = b"".join(np.ascontiguousarray(part).tobytes() for part in parts)
    if not problem.plain:
        asked = [tables_of_conditions(problem), table_of_limits(limits)]
        asked += [tool] if (tool := tool_as_json(problem)) else []
        data += json.dumps(without_infinities(asked), sort_keys=True, allow_nan=False).encode()
    return hashlib.sha256(data + problem.family.encode()).hexdigest()[:12]


@lru_cache(maxsize=1)
def versions_text() -> str:
    """Versions of the programs that made the numbers, on one line."""
    return " ".join(f"{name}={version}" for name, version in versions().items())


@lru_cache(maxsize=1)
def machine() -> str:
    """Processor, cores and system, on one line."""
    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
        model = names[0] if names else model
    except OSError:
        pass  # no Linux: the general name stands
    return f"{model}, {os.cpu_count()} cores, {platform.system()}"
