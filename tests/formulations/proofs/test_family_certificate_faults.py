"""A planted fault in a certificate is refused, and a hostile file is one line."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from family_problems import (
    anyhow,
    as_quintic,
    outcome,
    planted,
    random_problem,
    scaled,
)

from compare.check_certificate import __main__ as check_certificate
from compare.check_certificate import claim
from compare.check_certificate.__main__ import BAD_INPUT, CERTIFIED, REFUSED
from formulations import (
    FamilyBound,
    family_bound,
    load,
)


@pytest.fixture(scope="module")
def sr4c() -> FamilyBound:
    return family_bound(load("sr4c"), record=True)


def leaves(certificate: Any) -> list[int]:
    return [i for i, event in enumerate(certificate["events"]) if event[0] == "L" and len(event) > 1]


FAULTS: dict[str, Callable[[Any], None]] = {
    "a missing leaf": lambda c: c["events"].pop(leaves(c)[3]),
    "a missing first event": lambda c: c["events"].pop(0),
    "a missing last event": lambda c: c["events"].pop(),
    "a missing split": lambda c: c["events"].pop([e[0] for e in c["events"]].index("S")),
    "an event too many": lambda c: c["events"].append(c["events"][-1]),
    "no events": lambda c: c.update(events=[]),
    "a leaf without rows": lambda c: c["events"].__setitem__(leaves(c)[0], ["L", []]),
    "a split outside": lambda c: c["events"].insert(0, ["S", 0, (1e6).hex()]),
    "the other half empty": lambda c: c["events"].insert(0, ["E"]),
    "a slab too thick": lambda c: c["events"].insert(
        0, ["B", 0, (1e-3).hex(), c["events"][leaves(c)[0]][1]]
    ),
    "a higher acceleration limit": lambda c: (
        [scaled(c, "acceleration", j, 1.02) for j in range(6)] and None
    ),
    "another waypoint": lambda c: c["waypoints"][1].__setitem__(5, (0.9).hex()),
    "a negative slack": lambda c: c.update(position_slack="-0x1p-10"),
    "a negative bound": lambda c: c.update(seconds="-0x1p+2"),
    "a limit of zero": lambda c: c["limits"]["velocity"].__setitem__(0, "0x0p+0"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_the_checker_refuses(fault: str, sr4c: FamilyBound, tmp_path: Path) -> None:
    assert outcome(tmp_path, sr4c.certificate) == CERTIFIED
    assert outcome(tmp_path, planted(FAULTS[fault])(sr4c.certificate)) == REFUSED


def test_every_wrong_multiplier_is_refused(sr4c: FamilyBound, tmp_path: Path) -> None:
    assert sr4c.certificate is not None
    wrong = 0
    for i, event in enumerate(sr4c.certificate["events"]):
        if not isinstance(event[-1], list):
            continue
        for r, row in enumerate(event[-1]):
            for factor in (-1.0, 0.0):
                changed = copy.deepcopy(sr4c.certificate)
                changed["events"][i][-1][r][-1] = (factor * float.fromhex(row[-1])).hex()
                assert outcome(tmp_path, changed) == REFUSED
            if row[0] == "p":  # the limit on the other side
                changed = copy.deepcopy(sr4c.certificate)
                changed["events"][i][-1][r][-2] *= -1
                assert outcome(tmp_path, changed) == REFUSED
            if len(event[-1]) > 1:  # the sum is no longer positive
                changed = copy.deepcopy(sr4c.certificate)
                changed["events"][i][-1][r][-1] = (1e3 * float.fromhex(row[-1])).hex()
                wrong += outcome(tmp_path, changed) == REFUSED
    assert wrong > 2


def test_a_bound_too_good_by_a_billionth_is_refused(tmp_path: Path) -> None:
    bound = family_bound(load("sr4c"), gap=5e-10, record=True)
    assert bound.status == "proved"
    assert outcome(tmp_path, bound.certificate) == CERTIFIED
    assert bound.certificate is not None
    for factor in (1.0 + 1e-9, 1.01, 2.0, 1e3):
        assert (
            outcome(tmp_path, {**bound.certificate, "seconds": (bound.seconds * factor).hex()})
            == REFUSED
        )


@pytest.fixture(scope="module")
def chained() -> FamilyBound:
    """A quintic that takes cells, rows and sums to prove."""
    problem = as_quintic(random_problem(np.random.default_rng(2), 4, 2, "VAJ", least=-1.0))
    return family_bound(problem, gap=1e-6, optimum=anyhow(problem), record=True)


def _letters(certificate: Any, letter: str) -> list[int]:
    return [i for i, event in enumerate(certificate["events"]) if event[0] == letter]


CHAIN_FAULTS: dict[str, Callable[[Any], None]] = {
    "no events": lambda c: c.update(events=[]),
    "no cut": lambda c: c.update(events=[e for e in c["events"] if e[0] != "C"]),
    "no rows": lambda c: c.update(events=[e for e in c["events"] if e[0] != "R"]),
    "no sums": lambda c: c.update(events=[e for e in c["events"] if e[0] != "L"]),
    "no last event": lambda c: c["events"].pop(),
    "sums without the total": lambda c: (
        [c["events"][i].__setitem__(1, c["events"][i][1][1:]) for i in _letters(c, "L")] and None
    ),
    "sums of the total alone": lambda c: (
        [c["events"][i].__setitem__(1, c["events"][i][1][:1]) for i in _letters(c, "L")] and None
    ),
    "a multiplier that is not positive": lambda c: c["events"][_letters(c, "L")[-1]][1][-1].__setitem__(
        -1, (-1.0).hex()
    ),
    "a higher jerk limit": lambda c: [scaled(c, "jerk", j, 1.02) for j in range(2)] and None,
    "another waypoint": lambda c: c["waypoints"][2].__setitem__(0, (0.01).hex()),
    "a bound too good": lambda c: c.update(seconds=(float.fromhex(c["seconds"]) * (1.0 + 2e-6)).hex()),
    "a bound twice too good": lambda c: c.update(seconds=(float.fromhex(c["seconds"]) * 2.0).hex()),
}


@pytest.mark.parametrize("fault", CHAIN_FAULTS)
def test_the_checker_refuses_of_a_chain(fault: str, chained: FamilyBound, tmp_path: Path) -> None:
    assert chained.status == "proved"
    assert {event[0] for event in chained.certificate["events"]} == {"C", "R", "L"}  # type: ignore[index]
    assert outcome(tmp_path, chained.certificate) == CERTIFIED
    assert outcome(tmp_path, planted(CHAIN_FAULTS[fault])(chained.certificate)) == REFUSED


HOSTILE: dict[str, Callable[[Any], Any]] = {
    "truncated": lambda c: json.dumps(c)[: len(json.dumps(c)) // 2],
    "empty": lambda c: "",
    "not JSON": lambda c: "certified",
    "a list": lambda c: "[]",
    "null": lambda c: "null",
    "nested without end": lambda c: "[" * 200_000,
    "a closed nest": lambda c: "[" * 100_000 + "]" * 100_000,
    "NaN": lambda c: json.dumps(c).replace('"seconds": "', '"seconds": NaN, "other": "'),
    "hexadecimal NaN": lambda c: {**c, "seconds": "nan"},
    "infinity": lambda c: {**c, "seconds": "inf"},
    "too large a number": lambda c: {**c, "seconds": "0x1p+99999"},
    "a number, not text": lambda c: {**c, "seconds": 1.0},
    "many digits": lambda c: json.dumps(c)[:-1] + ', "x": ' + "9" * 10_000 + "}",
    "no events": lambda c: {k: v for k, v in c.items() if k != "events"},
    "events of another type": lambda c: {**c, "events": {"0": ["E"]}},
    "an unknown event": lambda c: {**c, "events": [["X"]]},
    "an event without a name": lambda c: {**c, "events": [[]]},
    "an event of lists": lambda c: {**c, "events": [[["L"]]]},
    "a variable that is true": lambda c: {**c, "events": [["S", True, "0x1p+0"]]},
    "a variable too far": lambda c: {**c, "events": [["S", 7, "0x1p+0"]]},
    "an unknown row": lambda c: {**c, "events": [["L", [["q", "0x1p+0"]]]]},
    "a row of another length": lambda c: {**c, "events": [["L", [["p", 0, 1, "0x1p+0"]]]]},
    "unequal waypoints": lambda c: {**c, "waypoints": [["0x0p+0"], []]},
    "too many waypoints": lambda c: {**c, "waypoints": c["waypoints"] * 100},
    "no limits": lambda c: {**c, "limits": None},
    "another format": lambda c: {**c, "format": "timebound certificate 2"},
    "another family": lambda c: {**c, "family": ["3-5-3"]},
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_hostile_file_is_one_line(
    kind: str, sr4c: FamilyBound, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert outcome(tmp_path, HOSTILE[kind](sr4c.certificate)) == BAD_INPUT
    said = capsys.readouterr()
    assert said.err.startswith("error: ")
    assert said.err.count("\n") == 1
    assert not said.out


def test_sizes_are_limited(sr4c: FamilyBound, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(claim, "MOST_EVENTS", 3)
    assert outcome(tmp_path, sr4c.certificate) == BAD_INPUT
    monkeypatch.setattr(check_certificate, "LARGEST_FILE", 100)
    assert outcome(tmp_path, sr4c.certificate) == BAD_INPUT
    assert check_certificate.main([str(tmp_path / "missing.json")]) == BAD_INPUT
