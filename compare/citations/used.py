"""What one run has used: cases, families, rungs, algorithms and libraries, each by its name."""

from __future__ import annotations

import re
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple, NotRequired

import numpy as np

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.store import Store
from compare.citations.cited import CITED, STOP_AND_GO, CitedKind
from compare.plain_data import read_json
from formulations import CASES, InputError, Problem, load
from formulations.rungs import usual_rungs
from metaheuristics import ALGORITHMS
from metaheuristics.by_name import LIBRARIES

_GRADINGS = ("grade.html", "versus.html")  # pages of timebound grade and versus in their folders
_OF_GRADINGS = ("pairs", "instances", "equivalence", "runtimes", "seeds")  # their statistics
_SAME_AS = re.compile(r"that of (\w+)")  # note of a rung that has taken the number of another one


class Used(NamedTuple):
    """One thing that a run has used; ``papers`` is empty where no paper is known."""

    kind: CitedKind
    name: str
    papers: tuple[str, ...]


class SolveAnswer(LadderRecord):
    """What ``timebound solve --json`` writes."""

    diagnosis: NotRequired[Any]


def used_by(source: str) -> list[Used]:
    """List what a run has used, or will use.

    Parameters
    ----------
    source : str
        A shipped case or a problem file: what ``timebound solve`` uses for it. A JSON file that
        ``timebound solve --json`` wrote: what gave a number. A folder of ``timebound all``, ``grade`` or
        ``versus``: its cases, what gave a number in its ladders and rows, and the statistics of a grading.

    Returns
    -------
    list of Used

    Raises
    ------
    InputError
        It is none of them.
    """
    if source in CASES:
        return _of_problem(load(source), source)
    path = Path(source)
    if path.is_dir():
        return _of_folder(path)
    if path.suffix == ".json":
        return _of_ladder(read_json(path, SolveAnswer, "an answer of timebound solve"))
    return _of_problem(load(path), "")


def used_swarms(names: Iterable[str]) -> list[Used]:
    """List algorithms and the libraries that they come from.

    Parameters
    ----------
    names : iterable of str
        As ``metaheuristics.algorithm`` takes them.

    Returns
    -------
    list of Used
        A plug-in has no paper here.
    """
    found = []
    for name in names:
        if name in ALGORITHMS:
            found.append(_cited(CitedKind.algorithm, name))
            found += [_cited(CitedKind.library, library) for library in ALGORITHMS[name].libraries]
            continue
        library = LIBRARIES.get(name.partition(":")[0])
        found.append(Used(CitedKind.algorithm, name, ()))
        if library is not None:
            found.append(_cited(CitedKind.library, library.distribution))
    return found


def method_for(rung: str, problem: Problem) -> str | None:
    """Name the method by which a rung gets its number, from the limits of the problem alone.

    Parameters
    ----------
    rung : str
        A key of ``RUNGS``.
    problem : Problem

    Returns
    -------
    str or None
        A name of ``CITED[CitedKind.rung]``; None where the rung has no meaning for the problem.
    """
    if rung == "copp_family_path":
        return rung if problem.limits.has_jerk and find_spec("copp_py") is not None else None
    if rung == "toppra_torque":
        return None if problem.conditions.torque is None else rung
    if np.isfinite(problem.limits.acceleration).all():
        return rung
    if rung.startswith("ruckig"):
        return None
    # joints without an acceleration limit change their velocity at once: no program is solved
    return {"free_form_lower": "displacement", "free_form": STOP_AND_GO}.get(rung, rung)


def _cited(kind: CitedKind, name: str) -> Used:
    return Used(kind, name, CITED[kind][name])


def _of_problem(problem: Problem, case: str) -> list[Used]:
    """What ``timebound solve`` uses for a problem."""
    methods = [method_for(key, problem) for key in usual_rungs(problem)]
    return [*_of_case(case), *_of_rungs(dict.fromkeys(filter(None, methods)), problem.family)]


def _of_case(case: str) -> list[Used]:
    return [_cited(CitedKind.case, case)] if case in CASES else []


def _of_rungs(rungs: Iterable[str], family: str) -> list[Used]:
    found = [_cited(CitedKind.rung, key) for key in rungs]
    if any("family" in used.name for used in found):
        found.insert(0, _cited(CitedKind.family, family))
    return found


def _of_ladder(record: LadderRecord) -> list[Used]:
    """What gave a number in an answer of ``timebound solve``, or in the ladder of a comparison."""
    rungs = {key: rung["note"] for key, rung in record["ladder"].items() if rung["status"] == "ok"}
    family = record.get("family") or rungs.get("family", "").partition(";")[0]
    methods = dict.fromkeys(_method(key, note) for key, note in rungs.items())
    try:
        return [*_of_case(record["problem"]), *_of_rungs(methods, family)]
    except KeyError as error:
        raise InputError(f"{record['problem']}: nothing is known of {error} in its ladder") from None


def _method(rung: str, note: str) -> str:
    """The rung whose method gave the number: another one where the note says so."""
    if note.startswith(STOP_AND_GO):
        return STOP_AND_GO
    other = _SAME_AS.match(note)
    return other[1] if other is not None and other[1] in CITED[CitedKind.rung] else rung


def _of_folder(folder: Path) -> list[Used]:
    """What a comparison has used: its ladders, and the swarms of its rows."""
    store = Store(folder)
    grading = any((folder / page).exists() for page in _GRADINGS)
    if not grading:
        store.settings()  # says in one line that there is no comparison
    found = [used for record in store.ladders().values() for used in _of_ladder(record)]
    rows = list(store.iterate_rows())
    origins = {name: str(data.get("origin", "")) for name, data in store.instances().items()}
    for case in dict.fromkeys(row.case for row in rows):
        found += _of_case(origins.get(case, "").removeprefix("perturbed ")) or _of_case(case)
    found += [_cited(CitedKind.family, name) for name in dict.fromkeys(row.family for row in rows)]
    found += used_swarms(dict.fromkeys(row.swarm for row in rows))
    if grading:
        found += [_cited(CitedKind.statistic, name) for name in _OF_GRADINGS]
    return list(dict.fromkeys(found))
