"""The search for the bound of motions through zones.

Where a fastest motion passes through a zone on its way, many positions and times there belong to one: boxes
cannot be narrowed to a point, and the relaxation keeps a gap. Without that waypoint the bound is the same, and
the gap is gone. Which zones these are is not known before, so those are left out without which the first
relaxation proves no less; where that was wrong, all waypoints are taken after all.
"""

from __future__ import annotations

import numpy as np

from formulations.deadlines import Deadline
from formulations.proofs.every_motion.beginnings import first_boxes, tangents
from formulations.proofs.every_motion.endings import Ending
from formulations.proofs.every_motion.horizons import ROUNDS, HorizonSearch
from formulations.proofs.every_motion.relaxation.cuts import Cuts
from formulations.proofs.every_motion.relaxation.linear_program import LinearProgram
from formulations.proofs.every_motion.relaxation.rows import Frame

_SHARE = 0.4  # of the time, for a proof without some zones
_FEW = 30  # zones; each costs a linear program
_EQUAL, _COARSE = 1e-6, 1e-5  # of the bound; tolerance of its cuts


class ZoneSearch(HorizonSearch):
    """The search for one problem's bound, first without the zones that seem to cost nothing."""

    def approach(self, gap: float, deadline: Deadline) -> Ending:
        """Try horizon after horizon, without some zones and then with all.

        Parameters
        ----------
        gap : float
            Relative gap to the known motion.
        deadline : Deadline

        Returns
        -------
        Ending
        """
        self._leave_zones_out(gap, deadline)
        if self.without == self.idle:
            return super().approach(gap, deadline)
        ending = super().approach(gap, deadline.within(_SHARE * deadline.left))
        if self.met(gap) or deadline.over:
            return ending
        proved, state = self.seconds, (self.without, self.cuts)
        self.without, self.cuts = self.idle, Cuts.none()
        ending = super().approach(gap, deadline)
        if self.seconds <= proved:
            self.without, self.cuts = state
        return ending

    def _leave_zones_out(self, gap: float, deadline: Deadline) -> None:
        inner = self.demands.waypoints[1:-1]
        wide = set((np.flatnonzero((inner[..., 0] < inner[..., 1]).any(axis=1)) + 1).tolist())
        zones = sorted(wide - self.idle)
        if len(zones) > _FEW:
            return
        best = self._first_bound(deadline)
        self.without = self.idle | frozenset(zones)
        found = self._first_bound(deadline)
        if found >= best:
            return
        self.without = self.idle
        for waypoint in zones:
            if deadline.over or (self.upper is not None and self.upper <= best * (1.0 + gap)):
                return
            before, self.without = self.without, self.without | {waypoint}
            found = self._first_bound(deadline)
            if found < best * (1.0 - _EQUAL):
                self.without = before
            best = max(best, found)

    def _first_bound(self, deadline: Deadline) -> float:
        """The bound in the first boxes, for the waypoints that are not left out [s]."""
        relaxed = self.relaxed(self.known)
        boxes = first_boxes(self.demands, relaxed, None)
        if boxes.empty:
            return self.known
        frame = Frame(relaxed, boxes, relaxed.units(self.typical))
        program = LinearProgram(frame, tangents(boxes.durations))
        found = program.solve(frame.cost, rounds=ROUNDS, tolerance=_COARSE, deadline=deadline)
        return min(found.bound, relaxed.horizon) + relaxed.waits
