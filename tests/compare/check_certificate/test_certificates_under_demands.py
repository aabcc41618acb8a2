"""Certificates under demands: what is true is certified, what is false never is."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from demanded_motions import ENDS, Scenario
from handmade_certificates import certificate, contradiction, rows_everywhere, solved
from meeting_zones import drawn
from relaxation_oracle import Oracle

from compare.check_certificate.answers import BadInput, Refused
from compare.check_certificate.verify import verify

MARGIN = 1.0 - 1e-7


def proved(ends: str, seed: int) -> tuple[Scenario, dict[str, Any]] | None:
    """A motion and the certificate of the best bound that some rows prove; None where that is 0."""
    rng = np.random.default_rng(seed)
    made = drawn(rng, ends, n=3, times="some" if seed % 2 else "none")
    horizon = made.arrivals[-1] * 1.01
    oracle = Oracle(made.demands, horizon)
    least, rows = solved(oracle, rows_everywhere(oracle, rng))
    seconds = (least + sum(oracle.waits.values())) * MARGIN
    if not seconds > 0.0:
        return None
    return made, certificate(made.demands, seconds, horizon, [["F", rows]])


def refused(data: dict[str, Any]) -> bool:
    """Whether a certificate proves nothing."""
    try:
        verify(data)
    except (Refused, BadInput):
        return True
    return False


@pytest.mark.parametrize("ends", ENDS)
def test_a_bound_is_certified_and_no_motion_is_faster(ends: str) -> None:
    gains = []
    for seed in range(12):
        found = proved(ends, seed)
        if found is None:
            continue
        made, data = found
        assert verify(data).startswith("no motion of 'random' with ")
        seconds = float.fromhex(data["seconds"])
        assert seconds <= made.arrivals[-1]
        bare = {**data, "events": [["F", []]]}
        gains.append(refused(bare))
        assert refused({**data, "seconds": (seconds * (1.0 + 3e-7)).hex()})
    assert sum(gains) > 4  # the rows prove more than the boxes


@pytest.mark.long  # searches and proofs
@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("letter", ["R", "P"])
def test_narrower_boxes_prove_more(ends: str, letter: str) -> None:
    """Each box is narrowed from both sides; then the program is solved again."""
    more = 0
    for seed in range(5):
        rng = np.random.default_rng(seed)
        made = drawn(rng, ends, n=3, times="none")
        horizon = made.arrivals[-1] * 1.01
        oracle = Oracle(made.demands, horizon)
        rows = rows_everywhere(oracle, rng)
        first, _ = solved(oracle, rows)
        events: list[Any] = []
        narrowed = dict(oracle.box)
        for key in [key for key in oracle.box if key[0] in "Tvae" and np.ptp(oracle.box[key]) > 0.0]:
            name = [
                "x" if key[0] == "e" else key[0],
                *(list(x) if isinstance(x, tuple) else x for x in key[1:]),
            ]
            ends_of_box = list(narrowed[key])
            for side in (0, 1):
                sign = 1.0 - 2.0 * side
                least, used = solved(oracle, rows, {key: sign})
                events.append(["N", *name, side, used])
                ends_of_box[side] = sign * (least - 1e-9)
            # both ends are beyond what is proved by a little, but not outside the box before
            narrowed[key] = tuple(sorted(np.clip(ends_of_box, *narrowed[key])))
        oracle.narrow(narrowed)
        second, used = solved(oracle, rows_everywhere(oracle, rng))
        seconds = (second + sum(oracle.waits.values())) * MARGIN
        assert seconds <= made.arrivals[-1]
        verify(certificate(made.demands, seconds, horizon, [*events, [letter], ["F", used]]))
        more += second > first * (1.0 + 1e-6)
    assert more > 0


# --- what is false is refused ---------------------------------------------------------------------


def sides_swapped(limits: dict[int, Any]) -> None:
    for p in limits:
        limits[p] = -limits[p][:, ::-1]


def zones_shut(oracle: Oracle) -> None:
    for key in oracle.box:
        if key[0] in "ep":
            oracle.box[key] = (0.0, 0.0)


def ends_at_rest(oracle: Oracle) -> None:
    for key in oracle.box:
        if key[0] in "va" and key[1] in (0, oracle.n):
            oracle.box[key] = (0.0, 0.0)
        if key[0] in "WgX" and (oracle.after if key[3] else oracle.start)[key[1]] in (0, oracle.n):
            oracle.box[key] = (0.0, 0.0)


def least_jerk(oracle: Oracle) -> None:
    least = np.min(oracle.demands["jerk"], axis=0)
    oracle.J = dict.fromkeys(oracle.J, least)


def no_waits_before(oracle: Oracle) -> None:
    oracle.waits = dict.fromkeys(oracle.waits, 0.0)


def half_the_limits(oracle: Oracle) -> None:
    for limits in (oracle.V, oracle.A):
        for p in limits:
            limits[p] = limits[p] * 0.5


WRONG: dict[str, tuple[str, Callable[[Oracle], None]]] = {
    "accelerations of the other direction": ("given", lambda oracle: sides_swapped(oracle.A)),
    "velocities of the other direction": ("given", lambda oracle: sides_swapped(oracle.V)),
    "no zones": ("rest", zones_shut),
    "a free start at rest": ("free", ends_at_rest),
    "a cycle at rest": ("cyclic", ends_at_rest),
    "the least jerk": ("given", least_jerk),
    "arrivals without the waits before": ("rest", no_waits_before),
    "half the limits": ("steady", half_the_limits),
}


@pytest.mark.parametrize("fault", [*WRONG, "free", "short", "none"])
def test_a_false_proof_is_refused(fault: str) -> None:
    """Free, short: peaks beside a free end, or on a short segment, where an acceleration need not fade.

    Rows that are wrong contradict one another although there is a motion: a proof that there is none.
    """
    ends, spoil = WRONG.get(fault, ("free", lambda _: None))
    false = 0
    for seed in range(35):
        rng = np.random.default_rng(seed)
        made = drawn(rng, ends, n=3, times="all")
        horizon = made.arrivals[-1] * 1.001
        oracle = Oracle(made.demands, horizon, wrong_peaks=fault if fault in ("free", "short") else "")
        spoil(oracle)
        excess, rows = contradiction(oracle, rows_everywhere(oracle, rng, 10))
        if excess > 1e-5:
            false += 1
            assert refused(certificate(made.demands, horizon, horizon, [["E", rows]]))
    assert (false == 0) == (fault == "none")


def numbers(part: Any) -> list[tuple[Any, Any]]:
    """Where the numbers of some lists stand."""
    found = []
    pairs = part.items() if isinstance(part, dict) else enumerate(part)
    for at, value in pairs:
        if isinstance(value, list | dict):
            found += numbers(value)
        elif not isinstance(value, str) or value.startswith(("0x", "-0x")):
            found.append((part, at))
    return found


@pytest.mark.parametrize("ends", ENDS)
def test_no_change_of_the_events_proves_what_is_false(ends: str) -> None:
    several = [x for x in (proved(ends, seed) for seed in range(8)) if x is not None]
    made, data = max(several, key=lambda x: len(x[1]["events"][0][1]))
    rng = np.random.default_rng(1)
    data["seconds"] = (made.arrivals[-1] * (1.0 + 1e-9)).hex()
    for _ in range(100):
        tampered = copy.deepcopy(data)
        places = numbers(tampered["events"])
        for _ in range(int(rng.integers(1, 4))):
            part, at = places[rng.integers(len(places))]
            if isinstance(part[at], str):
                value = float.fromhex(part[at])
                part[at] = float(
                    value * rng.choice([0.5, 0.9, 1.1, 2.0, 100.0, -1.0]) + rng.choice([0, 0, 0.1])
                ).hex()
            else:
                part[at] = int(rng.integers(-1, 5))
        assert refused(tampered)


LOOSER: dict[str, Callable[[dict[str, Any]], Any]] = {
    "velocity": lambda d: d["velocity"] * 1.02,
    "acceleration": lambda d: d["acceleration"] * 1.02,
    "jerk": lambda d: d["jerk"] * 1.02,
    "waypoints": lambda d: d["waypoints"] + np.array([-0.02, 0.02]),
    "passages": lambda d: d["passages"] * np.array([0.98, 1.0]),
    "durations": lambda d: d["durations"] * np.array([0.98, 1.0]),
    "waits": lambda d: d["waits"] * 0.98,
    "position": lambda d: d["position"] + np.array([-0.02, 0.02]),
    "end_velocity": lambda d: d["end_velocity"] + np.array([-0.02, 0.02]),
    "end_acceleration": lambda d: d["end_acceleration"] + np.array([-0.02, 0.02]),
}


@pytest.mark.long  # searches and proofs
@pytest.mark.parametrize("demand", LOOSER)
def test_a_proof_under_looser_demands_is_refused_where_they_count(demand: str) -> None:
    """The proof is that of the demands: with looser ones it proves less."""
    count = 0
    for ends in ENDS:
        for seed in range(8):
            found = proved(ends, seed)
            if found is None:
                continue
            made, data = found
            looser = {**made.demands, demand: LOOSER[demand](made.demands)}
            horizon, seconds = (float.fromhex(data[key]) for key in ("horizon", "seconds"))
            count += refused(certificate(looser, seconds, horizon, data["events"]))
    assert count > 0
