"""A lower bound of a part of the motion, proved before the whole."""

from __future__ import annotations

from dataclasses import dataclass

from formulations.proofs.events import Log


@dataclass(frozen=True)
class PartBound:
    """Segments start .. end - 1 take more than ``seconds`` in every motion of at most ``horizon`` seconds.

    Attributes
    ----------
    start, end : int
        First segment, and the one after the last.
    seconds, horizon : float [s]
        The bound, and the most time of the whole motion for which it holds.
    known : tuple of PartBound
        Bounds of shorter parts that the proof uses.
    log : Log or None
        The events that prove it, if they were recorded.
    """

    start: int
    end: int
    seconds: float
    horizon: float
    known: tuple[PartBound, ...] = ()
    log: Log | None = None
