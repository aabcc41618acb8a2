"""Events of a search in depth-first order: together with the problem they are the certificate.

LEAF    the Lagrangian of the rows is positive on the box
BELOW   it is positive where variable k is above ``value``: the box ends there from now on
ABOVE   the mirror image: the box begins there
SPLIT   of variable k at ``value``; the upper half is the next box, the lower one follows
TURN    (4-3-4) the box is cut by the total time, velocities are enclosed about its middle
EMPTY   nothing is left of the box after the cuts of the total, the enclosure, or the slabs
ASIDE   undecided, set aside (only if asked for, in tests): no proof
"""

from __future__ import annotations

from typing import Any

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.rows import WIDTH

TURN, EMPTY, LEAF, BELOW, ABOVE, SPLIT, ASIDE = 0, 1, 2, 3, 4, 5, 6

# statistics of a search, and the number of events logged
BOXES, LEAVES, EMPTIES, SLABS, EVENTS, N_COUNTS = 0, 1, 2, 3, 4, 5


def empty_log(capacity: int, n_variables: int, most_rows: int) -> tuple[Any, Any, Any, Any]:
    """Room for events: codes (m, 3): event, variable, number of rows; values (m,); boxes after the
    event (m, 2, n_variables); rows (m, most_rows, WIDTH).
    """
    return (
        np.zeros((capacity, 3), np.int64),
        np.zeros(capacity),
        np.zeros((capacity, 2, n_variables)),
        np.zeros((capacity, most_rows, WIDTH)),
    )


@compiled
def copy(target: Any, source: Any) -> None:
    """target[:] = source, which takes the compiler seconds."""
    for i in range(len(source)):
        target[i] = source[i]


@compiled
def write(
    log: Any, counts: Any, event: int, k: int, value: float, lo: Any, hi: Any, rows: Any, n_rows: int
) -> None:
    """Append one event; without capacity nothing is logged."""
    codes, values, boxes, kept = log
    e = counts[EVENTS]
    if e < len(codes):
        codes[e, 0], codes[e, 1], codes[e, 2] = event, k, n_rows
        values[e] = value
        for i in range(len(lo)):
            boxes[e, 0, i], boxes[e, 1, i] = lo[i], hi[i]
        for i in range(n_rows):
            copy(kept[e, i], rows[i])
        counts[EVENTS] = e + 1
