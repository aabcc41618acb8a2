"""The grading of one swarm: everything that is said of it, from stored runs alone."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from compare.benchmark.grade import Trace
from compare.benchmark.protocol import Coordinates
from compare.benchmark.records.rows import BoundProof, Row, RunKey
from compare.grading.cells import Cell, CellKey, cells_of
from compare.grading.contest import Contest, contest
from compare.grading.failures import Failure, failures
from compare.grading.protocol import GradingProtocol
from compare.grading.reasons import Features, Reason, reasons
from compare.grading.standing import Ranking, printed, standing
from compare.grading.words import seeds_sentence, verdict_sentence
from compare.grading.zero import DrawnToZero, drawn_to_zero


@dataclass(frozen=True, eq=False)
class Grading:
    """What is said of a swarm.

    Attributes
    ----------
    protocol : GradingProtocol
        What was run.
    called, against : str
        The swarm and the other one, as the user named them.
    contest : Contest
        The swarm against the other one.
    standing : Ranking
        Among all swarms.
    zero : DrawnToZero or None
        Whether it is drawn to zero; None if that was not tested.
    reasons : list of Reason
        Features that go with its advantage.
    failures : list of Failure
        Of all swarms.
    cells, even : dict of (instance, swarm, coordinates) to Cell
        All runs; and of each swarm in the printed coordinates the seeds that all of them have.
    kind : str
        What the instances are called.
    left_out : dict of str to str
        Instances without a verified optimum, on which nobody was run, with the reason.
    """

    protocol: GradingProtocol
    called: str
    against: str
    contest: Contest
    standing: Ranking
    zero: DrawnToZero | None
    reasons: list[Reason]
    failures: list[Failure]
    cells: dict[CellKey, Cell]
    even: dict[CellKey, Cell]
    kind: str
    left_out: dict[str, str]

    @property
    def sentence(self) -> str:
        """The verdict, as the first sentence of the page."""
        return verdict_sentence(
            self.called,
            self.against,
            self.contest,
            self.standing,
            name=self.protocol.swarm,
            drawn=self.zero is not None and self.zero.drawn,
            failed=sum(f.count for f in self.failures if f.swarm == self.protocol.swarm),
            kind=self.kind,
        )

    @property
    def certified(self) -> int:
        """Number of instances whose gaps are measured against a certified bound."""
        mine = printed(self.cells, self.protocol.swarm).values()
        return sum(cell.rows[0].proof is BoundProof.certified for cell in mine)

    def to_json(self) -> dict[str, Any]:
        """Plain data, ready for strict JSON: a number that is not finite is None."""
        found, (wins, losses, ties) = self.contest, self.contest.counts
        row = next(iter(self.cells.values())).rows[0]
        plain = {
            "swarm": self.called,
            "against": self.against,
            "verdict": found.verdict.value,
            "wins": wins,
            "losses": losses,
            "ties": ties,
            "p": found.effect.p,
            "a12": found.effect.mean,
            "a12_interval": [found.effect.low, found.effect.high],
            "sentence": self.sentence,
            "instances": len(found.duels),
            "seeds": self.protocol.seeds,
            "standing_seeds": self.protocol.even_seeds,
            "budget": self.protocol.budget,
            "certified": self.certified,
            "coding": self.protocol.coding,
            "median_gap": dict(zip(("swarm", "against"), found.gaps, strict=True)),
            "practically_equal": asdict(found.practical),
            "seeds_needed": {**asdict(found.needed), "sentence": seeds_sentence(found)},
            "drawn_to_zero": None if self.zero is None else self.zero.drawn,
            "zero": None
            if self.zero is None
            else {**asdict(self.zero), "sentence": self.zero.sentence},
            "standing": [asdict(place) for place in self.standing.places],
            "friedman_p": self.standing.ranks.p,
            "critical_difference": self.standing.ranks.difference,
            "features": [asdict(reason) for reason in self.reasons],
            "per_instance": [
                {
                    "instance": duel.instance,
                    "outcome": duel.outcome.value,
                    "a12": duel.pair.a12,
                    "a12_interval": [duel.pair.low, duel.pair.high],
                    "p": duel.pair.p,
                    "p_holm": duel.p,
                    "test": duel.pair.method,
                    "gap": duel.gap,
                    "gap_against": duel.other_gap,
                }
                for duel in found.duels
            ],
            "failures": [asdict(failure) for failure in self.failures],
            "left_out": self.left_out,
            "machine": row.machine,
            "versions": row.versions,
        }
        return _finite(plain)  # type: ignore[no-any-return]


def graded(
    protocol: GradingProtocol,
    rows: Sequence[Row],
    traces: Mapping[RunKey, list[Trace]],
    *,
    proved: Mapping[str, float],
    features: Mapping[str, Features],
    called: tuple[str, str] | None = None,
    kind: str = "held-out instances",
    left_out: Mapping[str, str] | None = None,
) -> Grading:
    """Grade a swarm from the rows of its protocol.

    Parameters
    ----------
    protocol : GradingProtocol
    rows : sequence of Row
        Of all its runs.
    traces : mapping of RunKey to list of Trace
    proved : mapping of str to float
        By instance, the gap between certified bound and verified optimum.
    features : mapping of str to mapping of str to float
        By instance.
    called : (str, str), optional
        How the user named the swarm and the other one.
    kind : str
        What the instances are called.
    left_out : mapping of str to str, optional
        Instances that were left out, with the reason.

    Returns
    -------
    Grading

    Raises
    ------
    MissingCellError
        If runs are missing; the message names swarm and instance.
    """
    cells = cells_of(rows, traces, proved)
    mine = printed(cells, protocol.swarm)
    others = [name for name in protocol.swarms if name != protocol.swarm]
    even = {
        key: cell.first(protocol.even_seeds)
        for key, cell in cells.items()
        if key[2] is Coordinates.printed
    }
    found = contest(mine, printed(cells, protocol.against))
    contests = {
        name: found
        if name == protocol.against
        else contest(printed(even, protocol.swarm), printed(even, name))
        for name in others
    }
    moved = [case for case in mine if (case, protocol.swarm, "offset") in cells]
    return Grading(
        protocol,
        *(called or (protocol.swarm, protocol.against)),
        found,
        standing(even, protocol.swarms, contests),
        drawn_to_zero(cells, protocol.swarm, moved) if moved else None,
        reasons(found, features),
        failures(rows),
        cells,
        even,
        kind,
        dict(left_out or {}),
    )


def _finite(value: Any) -> Any:
    """The same with None for each number that is not finite, and plain containers."""
    if isinstance(value, dict):
        return {str(key): _finite(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
