"""Prove the instances of a suite in the workers; what the store has already is not proved again."""

from __future__ import annotations

from concurrent.futures import Executor

from compare.benchmark.records.store import Store
from compare.benchmark.run import each
from compare.benchmark.suite.instance import Instance
from compare.benchmark.suite.proof import proof_key, prove


def prove_all(pool: Executor, instances: list[Instance], store: Store) -> None:
    """Prove every instance whose proof the store does not have yet; the longest first.

    Parameters
    ----------
    pool : Executor
    instances : list of Instance
    store : Store
        It keeps the instances too, with their features.
    """
    known, described = store.ladders(), store.instances()
    by_name = {one.name: one for one in instances}
    calls = [
        (one.name, one.problem)
        for one in sorted(instances, key=lambda one: -one.problem.n_segments)
        if one.name not in known
        or known[one.name].get("made_of") != proof_key(one.problem)
        or "features" not in described.get(one.name, {})
    ]
    for name, record, features in each(pool, "proofs", prove, calls):
        store.write_ladder(name, record)
        store.write_instance(name, {**by_name[name].to_json(), "features": features})
