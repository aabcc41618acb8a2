"""The report of a suite: what each swarm reaches over all instances, and what the instances are like."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from compare.benchmark.ladders import LadderRecord
from compare.benchmark.records.rejudge import judged_again
from compare.benchmark.records.store import Settings, Store
from compare.benchmark.suite.features import Features
from compare.benchmark.suite.instance import Instance, Split
from compare.benchmark.summaries import Summary, median, summaries
from compare.files import write_text
from compare.report.frame import TABLES, environment
from compare.report.overview import shade
from compare.report.page import faults_of, swarms_in
from compare.report.words import percent
from metaheuristics import GROUPS

LEVELS = (1e-2, 1e-4, 1e-6)  # gaps whose share of instances is shown


@dataclass(frozen=True)
class Standing:
    """One swarm in one variant over the instances of a split.

    Attributes
    ----------
    instances : int
        Instances that count: those with an optimum.
    missing : tuple of str
        Instances without a row of this swarm; then nothing else is said.
    gap : float or None
        Median over instances of the median gap over seeds, a run without a verified motion counted as
        infinitely bad; None if more than half of them are.
    reached : tuple of int
        Instances whose median gap is at most each of ``LEVELS``.
    unsolved : int
        Runs without a verified motion.
    """

    instances: int
    missing: tuple[str, ...]
    gap: float | None = None
    reached: tuple[int, ...] = ()
    unsolved: int = 0


def standing(
    found: dict[tuple[str, str, str], Summary], cases: Sequence[str], key: tuple[str, str]
) -> Standing:
    """Summarise a swarm over instances. No average is taken over unequal sets.

    Parameters
    ----------
    found : dict of (case, variant, swarm) to Summary
    cases : sequence of str
        The instances.
    key : (variant, swarm)

    Returns
    -------
    Standing
    """
    missing = tuple(case for case in cases if (case, *key) not in found)
    if missing or not cases:
        return Standing(len(cases), missing)
    mine = [found[(case, *key)] for case in cases]
    gaps = [float("inf") if s.gap_of_most is None else s.gap_of_most for s in mine]
    middle = median(gaps)
    return Standing(
        len(cases),
        (),
        middle if middle is not None and middle < float("inf") else None,
        tuple(sum(gap <= level for gap in gaps) for level in LEVELS),
        sum(s.unsolved for s in mine),
    )


def answer(standings: dict[tuple[Split, str, str], Standing]) -> str:
    """Say which swarm is nearest to the optimum, on the held-out instances if there are some.

    Parameters
    ----------
    standings : dict of (split, variant, swarm) to Standing

    Returns
    -------
    str
    """
    for split in (Split.held_out, Split.open):
        found = [
            (standing.gap, swarm, variant, standing.instances)
            for (where, variant, swarm), standing in standings.items()
            if where is split and standing.gap is not None
        ]
        if found:
            gap, swarm, variant, count = min(found)
            over = f"{count} {split} instance{'s' if count > 1 else ''}"
            best = f"{swarm} ({variant} coding) is nearest to the optimum"
            return f"{best} over {over}: median gap {percent(gap)}"
    return "No swarm has a verified motion on half of the instances"


def render_suite(store: Store, instances: Sequence[Instance], settings: Settings) -> Path:
    """Write index.html and report.md of a suite, from the store alone.

    Parameters
    ----------
    store : Store
    instances : sequence of Instance
    settings : Settings
        What was asked for.

    Returns
    -------
    Path
        The page.
    """
    ladders, described = store.ladders(), store.instances()
    rows = judged_again(store.rows(), {one.name: one.problem for one in instances}, ladders)
    found = summaries(rows, allow=settings.allow)
    variants = list(dict.fromkeys(row.variant for row in rows))
    swarms = swarms_in(rows)
    splits = {split: _solved(instances, ladders, split) for split in (Split.held_out, Split.open)}
    standings = {
        (split, variant, swarm): standing(found, cases, (variant, swarm))
        for split, cases in splits.items()
        for variant in variants
        for swarm in swarms
    }
    context = {
        "settings": settings,
        "levels": LEVELS,
        "variants": variants,
        "splits": {split: cases for split, cases in splits.items() if cases},
        "standings": standings,
        "answer": answer(standings),
        "swarms": swarms,
        "groups": {
            title: members
            for group, title in GROUPS.items()
            if (members := [name for name, entry in swarms.items() if entry.group == group])
        },
        "instances": [_line(one, ladders[one.name], described[one.name]) for one in instances],
        "rows": len(rows),
        "shade": shade,
        "scripts": TABLES,
        "faults": faults_of(rows),
        "machine": rows[0].machine if rows else "",
        "versions": rows[0].versions if rows else "",
    }
    pages = environment(store.folder)
    for source, name in (("suite.md.j2", "report.md"), ("suite.html.j2", "index.html")):
        write_text(store.folder / name, pages.get_template(source).render(context))
    return store.folder / "index.html"


def _solved(instances: Sequence[Instance], ladders: dict[str, LadderRecord], split: Split) -> list[str]:
    """Names of the instances of a split that have an optimum."""
    return [
        one.name
        for one in instances
        if one.split is split and ladders[one.name]["ladder"]["family"]["seconds"] is not None
    ]


def _line(one: Instance, ladder: LadderRecord, described: dict[str, Any]) -> dict[str, Any]:
    """What the table of instances says of one."""
    upper, lower = (ladder["ladder"][key]["seconds"] for key in ("family", "family_lower"))
    return {
        "name": one.name,
        "digest": one.digest,
        "split": one.split,
        "origin": one.origin,
        "family": one.problem.family,
        "optimum": upper,
        "bound": lower,
        "proved": upper / lower - 1.0 if upper and lower else None,
        "note": ladder["ladder"]["family_lower"]["note"],
        **dict.fromkeys((field.name for field in fields(Features)), "–"),
        **described.get("features", {}),
    }
