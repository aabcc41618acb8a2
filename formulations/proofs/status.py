"""How a proof of a lower bound ends."""

from __future__ import annotations

from enum import StrEnum


class BoundStatus(StrEnum):
    """How the proof of a bound ended."""

    PROVED = "proved"  # to the gap that was asked for
    TIGHT = "tight as it gets"  # of every motion: narrower boxes would prove no more
    TIME_LIMIT = "time limit"
    BOX_LIMIT = "box limit"
    INTERRUPTED = "interrupted"  # somebody wanted it to end
    UNDECIDED = "undecided"  # of a family: the search cannot get closer
    SIMPLE = "simple bounds only"  # of every motion: the relaxation does not apply
    SOLVER_FAILED = "solver failed"
    NOT_APPLICABLE = "not applicable"  # nothing beyond displacement over speed can be proved
