"""``timebound export``: the results of a comparison as files that other programs read."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from compare.benchmark.records.exports.formats import FORMATS
from compare.benchmark.records.store import Store
from compare.commands import DONE
from compare.files import output_folder
from formulations import InputError


def export(
    folder: Annotated[str, Parameter(name="DIR")],
    /,
    *,
    parquet: bool = False,
    csv: bool = False,
    ioh: bool = False,
    coco: bool = False,
    out: Annotated[str | None, Parameter(metavar="DIR")] = None,
) -> int:
    """Write the rows and traces of a comparison for other programs.

    Parameters
    ----------
    folder
        The folder that ``timebound all`` wrote.
    parquet
        rows.parquet, a line per run, and traces.parquet, a line per improvement (polars, pandas, R).
    csv
        rows.csv.
    ioh
        A folder per swarm for IOHanalyzer and iohinspector: gap against evaluations.
    coco
        A zip file per swarm for COCO's cocopp: gap to the optimum against evaluations.
    out
        Where the files go; DIR/export if left out.
    """
    asked = {"parquet": parquet, "csv": csv, "ioh": ioh, "coco": coco}
    chosen = [name for name, wanted in asked.items() if wanted]
    if not chosen:
        raise InputError(f"one of {', '.join(f'--{name}' for name in asked)} must be given")
    store = Store(Path(folder))
    store.settings()  # refuses a folder without a comparison
    target = output_folder(Path(folder) / "export" if out is None else out)
    for name in chosen:
        for path in FORMATS[name](store, target):
            print(path)
    return DONE
