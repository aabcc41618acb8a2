"""The demands of a certificate: what is read, what is refused, what is said, and whose they are."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

import numpy as np
import pytest
from handmade_certificates import certificate

from compare.check_certificate.answers import BadInput, Refused
from compare.check_certificate.certificate_file import compare_with
from compare.check_certificate.claim import Claim
from compare.check_certificate.demands import KEYS
from compare.check_certificate.families.every_motion.relaxation import Relaxation
from compare.check_certificate.verify import verify
from formulations import Conditions, Limits, Problem
from formulations.problem.demands import Demands


def asked(conditions: Conditions, **limits: Any) -> dict[str, Any]:
    """Demands of one joint from 0 by 0.6 to 1.6 rad."""
    given = {"velocity": 1.0, "acceleration": 2.0, "jerk": 9.0, **limits}
    problem = Problem.of([[0.0], [0.6], [1.6]], Limits.of(**given, dof=1))
    demands = Demands.of(problem, conditions)
    return {key: np.asarray(getattr(demands, key)) for key in KEYS} | {
        "stops": demands.stops.tolist(),
        "cyclic": demands.cyclic,
    }


def data(conditions: Conditions, seconds: float = 1.0, **limits: Any) -> dict[str, Any]:
    demands = asked(conditions, **limits)
    found = certificate(demands, seconds, 9.0, [["F", []]])
    found["waypoints"] = [[x.hex()] for x in (0.0, 0.6, 1.6)]
    return found


def test_zones_waits_and_least_times_count_without_any_row() -> None:
    """Displacement at top speed: the gaps between the zones, the least time and the wait."""
    asked_for = Conditions(
        tolerance={1: np.array([0.2])}, waits={1: 0.5}, segment_times={0: (0.7, 5.0)}
    )
    least = 0.7 + 0.5 + 0.8  # the second gap is 1 - 0.2
    verify(data(asked_for, least * (1.0 - 1e-9)))
    with pytest.raises(Refused, match="not above the bound"):
        verify(data(asked_for, least * (1.0 + 1e-9)))


def test_one_row_proves_a_window() -> None:
    certified = data(Conditions(windows={1: (3.0, inf)}), 3.0 + 1.0 - 1e-9)
    with pytest.raises(Refused):
        verify(certified)
    certified["events"] = [["F", [["b", 1, (1.0).hex()]]]]
    verify(certified)
    certified["events"] = [["F", [["l", 1, (1.0).hex()]]]]
    with pytest.raises(Refused, match="which has none"):
        verify(certified)


def test_where_zones_meet_a_leg_may_take_no_time() -> None:
    zone = data(
        Conditions(
            tolerance={1: np.array([0.7])},
            segment_limits={1: Limits.of(velocity=[[-0.5, 3.0]], acceleration=2.0, jerk=5.0, dof=1)},
        )
    )
    checker = Relaxation(Claim(zone))
    assert checker.kept == [0, 1, 2]
    assert float(checker.boxes["T", 0][0]) == 0.0
    # one leg that is left, or one over both: the loosest limits of both segments
    whole = Relaxation(Claim({**zone, "without": [1]}))
    for of_both, k in ((whole, 0), (checker, checker.span(0, 2))):
        assert [float(x) for x in of_both.V[k][0]] == [1.0, 3.0]
        assert float(of_both.legs[k].jerk[0]) == 9.0
        assert [float(x) for x in of_both.boxes["T", k]] == pytest.approx([1.6 / 3.0, 9.0])


def test_a_proof_may_leave_out_waypoints() -> None:
    found = data(Conditions(waits={1: 0.5}), 2.1 * (1.0 - 1e-9))
    verify(found)  # 1.6 s at top speed, and the wait
    with pytest.raises(Refused, match="not above"):
        verify({**found, "without": [1]})  # now the wait is a part of one duration
    verify({**found, "without": [1], "seconds": (1.6 * (1.0 - 1e-9)).hex()})
    for without in ([2], [-1], "all", [0.5], [1, 1, 1]):
        with pytest.raises(BadInput):
            verify({**found, "without": without})
    with pytest.raises(BadInput, match="only a bound under demands"):
        verify({**found, "demands": None, "without": [1]})


def test_nothing_that_forces_time_proves_nothing() -> None:
    found = data(Conditions(tolerance={2: np.array([1.7])}))
    with pytest.raises(Refused, match="not above the bound"):
        verify(found)


def test_a_cycle_of_one_segment_has_one_velocity() -> None:
    """Both ends of a distance row are one variable: its coefficients are added."""
    problem = Problem.of([[0.0], [0.0]], Limits.of(velocity=1.0, acceleration=2.0, jerk=9.0, dof=1))
    demands = Demands.of(problem, Conditions(cyclic=True, segment_times={0: (2.0, inf)}))
    arrays = {key: np.asarray(getattr(demands, key)) for key in KEYS} | {
        "stops": demands.stops.tolist(), "cyclic": True,
    }  # fmt: skip
    checker = Relaxation(Claim(certificate(arrays, 1.0, 9.0, [])))
    places = [x.hex() for x in (0.1, 0.3, 0.4, 0.5, 0.8, 0.9)]
    row, _ = checker.row(["d", 0, 0, 1, *places, (1.0).hex()])
    assert float(row["v", 0, 0]) == pytest.approx(-0.35 - (1.0 - 0.65))
    row, _ = checker.row(["a", 0, 0, 1, *places[:2], (1.0).hex()])
    assert float(row["v", 0, 0]) == 0.0


SAID: dict[str, tuple[Conditions, dict[str, Any]]] = {
    "zones at 1 waypoint": (Conditions(tolerance={1: np.array([0.1])}), {}),
    "times of arrival at 2 waypoints": (Conditions(windows={1: (0.1, inf), 2: (0.0, 9.0)}), {}),
    "times at 1 segment": (Conditions(segment_times={1: (0.1, inf)}), {}),
    "waits at 1 waypoint": (Conditions(waits={1: 0.1}), {}),
    "stops at 1 waypoint": (Conditions(stops=frozenset({1})), {}),
    "limits of their own at 1 segment": (
        Conditions(segment_limits={1: Limits.of(velocity=0.5, acceleration=2.0, jerk=9.0, dof=1)}),
        {},
    ),
    "limits that differ by direction": (Conditions(), {"velocity": [[-1.0, 0.9]]}),
    "a state of its own at the start": (Conditions(start_velocity=np.array([0.3])), {}),
    "a state of its own at the start and the end": (
        Conditions(start_velocity="free", end_acceleration="free"),
        {},
    ),
}  # fmt: skip


@pytest.mark.parametrize("words", SAID)
def test_the_words_say_what_the_claim_covers(words: str) -> None:
    conditions, limits = SAID[words]
    assert verify(data(conditions, **limits)).startswith(
        f"no motion of 'random' with {words} takes 1 s"
    )


def put(*path: Any, value: Any) -> Callable[[dict[str, Any]], None]:
    """A change of one entry of the demands."""

    def change(demands: dict[str, Any]) -> None:
        part: Any = demands
        for step in path[:-1]:
            part = part[step]
        part[path[-1]] = value

    return change


BAD: dict[str, tuple[type[Exception], Callable[[dict[str, Any]], Any]]] = {
    "a missing key": (BadInput, lambda d: d.pop("waits")),
    "an unknown key": (BadInput, put("speed", value=[])),
    "a row too few": (BadInput, lambda d: d["waypoints"].pop()),
    "a joint too many": (BadInput, lambda d: d["jerk"][0].append(d["jerk"][0][0])),
    "a stop that is a number": (BadInput, put("stops", 1, value=1)),
    "a cycle that is text": (BadInput, put("cyclic", value="no")),
    "not a number": (BadInput, put("waits", 1, value="nan")),
    "infinity": (BadInput, put("durations", 0, 1, value="inf")),
    "no lower end of a zone": (Refused, put("waypoints", 1, 0, 0, value=None)),
    "an empty interval": (Refused, put("durations", 0, value=[(2.0).hex(), (1.0).hex()])),
    "a waypoint outside its zone": (Refused, put("waypoints", 1, 0, value=[(0.7).hex(), (0.8).hex()])),
    "a velocity limit above 0": (Refused, put("velocity", 0, 0, value=[(0.1).hex(), (0.8).hex()])),
    "a jerk limit of 0": (Refused, put("jerk", 0, 0, value=(0.0).hex())),
    "jerk limited on one segment": (Refused, put("jerk", 0, 0, value=None)),
    "a wait at the end": (Refused, put("waits", 2, value=(1.0).hex())),
    "a negative wait": (Refused, put("waits", 1, value=(-1.0).hex())),
    "a negative time": (Refused, put("passages", 1, value=[(-1.0).hex(), None])),
    "a cycle that is open": (Refused, put("cyclic", value=True)),
}


@pytest.mark.parametrize("fault", BAD)
def test_demands_that_are_none_are_refused(fault: str) -> None:
    error, change = BAD[fault]
    found = data(Conditions(windows={1: (0.1, inf)}))
    verify(found)
    change(found["demands"])
    with pytest.raises(error):
        verify(found)


def test_demands_are_no_text_and_belong_to_no_family() -> None:
    found = data(Conditions())
    with pytest.raises(BadInput, match="no object"):
        verify({**found, "demands": "none"})
    with pytest.raises(BadInput, match="keeps none"):
        verify({**found, "family": "3-5-3"})


def test_a_claim_is_compared_with_the_conditions_of_a_problem(monkeypatch: pytest.MonkeyPatch) -> None:
    limits = Limits.of(velocity=1.0, acceleration=2.0, jerk=9.0, dof=1)
    windows = {1: (3.0, 5.0)}

    def asks(**conditions: Any) -> None:
        problem = Problem.of([[0.0], [0.6], [1.6]], limits, conditions=Conditions(**conditions))
        monkeypatch.setattr("formulations.load", lambda _: problem)

    found = data(Conditions(windows=windows))
    found["position_slack"] = (1e-3).hex()
    asks(windows=windows)
    compare_with(found, "two.toml")
    for other in (Conditions(windows={1: (3.1, 5.0)}), Conditions()):
        with pytest.raises(Refused, match="passages"):
            compare_with({**found, "demands": data(other)["demands"]}, "two.toml")
    with pytest.raises(Refused, match="no conditions"):
        compare_with({**found, "demands": None}, "two.toml")
    asks(windows=windows, total=9.0)  # the fastest motion is bounded without it
    compare_with(found, "two.toml")
    asks()
    with pytest.raises(Refused, match="passages"):
        compare_with(found, "two.toml")
