"""Prove the instances of a suite in the workers; what the store has already is not proved again."""

from __future__ import annotations

from concurrent.futures import Executor
from typing import Any

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.proof_cache import proof_key
from compare.benchmark.records.store import Store
from compare.benchmark.run import each
from compare.benchmark.suite.instance import Instance
from compare.benchmark.suite.proof import prove


def prove_all(pool: Executor, instances: list[Instance], store: Store) -> None:
    """Prove every instance whose proof the store does not have yet; the longest first.

    Parameters
    ----------
    pool : Executor
    instances : list of Instance
    store : Store
        It keeps the instances too, with their features.
    """
    by_name = {one.name: one for one in instances}
    keys = {one.name: proof_key(one.problem, "suite") for one in instances}
    calls = []
    for one in sorted(instances, key=lambda one: -one.problem.n_segments):
        known = store.proved(keys[one.name])
        if known is None:
            calls.append((one.name, one.problem))
        else:
            _keep(store, one, known["ladder"], known["features"])
    for name, record, features in each(pool, "proofs", prove, calls):
        if features:  # else no optimum was found in time, and another run may find it
            store.write_proof(keys[name], {"ladder": record, "features": features})
        _keep(store, by_name[name], record, features)


def _keep(store: Store, one: Instance, record: LadderRecord, features: dict[str, Any]) -> None:
    store.write_ladder(one.name, record)
    store.write_instance(one.name, {**one.to_json(), "features": features})
