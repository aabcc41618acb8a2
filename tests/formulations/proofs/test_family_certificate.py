"""The certificate of a family's bound: an independent program proves it again."""

from __future__ import annotations

import ast
import copy
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from family_problems import (
    CASES_353,
    as_quintic,
    closed,
    outcome,
    planted,
    random_problem,
    scaled,
    z1_bound,
)

from compare.check_certificate import __main__ as check_certificate
from compare.check_certificate.__main__ import BAD_INPUT, CERTIFIED, REFUSED
from formulations import (
    FamilyBound,
    family_bound,
    family_optimum,
    load,
)
from formulations.proofs.certificate import certificate_of, certificate_of_proof, write_certificate
from formulations.proofs.displacement import displacement_bound
from formulations.proofs.proof import Proof
from formulations.proofs.quintic import bound as quintic

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def sr4c() -> FamilyBound:
    return family_bound(load("sr4c"), record=True)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES_353)
def test_the_checker_proves_every_shipped_3_5_3_case_again(case: str, tmp_path: Path) -> None:
    problem = load(case)
    path = tmp_path / "certificate.json"
    for each in [problem, *(problem.joint(j) for j in problem.moving_joints)]:
        bound = family_bound(each, optimum=family_optimum(each, starts=5), record=True)
        assert bound.certificate is not None
        write_certificate(path, bound.certificate)
        named = ["--problem", case] if each is problem else []
        assert check_certificate.main([str(path), *named]) == CERTIFIED
        assert float.fromhex(json.loads(path.read_text())["seconds"]) == bound.seconds


@pytest.mark.long
def test_the_checker_proves_bagging_again(tmp_path: Path) -> None:
    bound = family_bound(load("bagging"), gap=1e-6, record=True)
    assert outcome(tmp_path, bound.certificate, "--problem", "bagging") == CERTIFIED


@pytest.mark.slow
def test_the_checker_follows_open_segments_jumps_and_position_limits(tmp_path: Path) -> None:
    problem = random_problem(np.random.default_rng(3), 4, 2, "VAJ", least=-0.5, still=1)
    bound = family_bound(problem, gap=1e-4, record=True)
    assert bound.status == "proved"
    assert bound.certificate is not None
    kinds = {
        row[0]
        for event in bound.certificate["events"]
        if isinstance(event[-1], list)
        for row in event[-1]
    }
    assert "j" in kinds
    assert outcome(tmp_path, bound.certificate) == CERTIFIED
    for n in (3, 4):
        limited = closed(random_problem(np.random.default_rng(n), n, 2, "VA", least=-0.5), 0.1)
        bound = family_bound(limited, gap=1e-4, record=True)
        if bound.status == "proved":
            assert outcome(tmp_path, bound.certificate) == CERTIFIED


@pytest.mark.parametrize("ends", [(), (0,), (2,)])
def test_the_checker_proves_that_a_still_middle_segment_cannot_vanish(
    ends: tuple[int, ...], tmp_path: Path
) -> None:
    problem = random_problem(np.random.default_rng(1), 3, 2, "VA", least=-0.5, still=1)
    d = np.diff(problem.waypoints, axis=0)
    d[list(ends)] = 0.0  # nothing moves there either
    problem = replace(problem, waypoints=np.concatenate([[np.zeros(2)], np.cumsum(d, axis=0)]))
    bound = family_bound(problem, gap=1e-3, record=True)
    assert bound.status == "proved"
    certificate: Any = bound.certificate
    assert outcome(tmp_path, certificate) == CERTIFIED
    discards = certificate["short"]["discards"]
    for fault in (
        lambda c: c.pop("short"),
        lambda c: c["short"]["discards"].pop(),
        lambda c: c["short"]["discards"].pop(0),
        lambda c: c["short"].update(tau=(0.5 * bound.seconds).hex()),
        lambda c: c["short"]["discards"][-1].__setitem__(-1, -discards[-1][-1]),
        lambda c: c["short"]["discards"][-1].__setitem__(5, (2.0).hex()),
    ):
        faulty = copy.deepcopy(certificate)
        fault(faulty)
        assert outcome(tmp_path, faulty) != CERTIFIED


@pytest.fixture(scope="module")
def z1_as_quintic() -> FamilyBound:
    return z1_bound()


@pytest.mark.slow
def test_every_row_of_a_sum_counts(z1_as_quintic: FamilyBound, tmp_path: Path) -> None:
    bound = z1_as_quintic
    assert bound.certificate is not None
    ((_, rows),) = bound.certificate["events"]  # one sum proves it all
    assert outcome(tmp_path, bound.certificate) == CERTIFIED
    assert (
        outcome(tmp_path, {**bound.certificate, "seconds": (bound.seconds * (1 + 1e-9)).hex()})
        == REFUSED
    )
    for r, row in enumerate(rows[1:], 1):
        for factor in (0.9, 1.1, 100.0):
            wrong = [*row[:-1], (factor * float.fromhex(row[-1])).hex()]
            events = [["L", [*rows[:r], wrong, *rows[r + 1 :]]]]
            assert outcome(tmp_path, {**bound.certificate, "events": events}) == REFUSED


def test_what_an_unfinished_chain_has_proved_can_be_checked(tmp_path: Path) -> None:
    problem = as_quintic(random_problem(np.random.default_rng(2), 4, 2, "VAJ", least=-1.0))
    optimum = family_optimum(problem, starts=3)
    L = optimum.seconds * 1.01  # more than can be proved
    proof = Proof(quintic.begin(problem, L, near=optimum.durations), L)
    reached = []
    for _ in range(6):
        proof.run(1)
        reached.append(proof.seconds)
        assert not proof.proved
        assert outcome(tmp_path, certificate_of_proof(problem, proof)) == CERTIFIED
    assert reached == sorted(reached)
    assert optimum.seconds * 0.95 < reached[-1] <= optimum.seconds


def test_the_domain_alone_is_a_proof_of_displacement_over_speed(tmp_path: Path) -> None:
    simple = certificate_of(load("z1"), displacement_bound(load("z1")))
    assert outcome(tmp_path, simple, "--problem", "z1") == CERTIFIED
    assert outcome(tmp_path, {**simple, "seconds": (7.2542).hex()}) == REFUSED


def test_another_problem_is_refused(sr4c: FamilyBound, tmp_path: Path) -> None:
    assert outcome(tmp_path, sr4c.certificate, "--problem", "sr4c") == CERTIFIED
    assert outcome(tmp_path, sr4c.certificate, "--problem", "ur5") == REFUSED
    assert outcome(tmp_path, sr4c.certificate, "--problem", "no-such-case") == BAD_INPUT
    # lower limits leave the proof true, but of another problem
    lower = planted(lambda c: scaled(c, "velocity", 0, 0.5))(sr4c.certificate)
    assert outcome(tmp_path, lower, "--problem", "sr4c") == REFUSED
    tighter = {**(sr4c.certificate or {}), "position_slack": (0.0).hex()}
    assert outcome(tmp_path, tighter, "--problem", "sr4c") == REFUSED


def test_the_checker_shares_no_code_with_the_prover() -> None:
    """But for the loader, to compare the problem; its own folder, numpy and python-flint are all it has."""
    own = {
        "__future__",
        "bisect",
        "collections.abc",
        "copy",
        "compare.__main__",  # the command line, which loads nothing of the prover: tested there
        "compare.commands",
        "dataclasses",
        "flint",
        "functools",
        "itertools",
        "json",
        "math",
        "numpy",
        "pathlib",
        "sys",
        "typing",
    }
    imported = []
    for path in (ROOT / "compare" / "check_certificate").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Import):
                imported += [name.name for name in node.names]
            elif isinstance(node, ast.ImportFrom):
                imported.append(str(node.module))
    others = [name for name in imported if not name.startswith("compare.check_certificate")]
    loader = ["formulations", "formulations.kinematics.plain_chain", "formulations.problem.demands"]
    assert sorted(set(others) - own) == loader
    assert [others.count(name) for name in loader] == [1, 1, 1]


@pytest.mark.slow
def test_solve_writes_a_certificate_that_the_command_accepts(tmp_path: Path) -> None:
    path = tmp_path / "sr4c.json"
    run = [sys.executable, "-m"]
    solved = subprocess.run(
        [*run, "compare.solve", "sr4c", "--certificate", str(path)],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert solved.returncode == 0, solved.stderr
    assert "family_lower" in solved.stdout
    checked = subprocess.run(
        [*run, "compare.check_certificate", str(path), "--problem", "sr4c"],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert checked.returncode == 0, checked.stderr
    assert checked.stdout.startswith("certified: ")


def test_without_flint_the_checker_names_the_extra(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "flint", None)
    assert check_certificate.main(["any.json"]) == BAD_INPUT
    assert "timebound[certificate]" in capsys.readouterr().err
