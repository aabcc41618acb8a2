"""Whether a swarm is drawn to zero: the same instances with the box moved away from zero.

In the coordinates ``printed`` the durations lie just above zero. In ``offset`` the same box lies ten of its
widths away from zero, and the random numbers are the same: a search that does not know where zero is does
the same but for rounding. In ``mirrored`` short durations are where long ones were: only a search that
prefers one end of the box differs.

The swarm is drawn to zero if ``offset`` and ``printed`` differ significantly (Wilcoxon's test over the
instances, Holm-corrected over both comparisons) and by more than is negligible, 0.06 in the mean of A12. As
the random numbers are common, rounding alone makes a small difference significant, but never a large one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from compare.benchmark.protocol import Coordinates
from compare.grading.cells import Cell, CellKey
from compare.grading.contest import ALPHA
from compare.statistics.equivalence import NEGLIGIBLE, Effect, effect_over_instances
from compare.statistics.pairs import holm, superiority


@dataclass(frozen=True)
class Moved:
    """The swarm in moved coordinates beside itself in the printed ones; ``effect.p`` is after Holm."""

    coordinates: Coordinates
    effect: Effect

    @property
    def differs(self) -> bool:
        """Whether it does better or worse there."""
        return self.effect.p < ALPHA and not self.slight

    @property
    def slight(self) -> bool:
        """Whether the difference seen is negligible."""
        return abs(self.effect.mean - 0.5) < NEGLIGIBLE


@dataclass(frozen=True)
class DrawnToZero:
    """What moving the coordinates does to a swarm.

    Attributes
    ----------
    instances, seeds : int
        On how many it was tested.
    moved : tuple of Moved
        ``offset``, then ``mirrored``.
    """

    instances: int
    seeds: int
    moved: tuple[Moved, ...]

    @property
    def drawn(self) -> bool:
        """Whether it matters to the swarm where zero lies."""
        return self.moved[0].differs

    @property
    def sentence(self) -> str:
        """What was found, with its numbers."""
        offset, mirrored = self.moved
        told = (
            f"with zero moved away, a run beats one with zero beside the box with probability"
            f" {offset.effect.mean:.2f} (p = {offset.effect.p:.1g}, {self.instances} instances,"
            f" {self.seeds} seeds)"
        )
        if self.drawn:
            which = "gains from" if offset.effect.mean < 0.5 else "loses by"
            return f"It is drawn to zero, and {which} it here: {told}."
        if mirrored.differs:
            return (
                "It is not drawn to zero, but prefers one end of the box: mirrored, a run beats one as"
                f" printed with probability {mirrored.effect.mean:.2f} (p = {mirrored.effect.p:.1g})."
            )
        if offset.slight:
            return f"It is not drawn to zero: {told}."
        return f"There is no sign that it is drawn to zero: {told}."


def drawn_to_zero(cells: Mapping[CellKey, Cell], swarm: str, cases: Sequence[str]) -> DrawnToZero:
    """Compare a swarm in moved coordinates with itself in the printed ones.

    Parameters
    ----------
    cells : mapping of (instance, swarm, coordinates) to Cell
    swarm : str
    cases : sequence of str
        Instances on which it was run in all three coordinates.

    Returns
    -------
    DrawnToZero
    """
    moved, seeds = [], len(cells[cases[0], swarm, Coordinates.offset])
    for seen in (Coordinates.offset, Coordinates.mirrored):
        a12 = [
            superiority(
                cells[case, swarm, seen].losses,
                cells[case, swarm, Coordinates.printed].losses[:seeds],
            )
            for case in cases
        ]
        moved.append(Moved(seen, effect_over_instances(a12, seeds, seeds, ALPHA)))
    together = holm([one.effect.p for one in moved])
    adjusted = tuple(
        replace(one, effect=replace(one.effect, p=float(p)))
        for one, p in zip(moved, together, strict=True)
    )
    return DrawnToZero(len(cases), seeds, adjusted)
