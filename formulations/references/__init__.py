"""Reference timings, one file each, one signature: Problem -> Outcome. Add yours to REFERENCES."""

from __future__ import annotations

from collections.abc import Callable

from formulations.problem.problem import Problem
from formulations.references.copp_ import copp_on
from formulations.references.displacement import displacement
from formulations.references.reference import Outcome
from formulations.references.ruckig_ import ruckig_end_to_end, ruckig_stop_and_go
from formulations.references.toppra_ import toppra_cubic, toppra_on

REFERENCES: dict[str, Callable[[Problem], Outcome]] = {
    "displacement": displacement,
    "ruckig_end_to_end": ruckig_end_to_end,
    "ruckig_stop_and_go": ruckig_stop_and_go,
    "toppra_cubic": toppra_cubic,
}

__all__ = ["REFERENCES", "Outcome", "copp_on", "toppra_on"]
