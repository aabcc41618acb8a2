"""The commands of the studies, one thin file each."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from compare.commands import DONE
from compare.engines import workers
from compare.files import output_folder
from compare.screen import show
from compare.studies.study import Call, Study, run


def in_workers(
    study: Study[Any], calls: list[Call], *, out: str, jobs: int, resume: bool, json: str | None
) -> int:
    """Run a study in worker processes, write its files, and show its summary.

    Parameters
    ----------
    study : Study
        What is computed and told.
    calls : list of tuples
        Arguments of ``study.compute``.
    out, jobs, resume, json
        The options of the command.

    Returns
    -------
    int
        The exit code.
    """
    folder = output_folder(out)
    with workers(jobs) as pool:
        found = run(study, calls, folder=folder, pool=pool, resume=resume)
    show(found.as_text(), found.to_json(), json)
    return DONE


def alone(study: Study[Any], calls: list[Call], *, out: str | None, resume: bool) -> Any:
    """Run a study in this process, as a measurement of time needs it.

    Parameters
    ----------
    study : Study
        What is computed and told.
    calls : list of tuples
        Arguments of ``study.compute``.
    out : str or None
        Folder of its files; None: nothing is written.
    resume : bool
        Keep the calls that an earlier run in this folder has finished.

    Returns
    -------
    Findings
        Rows and summary.
    """
    folder: Path | None = None if out is None else output_folder(out)
    return run(study, calls, folder=folder, resume=resume)
