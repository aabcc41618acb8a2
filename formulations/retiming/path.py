"""A path given by dense points: its spline, a choice of its points, and how far a motion leaves it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.spatial import cKDTree

from formulations.motion.files.motion_points import MotionPoints
from formulations.motion.trajectory import Trajectory
from formulations.problem.arrays import Array
from formulations.problem.errors import InputError

_BETWEEN = 4  # points of the path per piece of a motion that states velocities
_GOLDEN = 0.5 * (5.0**0.5 - 1.0)
_SECTIONS = 40
_SAMPLES = 16  # per piece of a motion, where the search for the largest distance starts; two where
_MANY = 1000  # there are as many pieces as this
_PLACES = 100  # local maxima that are looked at closely
_FEW = 100  # segments of a path that are all looked at for each place of a motion
_SHORT = 5000  # pieces that a path of more is cut into at least
_NEAREST = 8  # of these, that are looked at; a farther one is nearer by no more than its length
_DENSE = 20_000  # pieces of a motion that need no points between
_CHORDS = 200  # of a motion, from which the points of a path are measured


@dataclass(frozen=True)
class Path:
    """A path through dense points, in order.

    Make one with ``Path.of``.

    Attributes
    ----------
    points : Array, shape (n_points, dof) [rad]
        No two neighbours are equal; at least two.
    names : tuple of str
        Names of the joints; empty where none are known.
    """

    points: Array
    names: tuple[str, ...] = ()

    @staticmethod
    def of(motion: MotionPoints | Trajectory | Array) -> Path:
        """Take the path of a motion and leave out its times.

        Parameters
        ----------
        motion : MotionPoints, Trajectory, or Array of shape (n_points, dof) [rad]
            Between points that state velocities, the path follows the motion that a controller makes
            of them.

        Returns
        -------
        Path

        Raises
        ------
        InputError
            If no joint moves.
        """
        names: tuple[str, ...] = ()
        if isinstance(motion, MotionPoints):
            names = motion.names
            motion = motion.positions if motion.velocities is None else motion.motion()
        if isinstance(motion, Trajectory):
            between = _BETWEEN if len(motion.durations) < _DENSE else 1
            steps = np.arange(between) / between
            times = (motion.breaks[:-1, None] + motion.durations[:, None] * steps).ravel()
            motion = motion.at(np.append(times, motion.seconds))
        points = np.asarray(motion, dtype=np.float64)
        reach = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
        if not reach > 0.0:
            raise InputError("motion: no joint moves, so there is no path")
        # points within rounding of each other have no direction between them
        least = 1e-9 * reach
        kept = np.flatnonzero(np.append(True, np.abs(np.diff(points, axis=0)).max(axis=1) > least))
        points = points[kept]
        return Path(points, names)

    @cached_property
    def lengths(self) -> Array:
        """Length of the polyline up to each point, (n_points,) [rad]."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @cached_property
    def spline(self) -> BSpline:
        """Spline of degree 5 through the points, by their lengths; of lower degree for few points."""
        degree = {2: 1, 3: 2, 4: 3, 5: 3}.get(len(self.points), 5)
        return make_interp_spline(self.lengths, self.points, k=degree)

    def simplified(self, tolerance: float) -> list[int]:
        """Choose points whose polyline stays within a tolerance of all points (Douglas-Peucker).

        Parameters
        ----------
        tolerance : float [rad]
            Largest distance in joint space of a point from the polyline.

        Returns
        -------
        list of int
            Indices of the points, rising, the first and the last included.

        References
        ----------
        Douglas & Peucker 1973, "Algorithms for the reduction of the number of points required to
        represent a digitized line or its caricature", Cartographica 10, pp. 112-122.
        """
        keep = np.zeros(len(self.points), dtype=bool)
        keep[[0, -1]] = True
        spans = [(0, len(self.points) - 1)]
        while spans:
            first, last = spans.pop()
            if last - first < 2:
                continue
            inner = self.points[first + 1 : last]
            far = _to_segments(inner, self.points[[first]], self.points[[last]])[:, 0]
            worst = int(far.argmax())
            if far[worst] > tolerance:
                middle = first + 1 + worst
                keep[middle] = True
                spans += [(first, middle), (middle, last)]
        return np.flatnonzero(keep).tolist()

    def farthest(
        self, motion: Trajectory, start: float = 0.0, end: float | None = None
    ) -> tuple[float, float]:
        """Find where a motion is farthest from the polyline of the points.

        Around each local maximum among samples, the largest distance is found by golden sections.

        Parameters
        ----------
        motion : Trajectory
        start, end : float, optional [s]
            The part of the motion that is looked at; the whole if left out.

        Returns
        -------
        time : float [s]
        distance : float [rad]
            In joint space: no joint is farther off than this.
        """
        end = motion.seconds if end is None else end
        inside = motion.breaks[(motion.breaks > start) & (motion.breaks < end)]
        breaks = np.unique(np.concatenate([[start, end], inside]))
        steps = np.arange(_SAMPLES if len(breaks) < _MANY else 2)
        times = (breaks[:-1, None] + np.diff(breaks)[:, None] * steps / len(steps)).ravel()
        times = np.append(times, end)
        distance = self._away(motion.at(times))
        padded = np.concatenate([[-np.inf], distance, [-np.inf]])
        found = np.flatnonzero((distance >= padded[:-2]) & (distance > padded[2:]))
        found = found[np.argsort(-distance[found])[:_PLACES]]
        low, high = times[np.maximum(found - 1, 0)], times[np.minimum(found + 1, len(times) - 1)]
        for _ in range(_SECTIONS):
            left, right = low + (high - low) * (1.0 - _GOLDEN), low + (high - low) * _GOLDEN
            is_left = self._away(motion.at(left)) >= self._away(motion.at(right))
            low, high = np.where(is_left, low, left), np.where(is_left, right, high)
        at = np.concatenate([0.5 * (low + high), times[found]])
        away = self._away(motion.at(at))
        worst = int(away.argmax())
        return float(at[worst]), float(away[worst])

    def left_out(self, motion: Trajectory, start: float = 0.0, end: float | None = None) -> float:
        """Largest distance of a point of the path from a motion, which is sampled for this.

        Parameters
        ----------
        motion : Trajectory
        start, end : float, optional [s]
            The part of the motion that is looked at; the whole if left out.

        Returns
        -------
        float [rad]
        """
        times = np.linspace(start, motion.seconds if end is None else end, _CHORDS)
        return float(Path(motion.at(times))._away(self.points).max())

    def divided(self, count: int) -> Path:
        """The same polyline with further points on it, evenly between two given ones.

        Parameters
        ----------
        count : int
            Least number of points.

        Returns
        -------
        Path
        """
        share = int(np.ceil(count / len(self.points)))
        at = np.arange((len(self.points) - 1) * share + 1) / share
        given = np.arange(len(self.points))
        columns = [np.interp(at, given, column) for column in self.points.T]
        return Path(np.stack(columns, axis=1), self.names)

    def part(self, first: int, last: int) -> Path:
        """The path from one of its points to another, both included.

        Parameters
        ----------
        first, last : int

        Returns
        -------
        Path
        """
        return Path(self.points[first : last + 1], self.names)

    def _away(self, positions: Array) -> Array:
        """Distance of positions (m, dof) from the polyline, (m,)."""
        starts, ends, tree = self._segments
        if tree is None:
            return np.asarray(_to_segments(positions, starts, ends).min(axis=1))
        # of many short segments, those with the nearest middles
        _, near = tree.query(positions, k=_NEAREST)
        found = [_to_segment(positions, starts[k], ends[k]) for k in near.T]
        return np.asarray(np.min(found, axis=0))

    @cached_property
    def _segments(self) -> tuple[Array, Array, cKDTree | None]:
        """Starts and ends of the segments, and where they are many, cut short, a tree of their middles."""
        starts, ends = self.points[:-1], self.points[1:]
        if len(starts) <= _FEW:
            return starts, ends, None
        lengths = np.diff(self.lengths)
        cuts = np.ceil(lengths / (self.lengths[-1] / _SHORT)).astype(np.int64)
        which = np.repeat(np.arange(len(starts)), cuts)
        place = (np.arange(len(which)) - np.repeat(np.cumsum(cuts) - cuts, cuts))[:, None]
        step = ((ends - starts) / cuts[:, None])[which]
        starts = starts[which] + place * step
        return starts, starts + step, cKDTree(starts + 0.5 * step)


def _to_segment(positions: Array, starts: Array, ends: Array) -> Array:
    """Distance of each position (m, dof) from its segment (m, dof), (m,)."""
    along = ends - starts
    squared = np.maximum(np.square(along).sum(axis=1), 1e-300)
    share = np.clip(((positions - starts) * along).sum(axis=1) / squared, 0.0, 1.0)
    return np.asarray(np.linalg.norm(positions - starts - share[:, None] * along, axis=1))


def _to_segments(positions: Array, starts: Array, ends: Array) -> Array:
    """Distances of positions (m, dof) from segments (n, dof), (m, n)."""
    along = ends - starts
    squared = np.maximum(np.square(along).sum(axis=1), 1e-300)
    offset = positions[:, None] - starts
    share = np.clip(np.einsum("mnd,nd->mn", offset, along) / squared, 0.0, 1.0)
    return np.asarray(np.linalg.norm(offset - share[..., None] * along, axis=2))
