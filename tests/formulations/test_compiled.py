"""Interpreted and compiled formulas give the same bits, and the compiler is asked only when it pays."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from formulations import FAMILIES, load
from formulations import compiled as module
from formulations.compiled import Late, compiled, interpreted
from formulations.proofs.proof import Proof
from formulations.proofs.three_five_three import bound as three_five_three
from formulations.proofs.three_five_three.search import branch_and_bound as search


@compiled
def _inner(x: float) -> float:
    return x / 3.0 + 1.0


@compiled
def _outer(x: float) -> float:
    return _inner(x) * _inner(-x)


@pytest.mark.parametrize("L", [4.6, 4.7])
def test_a_proof_is_the_same_interpreted_and_compiled(
    L: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    logs: list[Any] = []
    for how in (search, interpreted(search)):
        monkeypatch.setattr(three_five_three, "_search", how)
        proof = Proof(three_five_three.begin(load("sr4c"), L), L, record=True)
        proof.run(100)
        assert proof.proved
        logs.append(proof.log())
    for part in ("codes", "values", "boxes", "rows"):
        first, second = (getattr(log, part) for log in logs)
        assert first.tobytes() == second.tobytes(), part


@pytest.mark.parametrize("family", FAMILIES)
def test_one_spline_has_the_bits_it_has_among_others(family: str) -> None:
    problem = load("sr4c")
    t = np.random.default_rng(7).uniform(0.2, 2.0, (3, 3))
    together = FAMILIES[family].coefficients(problem, t)
    for k in range(3):
        assert FAMILIES[family].coefficients(problem, t[[k]]).tobytes() == together[[k]].tobytes()


def test_interpreted_functions_call_nothing_compiled() -> None:
    plain = interpreted(_outer)
    assert plain(2.0) == _outer(2.0)
    assert not hasattr(plain.__globals__["_inner"], "py_func")


def test_the_compiler_is_asked_once_the_time_is_spent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_on_disk", lambda function: False)
    asked: list[float] = []
    late = Late(_outer)
    late._compiled = lambda x: asked.append(x)
    late._plain = interpreted(_outer)
    assert late(2.0) == _outer(2.0)
    assert not asked
    monkeypatch.setattr(module, "_PATIENCE", 0.0)
    late(3.0)
    assert asked == [3.0]
