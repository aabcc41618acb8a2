"""What the prover narrows a box to is what its multipliers prove in the checker, converged or not.

A program whose time is over has few rows, so its optimum may lie at an end of the interval of a product. If the
checker's interval were narrower it would prove more, and the next multipliers would be for other rows.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from test_conditioned_certificates import asked

from compare.check_certificate.claim import Claim
from compare.check_certificate.families.every_motion.relaxation import Relaxation
from formulations.deadlines import Deadline
from formulations.problem.demands import Demands
from formulations.proofs.certificate import certificate_of
from formulations.proofs.every_motion import events
from formulations.proofs.every_motion.horizons import HorizonSearch
from formulations.proofs.every_motion.zones import ZoneSearch

SHARE = 0.8  # of the rows of a search


@pytest.mark.long  # searches and proofs
@pytest.mark.parametrize("kind", ["limits by direction", "limits of a segment", "zones", "free ends"])
def test_the_checker_narrows_boxes_as_the_prover_does(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in {"_ROUNDS": 1, "FEW": 1, "MANY": 1, "_STEPS": 4}.items():
        monkeypatch.setattr(events, name, value)
    narrowed: list[float] = []
    note = events._Events.narrowed

    def spy(self: Any, program: Any, column: int, side: int, found: Any) -> None:
        _, unit = events._narrowed(program.frame, column)
        narrowed.append(found.bound * unit)
        note(self, program, column, side, found)

    monkeypatch.setattr(events._Events, "narrowed", spy)
    for seed in range(4):
        narrowed.clear()
        proved = narrowings(certificate(kind, seed))
        several = len(proved) >= 4
        assert several
        assert proved == pytest.approx(narrowed[: len(proved)], rel=1e-8)


def certificate(kind: str, seed: int) -> dict[str, Any]:
    """A certificate from a part of the rows of a search, which narrows boxes for a better bound."""
    rng = np.random.default_rng(seed)
    demands = Demands.of(*asked(kind, rng))
    search = (ZoneSearch if kind == "zones" else HorizonSearch)(demands, None, None)
    search.run(2e-2, Deadline(10.0))
    search.cuts = search.cuts[rng.random(len(search.cuts)) < SHARE]
    search.bounds["relaxation"] *= 1.02
    seconds, horizon, found = search.certify(Deadline(10.0))
    data = certificate_of(demands.problem, seconds, found, horizon=horizon, demands=demands)
    return json.loads(json.dumps(data | {"without": sorted(search.without)}))


def narrowings(data: dict[str, Any]) -> list[float]:
    """The bounds that the checker finds for the events that narrow a box."""
    checker, found = Relaxation(Claim(data)), []
    least = checker.least

    def spy(cost: Any, rows: Any, time: int = 0) -> Any:
        bound = least(cost, rows, time)
        if cost:
            found.append(float(bound))
        return bound

    checker.least = spy  # type: ignore[method-assign]
    checker.replay()
    return found
