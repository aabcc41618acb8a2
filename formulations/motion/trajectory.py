"""A motion of all joints as exact piecewise polynomials."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import factorial, perm

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PPoly

from formulations.motion.extremes import Extremes, find_extremes
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError

MOST_SAMPLES = 5_000_000  # of a motion at a fixed rate

_ROUNDING = 1e-9  # share of the whole time by which a time may lie outside


@dataclass(frozen=True)
class Trajectory:
    """Piecewise polynomial motion of all joints.

    Parameters
    ----------
    durations : Array, shape (n_pieces,)
        Duration of each piece [s], positive.
    coefficients : Array, shape (n_pieces, dof, degree + 1)
        Ascending powers of the local time, which starts at 0 on every piece [rad/s^k].
    passages : Array, shape (n_waypoints,), optional
        Times at which the waypoints are passed [s]. Left out, they are the times at which pieces meet.

    Raises
    ------
    InputError
        For shapes that do not fit, durations that are not positive, and numbers that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> ramp = Trajectory(np.array([2.0]), np.array([[[0.0, 0.5]]]))  # 0.5 rad/s for 2 s
    >>> ramp.seconds
    2.0
    >>> ramp.at([0.0, 2.0]).tolist()
    [[0.0], [1.0]]
    """

    durations: Array
    coefficients: Array
    passages: Array | None = None

    def __post_init__(self) -> None:
        if self.coefficients.ndim != 3 or len(self.coefficients) != len(self.durations):
            raise InputError(
                f"trajectory: coefficients {self.coefficients.shape} do not fit "
                f"{len(self.durations)} durations"
            )
        if not (np.isfinite(self.durations).all() and (self.durations > 0.0).all()):
            raise InputError(f"trajectory: durations must be positive, got {self.durations}")
        if not np.isfinite(self.coefficients).all():
            raise InputError("trajectory: coefficients must be finite")
        if self.passages is not None and not np.isfinite(self.passages).all():
            raise InputError(f"trajectory: passage times must be finite, got {self.passages}")

    @property
    def dof(self) -> int:
        """Number of joints."""
        return int(self.coefficients.shape[1])

    @cached_property
    def breaks(self) -> Array:
        """Breakpoints, (n_pieces + 1,) [s]."""
        return np.concatenate([[0.0], np.cumsum(self.durations)])

    @property
    def seconds(self) -> float:
        """Total time [s]."""
        return float(self.breaks[-1])

    @property
    def passage_times(self) -> Array:
        """Times at which the waypoints are passed, (n_waypoints,) [s]."""
        return self.breaks if self.passages is None else self.passages

    @cached_property
    def _piecewise(self) -> PPoly:
        return PPoly(np.moveaxis(self.coefficients[..., ::-1], -1, 0), self.breaks)

    def at(self, times: ArrayLike, order: int = 0) -> Array:
        """Evaluate the motion.

        Parameters
        ----------
        times : array_like, shape (...)
            Times from the start [s].
        order : int
            Order of the derivative; 0 is the position.

        Returns
        -------
        Array, shape (..., dof)
            Values [rad/s^order].

        Raises
        ------
        InputError
            For a time before the start or after the end by more than rounding, and a negative order.
        """
        if order < 0:
            raise InputError(f"order: {order} is no order of a derivative; 0 is the position")
        asked = np.asarray(times, dtype=np.float64)
        slack = _ROUNDING * self.seconds
        inside = (asked >= -slack) & (asked <= self.seconds + slack)  # false for NaN
        if not inside.all():
            time = float(asked[~inside].flat[0])
            raise InputError(
                f"times: {time:g} s is not within the motion, which takes 0 to {self.seconds:.6g} s"
            )
        return np.asarray(self._piecewise(np.clip(asked, 0.0, self.seconds), nu=order))

    def __repr__(self) -> str:
        return f"Trajectory({self.seconds:.6g} s: {self.dof} joints, {len(self.durations)} pieces)"

    def sample(self, rate: float) -> tuple[Array, Array]:
        """Sample position, velocity, acceleration and jerk at a fixed rate, the end included.

        Parameters
        ----------
        rate : float
            Samples per second [1/s].

        Returns
        -------
        times : Array, shape (m,)
            Multiples of 1 / rate, then the final time [s].
        values : Array, shape (4, m, dof)
            Position to jerk [rad to rad/s^3].

        Raises
        ------
        InputError
            For a rate that is not positive.
        """
        times = self.sample_times(rate)
        return times, np.stack([self.at(times, order) for order in range(4)])

    def sample_times(self, rate: float) -> Array:
        """Times at a fixed rate, the end included.

        Parameters
        ----------
        rate : float
            Samples per second [1/s].

        Returns
        -------
        Array, shape (m,)
            Multiples of 1 / rate, then the final time [s].

        Raises
        ------
        InputError
            For a rate that is not positive, and for more than 5,000,000 samples.
        """
        if not (np.isfinite(rate) and rate > 0.0):
            raise InputError(f"trajectory: a sample rate must be positive, got {rate:g}")
        if self.seconds * rate > MOST_SAMPLES:
            raise InputError(
                f"trajectory: a sample rate of {rate:g} over {self.seconds:.4g} s makes "
                f"{self.seconds * rate:.3g} samples; at most {MOST_SAMPLES} are made"
            )
        # drop a last multiple that lies within rounding of the final time: the final time stands for it
        steps = int(np.ceil(self.seconds * rate * (1.0 - 1e-12) - 1e-9))
        return np.append(np.arange(steps) / rate, self.seconds)

    def stretched(self, factor: float) -> Trajectory:
        """Return the same path at another pace.

        Parameters
        ----------
        factor : float
            Every duration is multiplied by it; above 1 the motion is slower.

        Returns
        -------
        Trajectory
            Velocities are divided by the factor, accelerations by its square, jerks by its cube.
        """
        powers = factor ** -np.arange(self.coefficients.shape[2], dtype=np.float64)
        return Trajectory(
            self.durations * factor,
            self.coefficients * powers,
            None if self.passages is None else self.passages * factor,
        )

    def extremes(self, order: int) -> Extremes:
        """Find the exact extremes of a derivative on every piece.

        Parameters
        ----------
        order : int
            Order of the derivative; 0 is the position.

        Returns
        -------
        Extremes
            Computed once and kept.
        """
        if order not in self._extremes:
            self._extremes[order] = find_extremes(self._normalised, self.durations, self.breaks, order)
        return self._extremes[order]

    def reach(self, order: int) -> Array:
        """Find the largest absolute value of a derivative in the whole motion.

        Parameters
        ----------
        order : int
            Order of the derivative; 0 is the position.

        Returns
        -------
        Array, shape (dof,)
            [rad/s^order].
        """
        found = self.extremes(order)
        return np.asarray(np.maximum(-found.low.min(axis=0), found.high.max(axis=0)))

    @cached_property
    def _extremes(self) -> dict[int, Extremes]:
        return {}

    @cached_property
    def _normalised(self) -> Array:
        """Coefficients on normalised time s = t / T of each piece; in memory a row per power."""
        rows = np.moveaxis(self.coefficients, -1, 0)
        factors = self.durations[:, None] ** np.arange(len(rows))[:, None, None]
        return np.moveaxis(np.multiply(rows, factors, order="C"), 0, -1)

    @cached_property
    def jumps_between(self) -> Array:
        """Jump of position, velocity, acceleration at each inner break, (3, n_pieces - 1, dof)."""
        return np.stack([np.abs(self._start(k)[1:] - self._end(k)[:-1]) for k in range(3)])

    @property
    def jumps(self) -> Array:
        """Largest jump per joint of position, velocity, acceleration at inner breaks, (3, dof)."""
        return np.asarray(self.jumps_between.max(axis=1, initial=0.0))

    def _start(self, order: int) -> Array:
        """A derivative at the start of each piece, (n_pieces, dof)."""
        if order >= self.coefficients.shape[2]:
            return np.zeros(self.coefficients.shape[:2])
        return np.asarray(self.coefficients[..., order] * factorial(order))

    def _end(self, order: int) -> Array:
        """The same at its end."""
        powers = range(self.coefficients.shape[2] - 1, order - 1, -1)
        value = np.zeros(self.coefficients.shape[:2])
        for power in powers:
            value += self._normalised[..., power] * perm(power, order)
        return np.asarray(value / self.durations[:, None] ** order)
