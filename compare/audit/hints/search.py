"""Tries every change of a paper and keeps those that explain some of its faults and cause none."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from compare.audit.findings import Finding
from compare.audit.hints.dh_forms import by_chance, dh_readings, largest_miss
from compare.audit.hints.hint import QUESTIONS, Change, Hint
from compare.audit.hints.order import other_tables, signs, swaps
from compare.audit.hints.places import FULL, Place, Places, State, explained, faulty_places
from compare.audit.hints.units import angle_units, length_units, time_units
from compare.audit.paper import Paper
from compare.audit.paper.words import number

# Share of the limits that something of a kind must use after a change: limits that are far away explain
# nothing. Degrees and radians differ by a factor of 57.
_LEAST_USE = {"vector": 0.5, "totals": 0.5, "waypoint": 0.1}

_AS_NEAR = 1.05  # of the smallest miss: a simpler reading that comes as near is preferred


@dataclass(frozen=True)
class _Judged:
    """A change, the faulty places that it explains, and how far the motions there use their limits."""

    change: Change
    places: frozenset[Place]
    uses: tuple[float, ...]  # stretch of the motions at these places, ascending
    cost: int = 1  # things changed


def hints_of(paper: Paper, findings: Sequence[Finding]) -> list[Hint]:
    """Find single changes of a paper that would explain some of its faults.

    Parameters
    ----------
    paper : Paper
        What the paper prints.
    findings : sequence of Finding
        Of its audit.

    Returns
    -------
    list of Hint
        At most one of each kind, those that explain most first. Empty if nothing is faulty, or if no
        change explains anything without making a sound place faulty.
    """
    faulty = faulty_places(paper, findings)
    if not faulty:
        return []
    search = _Search(paper, faulty)
    found = [
        *search.judged([*angle_units(paper), *time_units(paper), *length_units(paper)]),
        *search.judged([*signs(paper), *swaps(paper), *other_tables(paper)]),
    ]
    if any(what == "point" for what, _ in search.faulty):
        found += search.dh_judged()
    of = sum(finding.fault for finding in findings)
    return [search.hint(best, others, of) for best, others in _best(found)]


def _best(found: Sequence[_Judged]) -> list[tuple[_Judged, tuple[str, ...]]]:
    """Choose the best change of each kind, with the others that explain the same.

    A kind that explains a part of what another kind explains is left out.
    """
    chosen = []
    for kind in QUESTIONS:
        group = [judged for judged in found if judged.change.kind == kind]
        if group:
            best = max(group, key=lambda judged: (len(judged.places), -judged.cost, judged.uses))
            alike = sorted(
                (j for j in group if j.places == best.places and j.cost == best.cost and j is not best),
                key=lambda judged: judged.uses,
                reverse=True,
            )
            chosen.append((best, tuple(judged.change.tried for judged in alike)))
    chosen.sort(key=lambda entry: (len(entry[0].places), entry[0].uses), reverse=True)
    return [
        (best, others)
        for best, others in chosen
        if not any(best.places < other.places for other, _ in chosen)
    ]


class _Search:
    """Judges changes of one paper."""

    def __init__(self, paper: Paper, faulty: dict[Place, list[Finding]]) -> None:
        self.paper, self.places = paper, Places()
        self.before = self.places.states(paper)
        self.totals = self.places.totals(paper) if any(w == "totals" for w, _ in faulty) else {}
        stand = self.before | self.totals
        # a fault that shows in a proof only is not explained by a change that leaves its place alone
        self.faulty = {
            place: faults
            for place, faults in faulty.items()
            if place in stand and not explained(faults, stand[place])
        }
        longest = {("vector", row.where) for row in paper.rows if row.of}
        self.longest = {place: faulty[place] for place in longest & set(faulty)}

    def judged(self, changes: Iterable[Change]) -> list[_Judged]:
        """Keep the changes that explain something."""
        return [kept for change in changes if (kept := self._judge(change)) is not None]

    def dh_judged(self) -> list[_Judged]:
        """Keep the readings of the DH table that explain something, or come much nearer to the points."""
        readings = dh_readings(self.paper)
        found = [kept for cost, change in readings if (kept := self._judge(change, cost)) is not None]
        if found or not readings:
            return found
        misses = [largest_miss(change.paper) for _, change in readings]
        enough = _AS_NEAR * min(misses)
        cost, change = next(r for r, miss in zip(readings, misses, strict=True) if miss <= enough)
        if by_chance(self.paper, change.paper) or self._spoilt(self.places.states(change.paper)):
            return []
        return [_Judged(change, frozenset(), (), cost)]

    def hint(self, best: _Judged, others: tuple[str, ...], of: int) -> Hint:
        """Write a change as a hint."""
        remark, change = "", best.change
        if change.kind == "dh":
            was, remains = (1e3 * largest_miss(paper) for paper in (self.paper, change.paper))
            remark = f"the largest miss of a point falls from {number(was)} mm to {number(remains)} mm"
        elif best.uses:
            stretch = " to ".join(dict.fromkeys(number(use) for use in (best.uses[0], best.uses[-1])))
            remark = f"the stretch of the motions there is then {stretch}"
        faulty = self.faulty | self.longest
        after = self.places.states(change.paper, longest=bool(self.longest))
        if self.totals:
            after |= self.places.totals(change.paper)
        places = best.places | {
            place for place, faults in faulty.items() if explained(faults, after[place])
        }
        removes = sum(len(faulty[place]) for place in places)
        where = tuple(dict.fromkeys(where for _, where in sorted(places)))
        return Hint(change.kind, change.tried, where, removes, of, others, remark)

    def _judge(self, change: Change, cost: int = 1) -> _Judged | None:
        after = self.places.states(change.paper)
        if self._spoilt(after):
            return None
        if self.totals:
            after = after | self._totals(change)
        found = {
            place
            for place, faults in self.faulty.items()
            if place in after and explained(faults, after[place])
        }
        if not found:
            return None
        uses = {
            what: [after[place].use for place in found if place[0] == what]
            for what in {what for what, _ in found} & set(_LEAST_USE)
        }
        points = any(what == "point" for what, _ in found)
        if not points and any(max(use) < _LEAST_USE[what] for what, use in uses.items()):
            return None
        if change.whole and not self._all_explained(after, found):
            return None
        motions = uses.get("vector", []) + uses.get("totals", [])
        return _Judged(change, frozenset(found), tuple(sorted(motions)), cost)

    def _spoilt(self, after: dict[Place, State]) -> bool:
        """Whether a change makes a sound place faulty, or a motion slow that used a limit fully."""
        return any(
            self.before[place].sound
            and place not in self.faulty
            and (
                not state.sound
                or any(
                    now < FULL <= was
                    for now, was in zip(state.used, self.before[place].used, strict=False)
                )
            )
            for place, state in after.items()
        )

    def _totals(self, change: Change) -> dict[Place, State]:
        """Totals after a change; signs and orders are many and leave them to the time vectors."""
        return {} if change.kind in ("sign", "swap") else self.places.totals(change.paper)

    def _all_explained(self, after: dict[Place, State], found: set[Place]) -> bool:
        """Whether a change of many numbers explains every faulty vector that it touches."""
        return all(
            place in found
            for place in self.faulty
            if place[0] == "vector" and self._touched(place, after)
        )

    def _touched(self, place: Place, after: dict[Place, State]) -> bool:
        return after[place] != self.before[place] or not after[place].sound
