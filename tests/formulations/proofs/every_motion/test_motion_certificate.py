"""The certificate of a bound on every motion: checked anew, row by row, and refused where it is wrong."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from every_motion_helpers import (
    LIMITS,
    exact,
    jerk_limited,
    limited_by,
    problem_of,
    splined,
    stopping,
    through_states,
)

from compare.check_certificate.__main__ import BAD_INPUT, CERTIFIED, REFUSED, main
from compare.check_certificate.answers import Refused
from compare.check_certificate.claim import Claim
from compare.check_certificate.families.every_motion.relaxation import Relaxation
from compare.studies.free_form_study import random_problems
from formulations import (
    CASES,
    FreeFormBound,
    Problem,
    Trajectory,
    check,
    free_form,
    free_form_bound,
    load,
)
from formulations.proofs.certificate import certificate_of, write_certificate
from formulations.proofs.every_motion.relaxation.reach import (
    distance_coefficients,
    speed_coefficients,
    stop_coefficients,
)


def recorded(problem: Problem, **options: Any) -> FreeFormBound:
    """The bound beside the fastest motion, with its certificate."""
    return free_form_bound(problem, upper=free_form(problem).seconds, record=True, **options)


def outcome(folder: Path, certificate: Any, *more: str) -> int:
    path = folder / "certificate.json"
    write_certificate(path, certificate)
    return main([str(path), *more])


@pytest.fixture(scope="module")
def ur5() -> dict[str, Any]:
    certificate = recorded(load("ur5")).certificate
    assert certificate is not None
    return certificate


# --- what is true is certified --------------------------------------------------------------------


@pytest.mark.parametrize("case", CASES)
def test_the_bound_of_every_motion_of_a_shipped_case_is_certified(case: str, tmp_path: Path) -> None:
    bound = recorded(load(case))
    assert outcome(tmp_path, bound.certificate, "--problem", case) == CERTIFIED
    assert bound.certificate is not None
    assert float.fromhex(bound.certificate["seconds"]) >= bound.seconds * (1.0 - 1e-8)


@pytest.mark.parametrize(
    "problem", [jerk_limited("sr4c", 5.0), *random_problems(4, 3)], ids=lambda p: p.name
)
def test_bounds_with_a_jerk_limit_are_certified(problem: Problem, tmp_path: Path) -> None:
    bound = recorded(problem)
    assert outcome(tmp_path, bound.certificate) == CERTIFIED
    assert bound.certificate is not None
    assert bound.upper is not None
    assert bound.upper <= float.fromhex(bound.certificate["seconds"]) * (1.0 + 1e-5)


def test_a_proof_is_shown_as_inequalities(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One joint, velocity and acceleration: the time is read off the lines."""
    bound = recorded(problem_of([[0.0], [2.0]], 1.0, 1.0))
    assert outcome(tmp_path, bound.certificate, "--show") == CERTIFIED
    first, *lines = capsys.readouterr().out.splitlines()
    assert first.startswith("certified: no motion of 'problem' takes 2.99999999")
    assert lines
    assert all(re.fullmatch(r"  [\d.e+-]+ x \(.* <= .*\)  \[.*\]", line) for line in lines)
    assert any("(1/T1)" in line and "distance" in line and "joint 1" in line for line in lines)


def test_what_follows_a_proof_is_not_shown(ur5: dict[str, Any], tmp_path: Path) -> None:
    certificate = copy.deepcopy(ur5)
    certificate["events"].append(["?"])
    assert outcome(tmp_path, certificate, "--show") == CERTIFIED


def test_a_bound_that_needs_narrower_boxes_is_certified(tmp_path: Path) -> None:
    """Jerk alone matters: one program proves little."""
    bound = recorded(problem_of([[0.0], [0.7], [0.9], [0.1]], 1e6, 1e6, 1.0), gap=1e-6, time_limit=4.0)
    assert bound.certificate is not None
    assert {"N", "P", "F"} <= {event[0] for event in bound.certificate["events"]}
    assert outcome(tmp_path, bound.certificate) == CERTIFIED
    first = copy.deepcopy(bound.certificate)
    first["events"] = [event for event in first["events"] if event[0] == "F"]
    assert outcome(tmp_path, first) == REFUSED


@pytest.mark.parametrize("seed", range(3))
def test_where_limits_are_missing_nothing_is_lost(seed: int, tmp_path: Path) -> None:
    """A joint with a velocity limit alone is in no row, only in the boxes."""
    rng = np.random.default_rng(seed)
    problem = problem_of(rng.uniform(-2.5, 2.5, (5, 3)), 1.0, [2.0, np.inf, 3.0], [9.0, np.inf, np.inf])
    bound = recorded(problem, gap=1e-6)
    plain = free_form_bound(problem, gap=1e-6, upper=bound.upper)  # without what writing it down gains
    assert plain.gap is not None
    assert plain.gap < 1e-5
    assert outcome(tmp_path, bound.certificate) == CERTIFIED


def test_waypoints_on_their_position_limits_are_certified(tmp_path: Path) -> None:
    """The checker allows a thousandth more of the position slack, and here that counts."""
    position = [(-9e-3, 0.0), (-0.038, 5e-3)]
    problem = problem_of(
        [[0.0, 0.0], [-6e-5, -0.038], [-9e-3, -0.0315]],
        [3e-3, 5e-3],
        [7e-3, 1e-2],
        [2e-2, 2e2],
        position=position,
    )
    assert outcome(tmp_path, recorded(problem).certificate) == CERTIFIED


# --- every row of the checker holds for every motion ----------------------------------------------


def values(checker: Relaxation, motion: Trajectory) -> dict[tuple[Any, ...], float]:
    """A motion in the checker's variables."""
    found: dict[tuple[Any, ...], float] = {}
    times = motion.passage_times
    for k in checker.ks:
        T = float(times[checker.waypoint(k, 1)] - times[k])
        found |= {("T", k): T, ("u", k): 1.0 / T, ("q", k): T * T}
    for i in [*checker.ks, checker.ends[1]]:
        for j in checker.joints:
            rest = i in checker.ends
            found["v", i, j] = 0.0 if rest else float(motion.at(times[i : i + 1], 1)[0, j])
            a = float(motion.at(times[i : i + 1], 2)[0, j])
            found["a", i, j] = 0.0 if rest or checker.J[j] is None else a
    for k in checker.ks:
        for j in checker.joints:
            for end, i in ((0, k), (1, checker.waypoint(k, 1))):
                found["W", k, j, end] = found["T", k] * found["a", i, j]
    return found


def any_row(checker: Relaxation, rng: np.random.Generator) -> list[Any]:
    """A row of any kind, posed anywhere."""
    k, j = int(rng.choice(checker.ks)), int(rng.choice(checker.joints))
    sign, end = int(rng.choice([-1, 1])), int(rng.integers(2))
    jerky = checker.J[j] is not None
    kind = str(rng.choice(list("hstcwvardk" if jerky else "hstcardk")))
    s = np.sort(rng.random(6) ** rng.choice([0.2, 1.0, 5.0]))
    if not jerky:  # no pieces of jerk
        late = s[3] if kind == "d" else s[1]
        s = np.array([0.0, s[1], s[1], late, late, 1.0])
    places = [float(x).hex() for x in s]
    y = (1.0).hex()
    lo, hi = (float(x) for x in checker.boxes["T", k])
    t = float(lo + rng.random() ** 3 * (hi - lo)).hex()
    rows: dict[str, list[Any]] = {
        "h": [], "s": [k], "t": [k, t], "c": [k, t],
        "w": [j, k, end, int(rng.integers(4))],
        "v": [j, k, end, sign, float(rng.normal()).hex()],
        "a": [j, k, sign, *(places[:2] if jerky else [(0.0).hex(), (1.0).hex()])],
        "r": [j, k, end, sign, *places[:2]],
        "d": [j, k, sign, *places], "k": [j, k, sign, *places],
    }  # fmt: skip
    return [kind, *rows[kind], y]


def violations(
    problem: Problem, motion: Trajectory, rng: np.random.Generator, shrink: float = 1.0
) -> int:
    """How many of many rows a motion violates; shrink: of the acceleration limits in the rows."""
    horizon = motion.seconds * float(rng.choice([1.0 + 1e-9, 3.0]))
    claim = Claim(json.loads(json.dumps(certificate_of(problem, 1e-9, [], horizon=horizon))))
    checker = Relaxation(claim)
    x = values(checker, motion)
    for key, value in x.items():
        if key[0] not in "aW" or checker.J[key[2]] is not None:
            lo, hi = (float(end) for end in checker.box(key))
            assert lo - 1e-9 * (1.0 + abs(lo)) <= value <= hi + 1e-9 * (1.0 + abs(hi)), key
    for k, row in checker.A.items():
        checker.A[k] = [tuple(shrink * x for x in pair) for pair in row]
    count = 0
    for _ in range(300):
        raw = any_row(checker, rng)
        if raw[0] in "wv" and checker.J[raw[1]] is None:
            continue
        row, upper = checker.row(raw)
        terms = [float(c) * x[key] for key, c in row.items()]
        size = sum(map(abs, terms)) + abs(float(upper))
        count += sum(terms) - float(upper) > 1e-11 * size
    return count


@pytest.mark.parametrize("kind", LIMITS)
def test_every_row_of_the_checker_holds_for_every_motion(kind: str) -> None:
    rng = np.random.default_rng(5)
    for n in (2, 4):
        steps = rng.normal(size=(n + 1, 3)) * 10.0 ** rng.uniform(-1.0, 0.0, (n + 1, 1))
        problem = problem_of(np.cumsum(steps, axis=0), *LIMITS[kind])
        motions = [stopping(problem), splined(problem, "quintic", rng)]
        if kind in ("jerk", "low jerk"):
            passing = [exact(problem, through_states(problem, rng)) for _ in range(4)]
            motions += [motion for motion in passing if check(problem, motion).feasible]
        for raw in motions:
            motion = exact(problem, raw)
            assert violations(limited_by(motion, problem), motion, rng) == 0


@pytest.mark.parametrize("kind", ["d", "k", "a", "r"])
def test_checker_and_prover_pose_the_same_rows(kind: str) -> None:
    """Written twice, by different formulas: the prover's are tight (test_rows_tight)."""
    problem = problem_of([[0.0], [1.0], [0.3]], 1.3, 2.0, 7.0, position=(-0.5, 2.0))
    checker = Relaxation(Claim(json.loads(json.dumps(certificate_of(problem, 1.0, [], horizon=9.0)))))
    rng = np.random.default_rng(7)
    for _ in range(20):
        s = np.sort(rng.random((1, 6)), axis=1)
        places = [float(x).hex() for x in s[0]]
        if kind in ("d", "k"):
            row, upper = checker.row([kind, 0, 1, 1, *places, (1.0).hex()])
            v0, W0, v1, W1, V, A, J = distance_coefficients(s, kind == "d")
            ours = {("v", 1, 0): -v0, ("W", 1, 0, 0): -W0, ("v", 2, 0): -v1, ("W", 1, 0, 1): -W1}
            assert float(upper) == pytest.approx(V[0] * 1.3, rel=1e-12, abs=1e-15)
            assert float(row["u", 1]) == pytest.approx(-0.7, rel=1e-12)
        elif kind == "a":
            row, upper = checker.row([kind, 0, 1, 1, *places[:2], (1.0).hex()])
            W0, W1, A, J = speed_coefficients(s[:, :2])
            ours = {("v", 1, 0): [-1.0], ("v", 2, 0): [1.0], ("W", 1, 0, 0): -W0, ("W", 1, 0, 1): -W1}
            assert upper == 0
        else:
            row, upper = checker.row([kind, 0, 1, 0, 1, *places[:2], (1.0).hex()])
            v0, W0, A, J = stop_coefficients(s[:, :2])
            ours = {("v", 1, 0): v0, ("W", 1, 0, 0): W0}
            assert float(row["u", 1]) == pytest.approx(-1.0, rel=1e-6)
        ours |= {("T", 1): -2.0 * A, ("q", 1): -7.0 * J}
        for key, value in ours.items():
            assert float(row[key]) == pytest.approx(value[0], rel=1e-12, abs=1e-14), key


def test_a_wrong_row_of_the_checker_is_noticed() -> None:
    rng = np.random.default_rng(6)
    problem = problem_of([[0.0], [1.0], [0.3]], 1.0, 2.0)
    motion = exact(problem, stopping(problem))
    assert violations(limited_by(motion, problem), motion, rng, shrink=0.9) > 0


# --- what is wrong is refused ---------------------------------------------------------------------


def scaled(certificate: dict[str, Any], key: str, factor: float) -> None:
    certificate[key] = (float.fromhex(certificate[key]) * factor).hex()


def looser(certificate: dict[str, Any], name: str) -> None:
    limits = certificate["limits"][name]
    certificate["limits"][name] = [(float.fromhex(x) * 1.01).hex() for x in limits]


def last_rows(certificate: dict[str, Any]) -> list[Any]:
    rows: list[Any] = certificate["events"][-1][-1]
    return rows


def longest_row(certificate: dict[str, Any]) -> list[Any]:
    row: list[Any] = max(last_rows(certificate), key=len)
    return row


def nearer(certificate: dict[str, Any]) -> None:
    end = certificate["waypoints"][-1]
    end[0] = (float.fromhex(end[0]) * 0.99).hex()


FAULTS: dict[str, tuple[int, Callable[[dict[str, Any]], object]]] = {
    "a longer time": (REFUSED, lambda c: scaled(c, "seconds", 1.0 + 1e-8)),
    "more than the horizon": (REFUSED, lambda c: scaled(c, "seconds", 1.1)),
    "a longer horizon": (CERTIFIED, lambda c: scaled(c, "horizon", 1.0 + 1e-12)),
    "velocity": (REFUSED, lambda c: looser(c, "velocity")),
    "jerk": (REFUSED, lambda c: looser(c, "jerk")),
    "another waypoint": (REFUSED, nearer),
    "a row less": (REFUSED, lambda c: last_rows(c).remove(longest_row(c))),
    "the other sign": (REFUSED, lambda c: longest_row(c).__setitem__(3, -longest_row(c)[3])),
    "a negative multiplier": (REFUSED, lambda c: longest_row(c).__setitem__(-1, (-1.0).hex())),
    "a larger multiplier": (REFUSED, lambda c: longest_row(c).__setitem__(-1, (9.0).hex())),
    "places that descend": (REFUSED, lambda c: longest_row(c).__setitem__(4, (2.0).hex())),
    "no events": (REFUSED, lambda c: c["events"].clear()),
    "no sign": (BAD_INPUT, lambda c: longest_row(c).__setitem__(3, 0)),
    "no such joint": (BAD_INPUT, lambda c: longest_row(c).__setitem__(1, 6)),
    "no such row": (BAD_INPUT, lambda c: longest_row(c).__setitem__(0, "z")),
    "a row without a name": (
        BAD_INPUT,
        lambda c: last_rows(c).append(["", 0, (1.0).hex(), (1.0).hex()]),
    ),
    "a short row": (BAD_INPUT, lambda c: longest_row(c).pop(4)),
    "no horizon": (BAD_INPUT, lambda c: c.pop("horizon")),
    "no such event": (BAD_INPUT, lambda c: c["events"][-1].__setitem__(0, "Q")),
    "rows that are none": (BAD_INPUT, lambda c: c["events"][-1].__setitem__(1, "all")),
    "not a number": (BAD_INPUT, lambda c: longest_row(c).__setitem__(-1, "nan")),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_certificate_with_a_fault_is_refused(fault: str, ur5: dict[str, Any], tmp_path: Path) -> None:
    expected, spoil = FAULTS[fault]
    certificate = copy.deepcopy(ur5)
    assert outcome(tmp_path, certificate, "--problem", "ur5") == CERTIFIED
    spoil(certificate)
    assert outcome(tmp_path, certificate) == expected


def test_a_certificate_of_another_problem_is_refused(ur5: dict[str, Any], tmp_path: Path) -> None:
    assert outcome(tmp_path, ur5, "--problem", "ur5-corrected") == REFUSED


def test_a_joint_without_any_limit_bounds_nothing() -> None:
    problem = problem_of([[0.0, 0.0], [1.0, 1.0]], 1.0, 1.0)
    data = json.loads(json.dumps(certificate_of(problem, 1.0, [], horizon=2.0)))
    for limits in data["limits"].values():
        limits[1] = [None, None] if isinstance(limits[1], list) else None
    assert not Relaxation(Claim(data)).void
    for limits in data["limits"].values():
        limits[0] = [None, None] if isinstance(limits[0], list) else None
    with pytest.raises(Refused, match="not above the bound"):
        Relaxation(Claim(data | {"events": [["F", []]]})).replay()
