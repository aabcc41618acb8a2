"""Events of a branch and bound in depth-first order: together with the problem they are the certificate.

LEAF    the Lagrangian of the rows is positive on the box: no feasible motion is in it
BELOW   it is positive where variable k is above ``value``: the box ends there from now on
ABOVE   it is positive where variable k is below ``value``: the box begins there from now on
SPLIT   the box is split at ``value`` of variable k; the upper half is next, the lower half follows
TURN    (4-3-4) the total time cuts the box, and the velocities are enclosed about its middle
EMPTY   nothing is left of the box after the cuts
ASIDE   the box is undecided and set aside (only tests ask for this; it is no proof)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from formulations.compiled import compiled
from formulations.proofs.conditions import WIDTH

TURN, EMPTY, LEAF, BELOW, ABOVE, SPLIT, ASIDE = 0, 1, 2, 3, 4, 5, 6

# counters of a search, the number of logged events among them
BOXES, LEAVES, EMPTIES, SLABS, EVENTS, N_COUNTS = 0, 1, 2, 3, 4, 5


class Box(NamedTuple):
    """A box of the variables: lower and upper ends, (n_variables,) each."""

    lo: Any
    hi: Any


class Effort(NamedTuple):
    """How long a search may go on.

    max_boxes: boxes of this call. narrow: width in the logarithm below which a box is undecided.
    aside: whether undecided boxes are set aside; if not, the search stops at the first.
    """

    max_boxes: int
    narrow: float
    aside: bool


class EventTrace(NamedTuple):
    """Counters and the log of a search, both filled by the compiled code.

    counts (N_COUNTS,). Of each of m events: codes (m, 3) event, variable, number of rows; values (m,);
    boxes (m, 2, n_variables) after the event; rows (m, most_rows, WIDTH). Without room nothing is logged.
    """

    counts: Any
    codes: Any
    values: Any
    boxes: Any
    rows: Any


@dataclass(frozen=True)
class Log:
    """All events of a search, in order; the fields are those of ``EventTrace``."""

    codes: Any
    values: Any
    boxes: Any
    rows: Any


def empty_trace(capacity: int, n_variables: int, most_rows: int) -> EventTrace:
    """Make counters at zero and room for events.

    Parameters
    ----------
    capacity : int
        Number of events; 0 to log none.
    n_variables, most_rows : int
        Variables of a box, and rows of an event.

    Returns
    -------
    EventTrace
        The empty trace.
    """
    return EventTrace(
        np.zeros(N_COUNTS, np.int64),
        np.zeros((capacity, 3), np.int64),
        np.zeros(capacity),
        np.zeros((capacity, 2, n_variables)),
        np.zeros((capacity, most_rows, WIDTH)),
    )


@compiled
def copy(target: Any, source: Any) -> None:
    """Copy a one-dimensional array; ``target[:] = source`` would take the compiler seconds.

    Parameters
    ----------
    target, source : ndarray, shape (n,)
        The array to fill, and the values.
    """
    for i in range(len(source)):
        target[i] = source[i]


@compiled
def write(trace: Any, event: int, k: int, value: float, box: Any, rows: Any, n_rows: int) -> None:
    """Append one event to the log, if it has room at all.

    Parameters
    ----------
    trace : EventTrace
        The log.
    event, k : int
        What happened, and to which variable.
    value : float
        Where.
    box : Box
        The box after the event.
    rows : ndarray, shape (at least n_rows, WIDTH)
        The rows that prove it.
    n_rows : int
        Their number.
    """
    e = trace.counts[EVENTS]
    if e < len(trace.codes):
        trace.codes[e, 0], trace.codes[e, 1], trace.codes[e, 2] = event, k, n_rows
        trace.values[e] = value
        for i in range(len(box.lo)):
            trace.boxes[e, 0, i], trace.boxes[e, 1, i] = box.lo[i], box.hi[i]
        for i in range(n_rows):
            copy(trace.rows[e, i], rows[i])
        trace.counts[EVENTS] = e + 1


@compiled
def has_room(trace: Any, n_events: int) -> bool:
    """Whether the log takes so many more events, or is not kept at all.

    Parameters
    ----------
    trace : EventTrace
        The log.
    n_events : int
        Most events that the next box can cause.

    Returns
    -------
    bool
        False if the log must be emptied first.
    """
    capacity = len(trace.codes)
    return capacity == 0 or trace.counts[EVENTS] + n_events <= capacity


@compiled
def push_halves(stack: Any, depth: int, box: Any, x: int, middle: float) -> None:
    """Push both halves of a box; the upper half is the next.

    Parameters
    ----------
    stack : ndarray, shape (size, 2, n_variables)
        Ends of the boxes.
    depth : int
        Number of boxes on the stack.
    box : Box
        The box to split.
    x : int
        The variable that is split.
    middle : float
        Where.
    """
    for child in range(2):
        copy(stack[depth + child, 0], box.lo)
        copy(stack[depth + child, 1], box.hi)
        stack[depth + child, 1 - child, x] = middle
