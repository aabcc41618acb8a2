"""Traces as archives of COCO, which ``cocopp`` reads: one zip file per swarm and variant.

    coco/whole/SWARM-VARIANT.zip    searches of all joints at once; a function is a case
    coco/joints/SWARM-VARIANT.zip   searches of single joints; a function is a joint of a case
    coco/*/tasks.txt                which function of COCO's numbering stands for which task

COCO knows the functions of its own suites alone. The tasks therefore stand under the numbers 1 to 24 of the
suite bbob, and further ones in ``whole-2`` and so on; COCO's names of these functions and its reference "best
2009" say nothing about them. The value is the gap to the optimum of the task, 1e9 while nothing feasible is
found; COCO's targets 1e2 to 1e-8 are gaps.
"""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Iterable, Iterator
from pathlib import Path

from compare.benchmark.records.exports.curves import (
    SearchCurve,
    SearchTask,
    cells,
    file_name,
    made_by,
    tasks,
)
from compare.benchmark.records.store import Store
from compare.files import write_text

_FUNCTIONS = 24  # of the suite bbob
_INFEASIBLE = 1e9
_HEADER = (
    "% f evaluations | g evaluations | best noise-free fitness - Fopt (0.000000000000e+00) + sum g_i+"
    " | measured fitness | best measured fitness or single-digit g-values | x1 | x2..."
)


def write_coco(store: Store, folder: Path) -> Iterable[Path]:
    """Write the traces of a comparison for ``cocopp``.

    Parameters
    ----------
    store : Store
    folder : Path

    Returns
    -------
    iterable of Path
        The folder ``coco``; one of before is replaced.
    """
    target = folder / "coco"
    shutil.rmtree(target, ignore_errors=True)
    places = _places(tasks(store).values())
    for name, task, curves in cells(store):
        part, number = places[task]
        (target / part).mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(
            target / part / f"{file_name(name)}.zip", "a", zipfile.ZIP_DEFLATED
        ) as file:
            for path, text in _files(file_name(name), number, task, curves):
                file.writestr(path, text)
    for part in {part for part, _ in places.values() if (target / part).exists()}:
        lines = [
            f"f{number} {task.dimension}D {task.name}: optimum {task.optimum!r} s"
            for task, (where, number) in places.items()
            if where == part
        ]
        write_text(target / part / "tasks.txt", "\n".join(lines) + "\n")
    return [target]


def _places(found: Iterable[SearchTask]) -> dict[SearchTask, tuple[str, int]]:
    """Folder and number of the function of each task."""
    places = {}
    count = {"whole": 0, "joints": 0}
    for task in found:
        kind = "whole" if task.joint < 0 else "joints"
        part, index = divmod(count[kind], _FUNCTIONS)
        places[task] = (f"{kind}-{part + 1}" if part else kind, index + 1)
        count[kind] += 1
    return places


def _files(
    name: str, number: int, task: SearchTask, curves: list[SearchCurve]
) -> Iterator[tuple[str, str]]:
    """The three files of a task: index, data by target, data by number of evaluations."""
    data = f"data_f{number}/bbobexp_f{number}_DIM{task.dimension}"
    ends = [f"1:{int(c.evaluations[-1])}|{_shown(c.gaps.min())}" for c in curves]
    index = (
        f"suite = 'bbob', funcId = {number}, DIM = {task.dimension}, Precision = 1.000e-08,"
        f" algId = '{name}', coco_version = '2.6', logger = 'bbob-new2', data_format = 'bbob-new2'\n"
        f"% {task.name}; {made_by(curves[0].row)}\n"
        f"{data}.dat, {', '.join(ends)}\n"
    )
    yield f"{name}/bbobexp_f{number}.info", index
    runs = []
    for curve in curves:
        runs.append(_HEADER)
        for evaluations, gap in zip(curve.evaluations.tolist(), curve.gaps, strict=True):
            value = _shown(gap)
            runs.append(f"{evaluations} 0 {value} {value} {value}")
    text = "\n".join(runs) + "\n"
    yield f"{name}/{data}.dat", text
    yield f"{name}/{data}.tdat", text


def _shown(gap: float) -> str:
    return f"{min(float(gap), _INFEASIBLE):+.12e}"
