"""``timebound report DIR``: the report of a comparison, drawn again from its store."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from compare.benchmark.records.store import Store
from compare.benchmark.suite import Instance
from compare.commands import DONE
from compare.commands.options import Jobs
from compare.engines import workers
from compare.papers.making import draw_again
from compare.report.page import render
from compare.report.suite_page import render_suite
from formulations import InputError


def report(folder: Annotated[str, Parameter(name="DIR")], /, *, jobs: Jobs = 2) -> int:
    """Draw the report of a comparison again from its stored rows; nothing is run.

    Parameters
    ----------
    folder
        The folder that ``timebound all`` wrote.
    """
    store = Store(Path(folder))
    settings = store.settings()
    stored = store.instances()
    instances = [Instance.from_json(stored[case]) for case in settings.cases if case in stored]
    if len(instances) < len(settings.cases):
        raise InputError(
            f"{folder}: the problems of {len(settings.cases) - len(instances)} cases are missing"
        )
    if settings.size == "suite":
        page = render_suite(store, instances, settings)
    else:
        problems = {one.name: one.problem for one in instances}
        with workers(jobs) as pool:
            page = render(pool, store.folder, problems, settings)
        draw_again(store.folder, jobs)
    print(f"report: {page}")
    return DONE
