"""Certificates of B-splines: honest ones are certified, spoilt ones are refused."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from b_spline_proofs import CASES, answer, certificate, problem

from compare.check_certificate.answers import Refused
from compare.check_certificate.verify import verify
from formulations import Limits, Problem, family_bound

pytestmark = pytest.mark.long  # the search that writes them is compiled first

Spoil = Callable[[dict[str, Any]], None]


def moved(text: str, by: float) -> str:
    return (float.fromhex(text) + by).hex()


def scaled(text: str, by: float) -> str:
    return (float.fromhex(text) * by).hex()


def change_rows(place: int, new: Callable[[Any], Any]) -> Spoil:
    """Change an entry of every row."""

    def spoil(data: dict[str, Any]) -> None:
        for event in data["events"]:
            if event[0] in "LAB" and isinstance(event[-1], list):
                for row in event[-1]:
                    row[place] = new(row[place])

    return spoil


def change_waypoints(data: dict[str, Any]) -> None:
    """Every displacement becomes a tenth shorter."""
    data["waypoints"] = [[scaled(x, 0.9) for x in row] for row in data["waypoints"]]


def change_limit(data: dict[str, Any]) -> None:
    for key in ("velocity", "acceleration"):
        data["limits"][key] = [x and scaled(x, 1.1) for x in data["limits"][key]]


def move_slabs(data: dict[str, Any]) -> None:
    """Every slab takes nearly the whole box."""
    for event, turn in zip(data["events"][1:], data["events"], strict=False):
        if event[0] in "AB" and turn[0] == "T":
            k = event[1] - 1
            lo, hi = (float.fromhex(ends[k]) for ends in turn[1:])
            share = 0.95 if event[0] == "A" else 0.05
            event[2] = (lo + share * (hi - lo)).hex()


def higher(by: float) -> Spoil:
    def spoil(data: dict[str, Any]) -> None:
        data["seconds"] = scaled(data["seconds"], by)

    return spoil


def turn_without_rows(data: dict[str, Any]) -> None:
    first = next(e for e in data["events"] if isinstance(e[-1], list) and e[0] in "LAB")
    first.pop()


FAULTS: dict[str, Spoil] = {
    "bound 1 % too high": higher(1.01),
    "bound far too high": higher(1.5),
    "no events": lambda data: data.update(events=[]),
    "signs": change_rows(5, lambda x: -x),
    "joints": change_rows(1, lambda x: 1 - x),
    "spans": change_rows(2, lambda x: 0),
    "places": change_rows(4, lambda x: (1.0 - 0.5 * float.fromhex(x)).hex()),
    "orders": change_rows(3, lambda x: 3 - x),
    "negative multipliers": change_rows(6, lambda x: scaled(x, -1.0)),
    "slabs": move_slabs,
    "waypoints": change_waypoints,
    "limits": change_limit,
    "first rows left out": turn_without_rows,
}


@pytest.mark.parametrize("name", CASES)
def test_honest_certificates_are_certified(name: str) -> None:
    data = certificate(name)
    words = verify(data)
    assert f"no b-spline-{CASES[name][0]} motion" in words
    kinds = {e[0] for e in data["events"]}
    assert {"T", "L", "S"} <= kinds
    orders = {row[3] for e in data["events"] if e[0] == "L" and len(e) == 2 for row in e[1]}
    assert orders <= {0, 1, 2, 3}
    assert ("P" in CASES[name][3]) <= (0 in orders)


@pytest.mark.parametrize("degree", [3, 5])
def test_one_segment_has_no_variables(degree: int) -> None:
    one = Problem.of(np.array([[0.0], [1.0]]), Limits.of(1.0, 2.0, dof=1), family=f"b-spline-{degree}")
    data = family_bound(one, gap=0.01, record=True).certificate
    assert data is not None
    assert [event[0] for event in data["events"]] == ["T", "L"]
    assert answer(data) == "certified"
    higher(1.02)(data)
    assert answer(data) == "refused"


def test_the_cases_show_every_order_and_every_event() -> None:
    events = [e for name in CASES for e in certificate(name)["events"]]
    rows = [row for e in events if e[0] in "LAB" and isinstance(e[-1], list) for row in e[-1]]
    assert {e[0] for e in events} == set("TLSABE")
    assert {row[3] for row in rows} == {0, 1, 2, 3}
    assert any(row[2] >= CASES["cubic"][1] for row in rows)  # more spans than segments


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("name", ["both", "cubic-jerk"])
def test_spoilt_certificates_are_refused(name: str, fault: str) -> None:
    data = certificate(name)
    FAULTS[fault](data)
    assert answer(data) != "certified"


@pytest.mark.parametrize("name", ["walls", "cubic-walls"])
def test_a_multiplier_of_a_sum_counts(name: str) -> None:
    data, changed = certificate(name), 0
    for event in data["events"]:
        if event[0] in "LAB" and isinstance(event[-1], list) and len(event[-1]) > 1:
            event[-1][0][6] = scaled(event[-1][0][6], 1e3)
            changed += 1
    assert changed
    assert answer(data) == "refused"


@pytest.mark.parametrize("letter", "LS")
def test_no_leaf_and_no_split_can_be_left_out(letter: str) -> None:
    whole = certificate("both")
    for i, event in enumerate(whole["events"]):
        if event[0] == letter:
            data = {**whole, "events": whole["events"][:i] + whole["events"][i + 1 :]}
            assert answer(data) != "certified", i


def test_turns_must_not_state_less_than_is_left() -> None:
    whole, tried = certificate("cubic-jerk"), 0
    events = whole["events"]
    for i in range(1, len(events)):
        if events[i - 1][0] == "S" and events[i][0] == "T" and events[i + 1][0] != "E":
            k, value = events[i - 1][1], events[i - 1][2]
            if events[i][1][k - 1] != value:
                continue  # travel cut it at once
            turn = [*events[i]]
            turn[1] = [*turn[1]]
            turn[1][k - 1] = moved(value, 1e-6)
            tried += 1
            assert answer({**whole, "events": [*events[:i], turn, *events[i + 1 :]]}) == "refused", i
        if tried == 20:
            break
    assert tried > 5


def test_an_empty_box_must_be_empty() -> None:
    whole = certificate("both")
    events = whole["events"]
    for i, event in enumerate(events):
        if event[0] == "L" and events[i - 1][0] == "T":
            assert answer({**whole, "events": [*events[:i], ["E"], *events[i + 1 :]]}) == "refused"


def test_a_box_that_is_widened_proves_as_much_if_all_is_discarded() -> None:
    """The prover stops short of roots: what it states is checked, not what it might have stated."""
    data = certificate("both")
    first = data["events"][0]
    first[1] = [moved(x, -1e-9) for x in first[1]]
    first[2] = [moved(x, 1e-9) for x in first[2]]
    assert answer(data) in ("certified", "refused")
    first[1] = [moved(x, 0.01) for x in first[1]]
    assert answer(data) == "refused"


def test_bounds_above_a_feasible_motion_are_never_certified() -> None:
    """Whatever the events: boxes and times are scaled to a bound that a motion refutes."""
    for name in ("both", "cubic", "speed", "cubic-walls"):
        data = certificate(name)
        by = 1.0 + 1.2 * CASES[name][4]
        data["seconds"] = scaled(data["seconds"], by)
        for event in data["events"]:
            if event[0] == "T":
                event[1:] = [[scaled(x, by) for x in ends] for ends in event[1:]]
            elif event[0] in "SAB":
                event[2] = scaled(event[2], by)
        assert answer(data) == "refused"


def test_without_events_displacement_over_speed_is_the_proof() -> None:
    data = certificate("speed")
    data["events"] = []
    assert answer(data) == "refused"
    d = np.abs(np.diff(problem("speed").waypoints, axis=0)).sum()
    data["seconds"] = float(d / problem("speed").limits.velocity[0] * (1.0 - 1e-12)).hex()
    assert answer(data) == "certified"


BAD: dict[str, Any] = {
    "unknown": [["X"]],
    "no event": [[]],
    "waypoint 0": [["S", 0, "0x1p0"]],
    "last waypoint": [["S", 3, "0x1p0"]],
    "short turn": [["T", ["0x1p0"], ["0x1p0"]]],
    "turn without box": [["T"]],
    "no float": [["T", ["x", "y"], ["0x1p0", "0x1p0"]]],
    "infinite": [["T", ["inf", "inf"], ["0x1p0", "0x1p0"]]],
    "no list": [["L", 3]],
    "row": [["L", [["t", "0x1p0"]]]],
    "span": [["L", [["p", 0, 3, 1, "0x1p-1", 1, "0x1p0"]]]],
    "joint": [["L", [["p", 2, 0, 1, "0x1p-1", 1, "0x1p0"]]]],
    "order": [["L", [["p", 0, 0, 4, "0x1p-1", 1, "0x1p0"]]]],
    "place": [["L", [["p", 0, 0, 1, "0x1p1", 1, "0x1p0"]]]],
    "before a turn": [["L", [["p", 0, 0, 1, "0x1p-1", 1, "0x1p0"]]]],
    "nothing": [["L"]],
    "nothing is left": [["E"]],
    "number": 3,
    "not a list": [3],
}


@pytest.mark.parametrize("what", BAD)
def test_events_that_make_no_sense_are_refused(what: str) -> None:
    data = certificate("both")
    data["events"] = BAD[what]
    assert answer(data) in ("bad", "refused")


def test_huge_and_tiny_numbers_prove_nothing() -> None:
    for key in ("velocity", "acceleration"):
        for value in (5e-324, 1e-300, 1e300, 1.7e308):
            data = certificate("both")
            data["limits"][key] = [value.hex()] * 2
            if value < 1.0:
                data["seconds"] = (1e306).hex()
            assert answer(data) == "refused" or value < 1.0
    data = certificate("both")
    change_rows(6, lambda x: (1e308).hex())(data)
    assert answer(data) == "refused"
    change_rows(6, lambda x: (5e-324).hex())(data)
    assert answer(data) == "refused"


def test_many_segments_are_refused_at_once() -> None:
    data = certificate("speed")
    data["waypoints"] = [[float(k).hex()] for k in range(50)]
    data["seconds"] = (1000.0).hex()
    with pytest.raises(Refused, match="more than 24 segments"):
        verify(data)
