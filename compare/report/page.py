"""The report of a comparison, rendered from its store alone."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypedDict

from compare.audit import chapter
from compare.audit.paper import load_papers
from compare.benchmark.known_times import key_of_paper
from compare.benchmark.ladders import LadderRecord
from compare.benchmark.objective import CODINGS
from compare.benchmark.protocol import Coordinates, Track
from compare.benchmark.records.rejudge import judged_again
from compare.benchmark.records.rows import Row, RowStatus
from compare.benchmark.records.store import Settings, Store
from compare.benchmark.summaries import summaries
from compare.engines import Engine, each
from compare.files import write_text
from compare.plain_data import read_json
from compare.report.answers import answers, headline
from compare.report.charts.arms import arms_chart
from compare.report.charts.case import charts_of_case
from compare.report.figures.case import draw_case
from compare.report.frame import CHARTS, environment
from compare.report.glossary import GLOSSARY
from compare.report.overview import cells, columns, proof_words, to_best_known
from compare.report.papers_at_a_glance import papers_at_a_glance
from compare.studies.study import STUDIES
from compare.studies.zones import ZoneSaving
from formulations import RUNGS, Problem
from metaheuristics import ALGORITHMS, GROUPS, NOT_REPRODUCIBLE

FIGURES = {
    "ladder": "Every bound and the best swarm results on one time axis.",
    "gaps": "Gap of every seed. Hollow marks: the claimed motion breaks its limits.",
    "motion": "The best motion with its limits, and the best claim in the papers' coding (red).",
    "split": "Where the time goes, from the certified bound on every motion up to the motion of a swarm.",
    "convergence": "Gap against evaluations.",
}
"""Pictures of each case, as files beside the page and in report.md."""

TRACKS: dict[Track, str] = {
    Track.equal: "",
    Track.paper: "by the papers' own protocol each joint has the whole budget for itself",
    Track.tuned: "constants tuned on the open instances",
}

LIMITATIONS = [
    "Gaps are measured against the best motion of the family that is known: of many local solves of the exact "
    "NLP and of all runs. How far it can lie above the optimum stands beside it: bounds of B-splines are "
    "proved to 0.1 %, those of the other families to 1e-7.",
    "The papers print no search box (but Lu 2024) and no way to treat velocities at its walls: the box, "
    "the clamp and every other reading are stated in compare/benchmark/objective.py and metaheuristics.",
    "The limits of bagging and cobot are assumed, as their files say: those papers print none.",
    "The waypoints of ur5 are used as printed; its Cartesian points are out of the arm's reach.",
    "TOPP-RA's times are those of a discretised path, with the stated grid error, and have no jerk "
    "limit. They are references, not bounds.",
    "Only joint limits count: no torques, no collisions, no Cartesian path.",
    "Every stored row was judged again from its durations when this report was drawn. The claimed time of "
    "a motion that breaks its limits cannot be judged again, as the searches of the single joints are not "
    "stored.",
]


def render(pool: Engine, folder: Path, problems: dict[str, Problem], settings: Settings) -> Path:
    """Draw all figures and write index.html and report.md, from the store alone.

    Parameters
    ----------
    pool : Engine
    folder : Path
        Folder of the store and of the report.
    problems : dict of str to Problem
        By case.
    settings : Settings
        What was asked for.

    Returns
    -------
    Path
        The page.
    """
    store = Store(folder)
    ladders = store.ladders()
    rows, best = to_best_known(judged_again(store.rows(), problems, ladders), ladders)
    charts, calls = {}, []
    for case, problem in problems.items():
        mine = [row for row in rows if row.case == case]
        held = {r.key for r in mine if r.status is not RowStatus.contradicted}
        kept = {key: found for key, found in store.traces(case) if key in held}
        charts[case] = charts_of_case(problem, ladders[case], mine, kept)
        calls.append((folder, case, problem, ladders[case], mine, kept))
    for _ in each(pool, "figures", draw_case, calls):
        pass
    context = _context(rows, ladders, problems, settings) | {"best": best, "charts": charts}
    context["studies"] = {
        name: study for name, study in STUDIES.items() if (folder / "figures" / f"{name}.svg").exists()
    }
    context |= papers_context(store, folder, context["cases"])
    saved = folder / "zones.json"
    context["zones"] = read_json(saved, _Zones, "a study")["summary"] if saved.exists() else []
    context["answers"] = answers(
        context["summaries"], rows, ladders, context["papers"], context["zones"]
    )
    charts["all"] = {"arms": arms_chart(context["cases"], ladders, rows, context["papers"], best)}
    context["proofs"] = {case: proof_words(ladders[case], best[case]) for case in context["cases"]}
    bias = folder / "bias.json"
    context["bias"] = read_json(bias, _Bias, "a study")["summary"] if bias.exists() else {}
    context["figures"] = {
        case: {name: (f"figures/{case}-{name}", caption) for name, caption in FIGURES.items()}
        for case in problems
    }
    context["files"] = _files
    pages = environment(folder)
    for name in ("report.md", "index.html"):
        write_text(folder / name, pages.get_template(f"{name}.j2").render(context))
    return folder / "index.html"


def _files(case: str, figure: str) -> list[tuple[str, str]]:
    """Links to a figure drawn for papers."""
    return [("SVG", f"figures/{case}-{figure}.svg")]


def papers_context(store: Store, folder: Path, cases: list[str]) -> dict[str, Any]:
    """Return what the report says of the papers; empty where nothing was made.

    Parameters
    ----------
    store : Store
    folder : Path
        Folder of the report.
    cases : list of str
        The cases of the report.

    Returns
    -------
    dict
        For the templates: ``papers``, ``pages``, ``authors``, ``chapters``, ``known_times``, ``arms``.
    """
    audits, known = store.audits(), store.known_times()
    written = {case: f"papers/{key_of_paper(case)}.html" for case in cases}
    entries = chapter(data for stored in audits.values() for data in stored["audits"])
    glance = papers_at_a_glance(audits, known, store.ladders())
    pages = {case: page for case, page in written.items() if (folder / page).exists()}
    return {
        "papers": [paper for paper in glance if paper.case in cases],
        "pages": pages,
        "authors": {case: load_papers(Path(page).stem)[0].author_year for case, page in pages.items()},
        "chapters": {entry["name"]: [entry] for entry in entries},
        "known_times": known,
        "arms": {
            c: [("as a moving SVG", f"figures/{c}-arm.svg")]
            for c in cases
            if (folder / f"figures/{c}-arm.svg").exists()
        },
    }


def _context(
    rows: list[Row],
    ladders: dict[str, LadderRecord],
    problems: dict[str, Problem],
    settings: Settings,
) -> dict[str, Any]:
    """What the templates say of the swarms."""
    found = summaries(rows, allow=settings.allow)
    cases = [case for case in problems if case in ladders]
    swarms = swarms_in(rows)
    contradicted = [row for row in rows if row.status is RowStatus.contradicted]
    return {
        "cases": cases,
        "problems": problems,
        "codings": {row.variant: _rules(row) for row in rows},
        "columns": columns(rows, cases),
        "cells": cells(found, rows),
        "swarms": swarms,
        "groups": {
            title: members
            for group, title in GROUPS.items()
            if (members := [name for name, entry in swarms.items() if entry.group == group])
        },
        "lost": NOT_REPRODUCIBLE,
        "summaries": found,
        "ladders": ladders,
        "meanings": {key: rung.meaning for key, rung in RUNGS.items()},
        "headlines": {case: headline(case, ladders[case], rows) for case in cases},
        "rows": len(rows),
        "faults": faults_of(rows),
        "contradicted": contradicted,
        "settings": settings,
        "machine": rows[0].machine if rows else "",
        "versions": rows[0].versions if rows else "",
        "limitations": LIMITATIONS,
        "glossary": GLOSSARY,
        "scripts": CHARTS,
    }


def _rules(row: Row) -> str:
    """What the variant of a row means."""
    said = (
        CODINGS[row.coding],
        TRACKS[row.track],
        "" if row.coordinates is Coordinates.printed else f"coordinates {row.coordinates}",
    )
    return "; ".join(part for part in said if part)


@dataclass(frozen=True)
class _Swarm:
    """What the report says of a swarm. Of a plug-in it says what the row knows: no code is loaded."""

    title: str
    source: str
    parameters: dict[str, Any]
    library: str
    isolated: bool
    group: str = "rivals"
    shortfall: str = ""

    @staticmethod
    def of(row: Row) -> _Swarm:
        name, library, apart = row.swarm, row.library, row.isolated
        if name in ALGORITHMS:
            a = ALGORITHMS[name]
            return _Swarm(a.title, a.source, a.parameters, library, apart, a.group, a.shortfall)
        place, _, what = name.partition(":")
        title = f"{what} of {place}" if library else "plugged in"
        return _Swarm(title, place, _parameters(row), library, apart)


def swarms_in(rows: Iterable[Row]) -> dict[str, _Swarm]:
    """Describe the swarms of rows.

    Parameters
    ----------
    rows : iterable of Row

    Returns
    -------
    dict of str to object
        By name, in the order of tables; each has a title, a source, parameters and a group.
    """
    ran = {row.swarm: row for row in rows}
    order = [name for name in ALGORITHMS if name in ran]
    order += [name for name in ran if name not in ALGORITHMS]
    return {name: _Swarm.of(ran[name]) for name in order}


class _Bias(TypedDict):
    """What the report shows of a study of bias: by swarm and problem."""

    summary: dict[str, dict[str, float | None]]


class _Zones(TypedDict):
    """What the report shows of the study of zones: a ``ZoneSaving`` each."""

    summary: list[ZoneSaving]


def _parameters(row: Row) -> dict[str, Any]:
    """Parameters that a row states; none if they are not what `grade` writes."""
    try:
        found = json.loads(row.parameters)
    except (ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def faults_of(rows: Iterable[Row]) -> list[tuple[str, int, str]]:
    """Count every status but ok.

    Parameters
    ----------
    rows : iterable of Row

    Returns
    -------
    list of (str, int, str)
        Status, how often it stands, and one of its reasons.
    """
    found: dict[RowStatus, list[Row]] = {}
    for row in rows:
        if row.status is not RowStatus.ok:
            found.setdefault(row.status, []).append(row)
    return [(status, len(group), group[0].note) for status, group in sorted(found.items())]
