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
    finds and proves bounds; certified: whether the bound of the spline family was to be proved.
    """

    problem: str
    versions: str
    code: str
    certified: bool


def proof_key(problem: Problem, *, certify: bool = True) -> ProofKey:
    """Return what the bounds of a problem depend on here and now.

    Parameters
    ----------
    problem : Problem
    certify : bool
        Whether the bound of the spline family is to be proved.

    Returns
    -------
    ProofKey
    """
    return ProofKey(instance_digest(problem), versions_text(), _prover_digest(), certify)


@cache
def _prover_digest() -> str:
    """Digest of the whole of ``formulations``, and of what makes a record of a ladder."""
    root = Path(formulations.__file__).parent
    files = [*sorted(root.rglob("*.py")), Path(ladders.__file__)]
    whole = hashlib.sha256()
    for path in files:
        whole.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return whole.hexdigest()[:16]
