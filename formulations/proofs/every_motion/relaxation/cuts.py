"""Cuts: where the rows of the relaxation are posed. Plain numbers that fit any boxes and scales."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from formulations.problem.arrays import Array, Indices, Truths


class Kind(IntEnum):
    """The kinds of rows, with the numbers of their equations in ``rows`` and ``reach``."""

    TANGENT = 0  # (7)
    HULL = 1  # (8)
    PRODUCT_AT_START = 2  # (9), at either end of a segment
    PRODUCT_AT_END = 3
    PEAK_AT_START = 4  # (10)
    PEAK_AT_END = 5
    STOP_AT_START = 6  # (3)
    STOP_AT_END = 7
    DISTANCE = 8  # (1) without a piece at top speed
    CRUISE = 9  # (1) with one
    SPEED = 10  # (2)
    ZONE_AT_START = 11  # (11), at either end of a segment
    ZONE_AT_END = 12
    SPEED_PRODUCT_AT_START = 13  # (9) of T v
    SPEED_PRODUCT_AT_END = 14
    SQUARE_PRODUCT_AT_START = 15  # (9) of T^2 a
    SQUARE_PRODUCT_AT_END = 16
    FADE_AT_START = 17  # (10) at an acceleration
    FADE_AT_END = 18
    CHANGE = 19  # (14)
    TANGENT_TIMES_T = 20  # rows times T
    HULL_TIMES_T = 21
    DISTANCE_TIMES_T = 22
    CRUISE_TIMES_T = 23
    STOP_TIMES_T_AT_START = 24
    STOP_TIMES_T_AT_END = 25

    @property
    def end(self) -> int:
        """The end of the segment that the row is about: 0 start, 1 end."""
        return int(self.name.endswith("END"))

    @property
    def times_T(self) -> bool:  # noqa: N802
        """Whether the row is one in 1 / T, taken times T."""
        return "TIMES_T" in self.name


PRODUCTS = (Kind.PRODUCT_AT_START, Kind.PRODUCT_AT_END)
PEAKS = (Kind.PEAK_AT_START, Kind.PEAK_AT_END)
STOPS = (
    Kind.STOP_AT_START,
    Kind.STOP_AT_END,
    Kind.STOP_TIMES_T_AT_START,
    Kind.STOP_TIMES_T_AT_END,
)
TANGENTS = (Kind.TANGENT, Kind.TANGENT_TIMES_T)
HULLS = (Kind.HULL, Kind.HULL_TIMES_T)
ZONES = (Kind.ZONE_AT_START, Kind.ZONE_AT_END)
SPEED_PRODUCTS = (Kind.SPEED_PRODUCT_AT_START, Kind.SPEED_PRODUCT_AT_END)
SQUARE_PRODUCTS = (Kind.SQUARE_PRODUCT_AT_START, Kind.SQUARE_PRODUCT_AT_END)
ALL_PRODUCTS = (*PRODUCTS, *SPEED_PRODUCTS, *SQUARE_PRODUCTS, *ZONES)
FADES = (Kind.FADE_AT_START, Kind.FADE_AT_END)
CRUISES = (Kind.CRUISE, Kind.CRUISE_TIMES_T)
DISTANCES = (*CRUISES, Kind.DISTANCE, Kind.DISTANCE_TIMES_T)


@dataclass(frozen=True)
class Cuts:
    """A table with one cut per line.

    Attributes
    ----------
    kind : Indices, shape (m,)
        A ``Kind``.
    segment, joint : Indices, shape (m,)
        Numbers within the relaxed problem.
    sign : Array, shape (m,)
        Direction of motion, 1 or -1.
    at : Array, shape (m, 6)
        The place. First column: t [s] of (7) and (8), the number of a corner of (9) and (11), c [rad/s^3] or
        an acceleration [rad/s^2] of (10). The first two columns of (2) and (3), all six of (1): switches in
        [0, 1].
    """

    kind: Indices
    segment: Indices
    joint: Indices
    sign: Array
    at: Array

    def __len__(self) -> int:
        return len(self.kind)

    def __getitem__(self, which: Indices | Truths | slice) -> Cuts:
        return Cuts(*(column[which] for column in vars(self).values()))

    @staticmethod
    def none() -> Cuts:
        """A table without lines."""
        return Cuts.of(Kind.TANGENT, np.arange(0), np.empty(0))

    @staticmethod
    def of(
        kind: int | Indices,
        segment: Indices,
        at: Array,
        joint: int | Indices = 0,
        sign: float | Array = 1.0,
    ) -> Cuts:
        """Make a table from columns or single values.

        Parameters
        ----------
        kind, joint, sign : scalar or array, shape (m,)
        segment : Indices, shape (m,)
        at : Array, shape (m,) or (m, w)

        Returns
        -------
        Cuts
        """
        m = len(segment)
        wide = np.zeros((m, 6))
        wide[:, : 1 if at.ndim == 1 else at.shape[1]] = at.reshape(m, -1 if m else 1)
        same = np.broadcast_to
        return Cuts(
            np.array(same(kind, m)), segment, np.array(same(joint, m)), np.array(same(sign, m)), wide
        )

    @staticmethod
    def joined(tables: list[Cuts]) -> Cuts:
        """Put several tables below one another.

        Parameters
        ----------
        tables : list of Cuts

        Returns
        -------
        Cuts
        """
        columns = zip(*(vars(table).values() for table in tables), strict=True)
        return Cuts(*(np.concatenate(column) for column in columns))
