"""The bounds, references and best motions of one problem on one time axis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rows import BoundProof, Row
from compare.benchmark.summaries import best_claim, best_row, bound_of
from formulations import RUNGS

# what the picture shows at first; the others on demand
_FIRST = {"free_form_lower", "free_form", "family", "ruckig_stop_and_go"}


def ladder_chart(
    ladder: LadderRecord, rows: Sequence[Row] = (), more: Sequence[dict[str, Any]] = ()
) -> dict[str, Any]:
    """Return the lines of the ladder, shortest time first.

    Parameters
    ----------
    ladder : LadderRecord
    rows : sequence of Row
        Runs on this problem; the best claim and the best swarm are shown.
    more : sequence of dict
        Further lines: ``name``, ``seconds`` [s], ``kind``, ``first``.

    Returns
    -------
    dict
        ``lines``; ``barrier`` [s], which no motion beats; ``optimum`` [s] of the family or None, and whether
        it is ``proved``.
    """
    lines = [
        _line(RUNGS[key].name, rung["seconds"], rung["kind"], key in _FIRST)
        for key, rung in ladder["ladder"].items()
        if rung["seconds"] is not None and key != "family_lower"
    ]
    lines += _swarms(rows)
    lines += more
    lines.sort(key=lambda line: line["seconds"])
    barrier = ladder["ladder"]["free_form_lower"]["seconds"]
    optimum = ladder["ladder"]["family"]["seconds"]
    proved = bound_of(ladder)[1] is BoundProof.certified
    said = [f"no motion is faster than {barrier:.4f} s"] if barrier else []
    fastest = ladder["ladder"]["free_form"]["seconds"]
    said += [f"the fastest motion known takes {fastest:.4f} s"] if fastest else []
    if optimum is not None:
        said.append(f"the best spline {optimum:.4f} s ({'proved' if proved else 'not proved'})")
    said += [
        f"{line['name']} {line['seconds']:.4f} s"
        for line in lines
        if line["kind"] in ("broken", "swarm", "given", "faulty")
    ]
    return {
        "lines": lines,
        "barrier": barrier,
        "optimum": optimum,
        "proved": proved,
        "alt": f"{'; '.join(said)}.",
    }


def _line(name: str, seconds: float | None, kind: str, first: bool) -> dict[str, Any]:
    return {"name": name, "seconds": seconds, "kind": kind, "first": first}


def _swarms(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """The best claim in the papers' coding, what is left of it, and the best swarm of all."""
    lines = []
    claim = best_claim(rows)
    if claim is not None:
        broken = not claim.keeps_limits
        name = f"best claim in the papers' coding ({claim.swarm})"
        if broken:
            lines.append(_line(f"{name}: breaks limits", claim.claimed, "broken", True))
            name = f"that claim, slowed down by {claim.stretch:.4g}"
        lines.append(_line(name, claim.seconds, "swarm", True))
    best = best_row(rows, variant="stretched")
    if best is not None:
        lines.append(_line(f"best swarm, exact stretch ({best.swarm})", best.seconds, "swarm", True))
    return lines
