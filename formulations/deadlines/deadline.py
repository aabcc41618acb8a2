"""``Deadline``: the end of the time that a computation may take, or an interrupt that ends it sooner."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import TypeAlias

from formulations.problem.errors import InputError

Stop: TypeAlias = Callable[[], bool]  # asked again and again; True ends the computation


class Deadline:
    """The end of the time that a computation may take.

    Solvers ask ``over`` between their steps, and give the best that they have found so far.
    """

    def __init__(self, seconds: float | None = None, stop: Stop | None = None) -> None:
        """Start the clock.

        Parameters
        ----------
        seconds : float, optional
            Time from now on [s]; None or infinite for no limit.
        stop : callable, optional
            Says whether somebody wants the computation to end now.

        Raises
        ------
        InputError
            If the time is negative or not a number.
        """
        if seconds is not None and not seconds >= 0.0:
            raise InputError(f"time_limit: {seconds!r} s is not a time")
        self.end = math.inf if seconds is None else time.perf_counter() + seconds
        self.stop = stop

    @property
    def left(self) -> float:
        """Time that is left [s]: 0 after an interrupt, infinite without a limit."""
        return 0.0 if self.interrupted else max(self.end - time.perf_counter(), 0.0)

    @property
    def interrupted(self) -> bool:
        """Whether somebody wants the computation to end now."""
        return self.stop is not None and self.stop()

    @property
    def over(self) -> bool:
        """Whether the computation has to end."""
        return self.interrupted or time.perf_counter() >= self.end

    def within(self, seconds: float) -> Deadline:
        """Make the deadline of a part of the computation.

        Parameters
        ----------
        seconds : float
            What the part may take at most, from now on [s].

        Returns
        -------
        Deadline
            The sooner of the two; an interrupt ends both.
        """
        part = Deadline(seconds, self.stop)
        part.end = min(part.end, self.end)
        return part


NEVER = Deadline()  # no limit, and nobody interrupts
