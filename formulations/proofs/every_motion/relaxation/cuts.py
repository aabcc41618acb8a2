"""Where the relaxation's rows are posed: plain numbers, one row each, good for any boxes and scales."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from formulations.problem.arrays import Array, Indices

# rows (7), (8); (9), (10) and (3) at either end of a segment; (1) without and with a piece at top
# speed; (2)
TANGENT, HULL, PRODUCT_AT_START, PRODUCT_AT_END, PEAK_AT_START, PEAK_AT_END = range(6)
STOP_AT_START, STOP_AT_END, DISTANCE, CRUISE, SPEED = range(6, 11)


@dataclass(frozen=True)
class Cuts:
    """A table of rows: kind, segment, joint (m,); sign (m,) of the motion; at (m, 6).

    at: t [s], the number of a corner or c [rad/s^3] in the first column, or the switches.
    """

    kind: Indices
    segment: Indices
    joint: Indices
    sign: Array
    at: Array

    def __len__(self) -> int:
        return len(self.kind)

    def __getitem__(self, which: Indices | NDArray[np.bool_] | slice) -> Cuts:
        return Cuts(*(column[which] for column in vars(self).values()))

    @staticmethod
    def of(
        kind: int | Indices,
        segment: Indices,
        at: Array,
        joint: int | Indices = 0,
        sign: float | Array = 1.0,
    ) -> Cuts:
        """A table from columns or single values; at: (m,) or (m, w)."""
        m = len(segment)
        wide = np.zeros((m, 6))
        wide[:, : 1 if at.ndim == 1 else at.shape[1]] = at.reshape(m, -1 if m else 1)
        same = np.broadcast_to
        return Cuts(
            np.array(same(kind, m)), segment, np.array(same(joint, m)), np.array(same(sign, m)), wide
        )

    @staticmethod
    def joined(tables: list[Cuts]) -> Cuts:
        """Several tables as one."""
        columns = zip(*(vars(table).values() for table in tables), strict=True)
        return Cuts(*(np.concatenate(column) for column in columns))
