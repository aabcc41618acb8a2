"""Rows are posed in boxes that are those of the checker, so that multipliers hold there as well.

A program whose time is over has few rows, so its optimum may lie at an end of the interval of a product. If the
checker's interval is narrower, it narrows the next box more. The rows in it are then others than those for
which the next multipliers were found, and the last sum may prove less.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from test_conditioned_certificates import KINDS, asked

from compare.check_certificate.claim import Claim
from compare.check_certificate.families.every_motion.relaxation import Relaxation
from compare.check_certificate.verify import verify
from compare.studies.conditioned_problems import drawn_problem
from formulations.deadlines import Deadline
from formulations.problem.demands import Demands
from formulations.proofs.certificate import certificate_of
from formulations.proofs.every_motion.beginnings import derived_boxes
from formulations.proofs.every_motion.parts import PartedProof
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.propagation import propagate
from formulations.proofs.every_motion.relaxation.relaxed_problem import RelaxedProblem
from formulations.proofs.every_motion.relaxation.rows import Frame
from formulations.proofs.tool.least_times import with_tool_times

HORIZON = 20.0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_all_boxes_are_those_of_the_checker(kind: str, seed: int) -> None:
    problem, conditions = asked(kind, np.random.default_rng(seed))
    demands = Demands.of(problem, conditions)
    relaxed = RelaxedProblem.under(with_tool_times(demands), HORIZON)
    with np.errstate(divide="ignore", invalid="ignore"):
        boxes = propagate(relaxed, derived_boxes(relaxed))
        frame = Frame(relaxed, boxes, np.full(relaxed.n_segments, 0.7))
    data = certificate_of(problem, 1e-3, [["P"], ["F", []]], horizon=HORIZON, demands=demands)
    checker = Relaxation(Claim(json.loads(json.dumps(data))))
    checker.replay()
    compared = set()
    for key, column, unit in named(frame, checker):
        lo, hi = (float(x) for x in checker.box(key))
        size = 1e-9 * (1.0 + abs(lo) + abs(hi))
        assert frame.box[column] * unit == pytest.approx([lo, hi], abs=size), key
        compared.add(key[0])
    assert compared >= set("Tqva" if kind == "waits" else "TqvaW")  # at rest at all waypoints


def named(frame: Frame, checker: Relaxation) -> Any:
    """Variables by the checker's names, with their columns and units."""
    relaxed = frame.relaxed
    for i, waypoint in enumerate(relaxed.waypoints.tolist()):
        for j, joint in enumerate(relaxed.joints.tolist()):
            units = relaxed.velocity[j], relaxed.acceleration[j], relaxed.zones[i, j]
            for letter, unit in zip("vae", units, strict=True):
                if getattr(frame, letter)[i, j] >= 0:
                    yield checker.at(letter, waypoint, joint), getattr(frame, letter)[i, j], unit
    for k, (start, end) in enumerate(relaxed.legs.tolist()):
        ends = relaxed.waypoints[[start, end]].tolist()
        leg = ends[0] if end == start + 1 else checker.span(*ends)
        T = frame.typical[k]
        yield ("T", leg), frame.T[k], T
        yield ("q", leg), frame.square[k], T**2
        if frame.cube[k] >= 0:
            yield ("r", leg), frame.cube[k], T**3
        for j, joint in enumerate(relaxed.joints.tolist()):
            for side, at in enumerate((start, end)):
                V, A, zone = relaxed.velocity[j], relaxed.acceleration[j], relaxed.zones[at, j]
                units = {"W": T * A, "p": zone / T, "g": T * V, "X": T * T * A}
                for letter, unit in units.items():
                    column = getattr(frame, letter)[k, j, side]
                    positive = bool(checker.boxes["T", leg][0] > 0)
                    if column >= 0 and np.ptp(frame.box[column]) > 0.0 and (letter != "p" or positive):
                        yield (letter, leg, joint, side), column, unit


def test_a_leg_over_several_segments_that_has_no_time_is_named() -> None:
    """Only its box is empty, and no row says so."""
    demands = Demands.of(drawn_problem("zones", 24))
    horizon = 0.4295473313667282
    relaxed = RelaxedProblem.under(demands, horizon)
    typical = np.full(len(demands.durations), 0.2)
    with np.errstate(divide="ignore", invalid="ignore"):
        proof = PartedProof(relaxed, horizon, horizon, typical, Deadline(5.0), for_checker=True)
        found = proof.prove(derived_boxes(relaxed), Cuts.none())
    assert proof.bound == horizon
    data = certificate_of(demands.problem, horizon, found, horizon=horizon, demands=demands)
    verify(json.loads(json.dumps(data)))
