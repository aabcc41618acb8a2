"""Boxes that are split: where a motion may pass a waypoint at two far apart times, no other proof is tight."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from compare.check_certificate.answers import BadInput, Refused
from compare.check_certificate.verify import verify
from compare.studies.conditioned_problems import drawn_problem
from formulations import Conditions, FreeFormBound, Limits, Problem, free_form, free_form_bound
from formulations.proofs.every_motion import parts

OVERSHOOT = Problem.of([[0.0], [-0.1], [0.2], [2.0]], Limits.of(velocity=10.0, acceleration=1.0, dof=1))
BACKWARDS = Conditions(start_velocity=np.array([-1.0]))
# 1 s to stop at -0.5 rad, past -0.1 rad, and from there 2.5 rad from rest to rest, past -0.1 rad once more
CLOSED_FORM = 1.0 + 2.0 * np.sqrt(2.5)


def overshoot() -> FreeFormBound:
    upper = CLOSED_FORM * (1.0 + 1e-7)
    return free_form_bound(OVERSHOOT, conditions=BACKWARDS, upper=upper, gap=1e-6, record=True)


@pytest.fixture(scope="module")
def proved() -> dict[str, Any]:
    """The certificate, as a file holds it."""
    certificate: dict[str, Any] = json.loads(json.dumps(overshoot().certificate))
    return certificate


def split(certificate: dict[str, Any]) -> list[Any]:
    """The event that splits the whole box."""
    (event,) = [event for event in certificate["events"] if event[0] == "S"]
    assert isinstance(event, list)
    return event


def test_a_waypoint_that_is_passed_twice_has_the_bound_of_the_closed_form(
    proved: dict[str, Any],
) -> None:
    claimed = float.fromhex(proved["seconds"])
    assert CLOSED_FORM * (1.0 - 1e-6) < claimed <= CLOSED_FORM
    assert "in 2 parts" in verify(proved)


def test_without_parts_the_bound_is_not_tight(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts, "_IN_VAIN", 0)
    certificate = overshoot().certificate
    assert certificate is not None
    assert float.fromhex(certificate["seconds"]) < 0.97 * CLOSED_FORM


@pytest.mark.long
@pytest.mark.parametrize("seed", [85, 88])
def test_random_problems_that_pass_a_waypoint_twice_are_tight(seed: int) -> None:
    problem = drawn_problem("given ends", seed)
    motion = free_form(problem)
    bound = free_form_bound(problem, gap=5e-5, upper=motion.seconds, record=True)
    assert bound.gap is not None
    assert bound.gap < 1e-4
    assert bound.certificate is not None
    assert float.fromhex(bound.certificate["seconds"]) > bound.seconds * (1.0 - 1e-4)
    assert "parts" in verify(bound.certificate)


def test_each_part_is_shown(proved: dict[str, Any]) -> None:
    text = verify(proved, show=True)
    _, segment, at, *_ = split(proved)
    for sign in ("<=", ">="):
        assert f"where T{segment + 1} {sign} {float.fromhex(at):.6g}:" in text


def nested(event: list[Any]) -> None:
    for _ in range(200):
        event[3] = [["S", *event[1:3], event[3], event[4]]]


FAULTS: dict[str, tuple[type[Exception], Callable[[list[Any]], Any]]] = {
    "the lower part is left out": (Refused, lambda e: e.__setitem__(3, [])),
    "the upper part is left out": (Refused, lambda e: e.__setitem__(4, [])),
    "the lower part for both": (Refused, lambda e: e.__setitem__(4, e[3])),
    "the upper part for both": (Refused, lambda e: e.__setitem__(3, e[4])),
    "one part alone": (BadInput, lambda e: e.pop()),
    "a third part": (BadInput, lambda e: e.append(e[4])),
    "no such segment": (BadInput, lambda e: e.__setitem__(1, 3)),
    "a split that is no number": (BadInput, lambda e: e.__setitem__(2, "nan")),
    "a part that is no list": (BadInput, lambda e: e.__setitem__(4, {"0": ["E", []]})),
    "too many splits": (Refused, nested),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_in_a_part_is_refused(fault: str, proved: dict[str, Any]) -> None:
    certificate = copy.deepcopy(proved)
    verify(certificate)
    expected, change = FAULTS[fault]
    change(split(certificate))
    with pytest.raises(expected):
        verify(certificate)


def test_what_one_part_proves_is_not_used_in_the_other(proved: dict[str, Any]) -> None:
    """The events of the lower part narrow boxes; the upper part must begin with those of the whole."""
    certificate = copy.deepcopy(proved)
    event = split(certificate)
    narrowing = [each for each in event[3] if each[0] in ("N", "P")]
    event[3], event[4] = [*narrowing, *event[3][len(narrowing) :]], event[4][-1:]
    with pytest.raises(Refused):
        verify(certificate)
