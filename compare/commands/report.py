"""``timebound report DIR``: the report of a comparison, drawn again from its store."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from compare.benchmark.records.store import Store
from compare.benchmark.run import workers
from compare.commands import DONE
from compare.commands.options import Jobs
from compare.report.page import render


def report(folder: Annotated[str, Parameter(name="DIR")], /, *, jobs: Jobs = 2) -> int:
    """Draw the report of a comparison again from its stored rows; nothing is run.

    Parameters
    ----------
    folder
        The folder that ``timebound all`` wrote.
    """
    store = Store(Path(folder))
    settings = store.settings()
    with workers(jobs) as pool:
        page = render(pool, store.folder, store.problems(), settings)
    print(f"report: {page}")
    return DONE
