"""Traces in the format of IOHprofiler, which IOHanalyzer and iohinspector read.

    ioh/SWARM-VARIANT/IOHprofiler_fN_TASK.json           who, on what, and the end of each run
    ioh/SWARM-VARIANT/data_fN_TASK/IOHprofiler_fN_DIMD.dat   evaluations and best gap, run after run

The function value ``raw_y`` is the gap to the optimum of the task; the number of the function is that of
the task; the instance is 1, as the runs differ in their seeds alone.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterable
from pathlib import Path

from compare.benchmark.records.exports.curves import SearchCurve, SearchTask, cells, file_name, made_by
from compare.benchmark.records.store import Store
from compare.files import write_text

_VERSION = "0.3.18"  # of the format


def write_ioh(store: Store, folder: Path) -> Iterable[Path]:
    """Write the traces of a comparison for IOHanalyzer and iohinspector.

    Parameters
    ----------
    store : Store
    folder : Path

    Returns
    -------
    iterable of Path
        The folder ``ioh``; one of before is replaced.
    """
    target = folder / "ioh"
    shutil.rmtree(target, ignore_errors=True)
    for name, task, curves in cells(store):
        _write(target / file_name(name), name, task, curves)
    return [target]


def _write(folder: Path, name: str, task: SearchTask, curves: list[SearchCurve]) -> None:
    where = f"f{task.number}_{file_name(task.name)}"
    data = f"data_{where}/IOHprofiler_f{task.number}_DIM{task.dimension}.dat"
    (folder / data).parent.mkdir(parents=True, exist_ok=True)
    lines = ["evaluations raw_y"]
    runs = []
    for curve in curves:
        lines += [
            f"{n} {gap!r}"
            for n, gap in zip(curve.evaluations.tolist(), curve.gaps.tolist(), strict=True)
        ]
        best = int(curve.gaps.argmin())
        runs.append(
            {
                "instance": 1,
                "evals": int(curve.evaluations[-1]),
                "best": {"evals": int(curve.evaluations[best]), "y": float(curve.gaps[best]), "x": []},
            }
        )
    write_text(folder / data, "\n".join(lines) + "\n")
    row = curves[0].row
    told = ("coding", "track", "coordinates", "budget", "population", "machine")
    scenario = {"dimension": task.dimension, "path": data, "runs": runs}
    whole = {
        "version": _VERSION,
        "suite": "timebound",
        "function_id": task.number,
        "function_name": task.name,
        "maximization": False,
        "algorithm": {"name": name, "info": made_by(row)},
        "experiment_attributes": [{key: getattr(row, key)} for key in told],
        "attributes": ["evaluations", "raw_y"],
        "scenarios": [scenario],
    }
    # a run without any feasible point has no finite best value; the format writes Infinity for it
    write_text(folder / f"IOHprofiler_{where}.json", json.dumps(whole, indent=2) + "\n")
