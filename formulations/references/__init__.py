"""Reference timings, one file each; the entry of each stands in its file and is listed in ``rungs.RUNGS``.

displacement   displacement at top speed, the simplest lower bound
ruckig_        Ruckig: end to end (a lower bound), and with a stop at each waypoint (an upper bound)
toppra_        TOPP-RA on a fixed path, without jerk limits
toppra_library loads it without matplotlib
copp_          COPP on a fixed path, with jerk limits
reference      what a rung is and what its function returns
"""

from __future__ import annotations

from formulations.references.copp_ import copp_on
from formulations.references.reference import Outcome, OutcomeStatus, Rung, RungKind, Takes
from formulations.references.toppra_ import toppra_on

__all__ = ["Outcome", "OutcomeStatus", "Rung", "RungKind", "Takes", "copp_on", "toppra_on"]
