"""The certified bound, verified optimum and features of an instance: proved once, then read from the store."""

from __future__ import annotations

import hashlib
from dataclasses import asdict
from functools import lru_cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Any

from compare.benchmark.ladders import LadderRecord, ladder_record
from compare.benchmark.records.provenance import problem_digest, versions_text
from compare.benchmark.suite.features import features_of
from formulations import Problem, ladder
from formulations.proofs.family import PROVERS

TIME_LIMIT = 60.0  # s per instance


def rungs_of(problem: Problem) -> tuple[str, ...]:
    """Return the bounds that grading needs.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    tuple of str
        Keys of ``RUNGS``. Of a family without a prover the bound of every motion is the best there is.
    """
    both = ("family", "family_lower")
    return both if problem.family in PROVERS else (*both, "free_form_lower")


def proof_key(problem: Problem) -> str:
    """Return what a proof depends on: the problem, the versions, and the prover's code.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    str
        A stored proof with another key is made again.
    """
    return f"{problem_digest(problem)} {_prover()} {versions_text()}"


def prove(name: str, problem: Problem) -> tuple[str, LadderRecord, dict[str, Any]]:
    """Find the optimum of an instance, prove its bound, and describe it.

    Parameters
    ----------
    name : str
    problem : Problem

    Returns
    -------
    name : str
    record : LadderRecord
        Its rungs say how each proof ended.
    features : dict
        Those of `Features`; empty if there is no verified optimum.
    """
    found = ladder(problem, rungs=rungs_of(problem), time_limit=TIME_LIMIT)
    record = ladder_record(found)
    record["made_of"] = proof_key(problem)
    features = {} if found.optimum is None else asdict(features_of(problem, found.optimum))
    return name, record, features


@lru_cache(maxsize=1)
def _prover() -> str:
    """A short hash of the source of `formulations`."""
    whole = hashlib.sha256()
    for name, data in sorted(_sources(files("formulations"), "")):
        whole.update(name.encode() + b"\0" + data + b"\0")
    return whole.hexdigest()[:12]


def _sources(folder: Traversable, path: str) -> list[tuple[str, bytes]]:
    found = []
    for entry in folder.iterdir():
        if entry.is_dir():
            found += _sources(entry, f"{path}{entry.name}/")
        elif entry.name.endswith(".py"):
            found.append((path + entry.name, entry.read_bytes()))
    return found
