"""What a proved bound depends on: the same problem, versions and prover give the same bounds again."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path
from typing import NamedTuple

import formulations
from compare.benchmark import ladders
from compare.benchmark.records.instances import instance_digest
from compare.benchmark.records.provenance import versions_text
from formulations import Problem


class ProofKey(NamedTuple):
    """The key of the bounds of one problem in the store.

    problem: digest of all that it states; versions: of the programs; code: digest of the source that
    finds and proves bounds; asked: which bounds were asked for.
    """

    problem: str
    versions: str
    code: str
    asked: str


def proof_key(problem: Problem, asked: str) -> ProofKey:
    """Return what the bounds of a problem depend on here and now.

    Parameters
    ----------
    problem : Problem
    asked : str
        A word for the bounds that are asked for: other bounds of the problem are another entry.

    Returns
    -------
    ProofKey
    """
    return ProofKey(instance_digest(problem), versions_text(), _prover_digest(), asked)


@cache
def _prover_digest() -> str:
    """Digest of the whole of ``formulations``, and of what makes a record of a ladder."""
    root = Path(formulations.__file__).parent
    files = [*sorted(root.rglob("*.py")), Path(ladders.__file__)]
    whole = hashlib.sha256()
    for path in files:
        whole.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return whole.hexdigest()[:16]
