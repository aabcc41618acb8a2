"""The report of a comparison, rendered from its store alone."""

from __future__ import annotations

import base64
import json
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from compare.audit import chapter
from compare.benchmark.honest import key_of_paper
from compare.benchmark.objective import CODINGS
from compare.benchmark.run import each
from compare.benchmark.statistics import Summary, best_claim, best_row, bound_of, summaries
from compare.benchmark.store import Store
from compare.commands import shared as commands
from compare.report.figures import RUNG_NAMES, draw_case
from compare.report.five_papers import five_papers
from compare.studies.study import STUDIES
from formulations import Problem
from formulations.rungs import MEANINGS
from metaheuristics import ALGORITHMS, GROUPS, NOT_REPRODUCIBLE

FIGURES = {
    "ladder": "Every bound and the best swarm results on one time axis.",
    "gaps": "Gap of every seed; hollow marks: the motion, as claimed, breaks its limits.",
    "motion": "The best motion with its limits, and the best claim in the papers' coding (red).",
    "split": "Where the time goes: from the certified bound on every motion up to a swarm's motion.",
    "convergence": "Gap against evaluations.",
}

LIMITATIONS = [
    "Where the first table says proved, gaps are measured against a certified lower bound of the "
    "family; where it says not proved, against the best of many local solves of the exact NLP. Of "
    "B-splines only what holds for every motion is proved: their equations tie each piece to every "
    "duration, and enclosures of that are sharp only on boxes so narrow that there are too many.",
    "The papers print no search box (but 003) and no way to treat velocities at its walls: the box, "
    "the clamp and every other reading are stated in compare/benchmark/objective.py and metaheuristics.",
    "The limits of bagging and cobot are assumed, as their files say: those papers print none.",
    "The waypoints of ur5 are used as printed; its Cartesian points are out of the arm's reach.",
    "TOPP-RA's times are those of a discretised path, with the stated grid error, and have no jerk "
    "limit. They are references, not bounds.",
    "Only joint limits count: no torques, no collisions, no Cartesian path.",
]


def render(
    pool: ProcessPoolExecutor, folder: Path, problems: dict[str, Problem], settings: dict[str, Any]
) -> Path:
    """Figures, index.html, report.md from the store in ``folder``; returns the path of the page."""
    store = Store(folder)
    rows, ladders = store.rows(), store.ladders()
    calls = [(str(folder), case, problem) for case, problem in problems.items()]
    for _ in each(pool, "figures", draw_case, calls):
        pass
    context = _context(rows, ladders, problems, settings)
    context["studies"] = {
        name: study for name, study in STUDIES.items() if (folder / "figures" / f"{name}.svg").exists()
    }
    context |= of_the_papers(store, folder, context["cases"])
    bias = folder / "bias.json"
    context["bias"] = json.loads(bias.read_text("utf-8"))["summary"] if bias.exists() else {}
    context["figures"] = {
        case: {name: (f"figures/{case}-{name}", caption) for name, caption in FIGURES.items()}
        for case in problems
    }
    pages = environment(folder)
    for name in ("report.md", "index.html"):
        commands.write_text(folder / name, pages.get_template(f"{name}.j2").render(context))
    return folder / "index.html"


def environment(folder: Path) -> jinja2.Environment:
    """The templates of every page, with their filters; ``inline(NAME)`` puts DIR/NAME.svg into a page."""
    made = jinja2.Environment(
        loader=jinja2.PackageLoader("compare.report"),
        autoescape=jinja2.select_autoescape(["html.j2"]),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    made.filters["percent"] = percent
    made.filters["number"] = lambda gap: percent(gap).removesuffix(" %")
    made.filters["seconds"] = lambda seconds: "–" if seconds is None else f"{seconds:.4f}"
    made.globals["inline"] = lambda name: _inline(folder / f"{name}.svg")
    made.globals["shade"] = _shade
    return made


def of_the_papers(store: Store, folder: Path, cases: list[str]) -> dict[str, Any]:
    """What the report says of the papers: audits, honest tables, moving arms; empty if never made."""
    audits, honest = store.audits(), store.honest()
    written = {case: f"papers/{key_of_paper(case)}.html" for case in cases}
    entries = chapter(data for stored in audits.values() for data in stored["audits"])
    return {
        "papers": [row for row in five_papers(audits, honest, store.ladders()) if row.case in cases],
        "pages": {case: page for case, page in written.items() if (folder / page).exists()},
        "chapters": {entry["name"]: [entry] for entry in entries},
        "honest": honest,
        "arms": {c: f"figures/{c}-arm" for c in cases if (folder / f"figures/{c}-arm.svg").exists()},
    }


def percent(gap: float | None) -> str:
    """A gap for people: 8.2 %, 0.013 %, 3e-06 %; anything at rounding is 0 %."""
    if gap is None:
        return "none"
    value = 100.0 * gap
    if abs(value) < 1e-8:
        return "0 %"
    if abs(value) < 1e-3:
        return f"{value:.0e} %".replace("e-0", "e-")
    return f"{value:.2g} %" if abs(value) < 10 else f"{value:.0f} %"


def _context(
    rows: list[dict[str, Any]],
    ladders: dict[str, dict[str, Any]],
    problems: dict[str, Problem],
    settings: dict[str, Any],
) -> dict[str, Any]:
    found = summaries(rows)
    cases = [case for case in problems if case in ladders]
    codings = [c for c in CODINGS if any(row["coding"] == c for row in rows)]
    ran = {row["swarm"]: row["library"] for row in rows}
    order = [name for name in ALGORITHMS if name in ran] + [
        name for name in ran if name not in ALGORITHMS
    ]
    swarms = {name: _Swarm.of(name, ran[name]) for name in order}
    return {
        "cases": cases,
        "problems": problems,
        "codings": {c: CODINGS[c] for c in codings},
        "swarms": swarms,
        "libraries": ran,
        "groups": {
            title: members
            for group, title in GROUPS.items()
            if (members := [name for name, entry in swarms.items() if entry.group == group])
        },
        "lost": NOT_REPRODUCIBLE,
        "summaries": found,
        "ladders": ladders,
        "rungs": RUNG_NAMES,
        "meanings": MEANINGS,
        "bounds": {case: bound_of(ladders[case]) for case in cases},
        "headlines": [_headline(case, ladders[case], rows, found) for case in cases],
        "rows": len(rows),
        "faults": _faults(rows),
        "settings": settings,
        "machine": rows[0]["machine"] if rows else "",
        "versions": rows[0]["versions"] if rows else "",
        "limitations": LIMITATIONS,
    }


@dataclass(frozen=True)
class _Swarm:
    """What the report says of a swarm; of somebody's own only what its rows know: no code is loaded."""

    title: str
    source: str
    parameters: dict[str, Any]
    group: str = "rivals"
    shortfall: str = ""

    @staticmethod
    def of(name: str, library: str) -> _Swarm:
        if name in ALGORITHMS:
            a = ALGORITHMS[name]
            return _Swarm(a.title, a.source, a.parameters, a.group, a.shortfall)
        place, _, what = name.partition(":")
        return _Swarm(f"{what} of {place}" if library else "plugged in", place, {})


def _headline(
    case: str,
    ladder: dict[str, Any],
    rows: list[dict[str, Any]],
    found: dict[tuple[str, str, str], Summary],
) -> dict[str, Any]:
    """One line per case: the optimum, the papers' best claim and what is left of it."""
    mine = [row for row in rows if row["case"] == case]
    published = [s for (c, coding, _), s in found.items() if c == case and coding == "published"]
    gaps = [s.gap for s in published if s.gap is not None]
    return {
        "case": case,
        "optimum": ladder["ladder"]["family"]["seconds"],
        "claim": best_claim(mine),
        "stretched": best_row(mine, coding="stretched"),
        "breaking": sum(s.breaking for s in published),
        "published": sum(s.seeds for s in published),
        "gap": float(np.median(gaps)) if gaps else None,
    }


def _faults(rows: list[dict[str, Any]]) -> list[tuple[str, int, str]]:
    """Every status but ok: how often, and one note."""
    statuses = sorted({row["status"] for row in rows} - {"ok"})
    return [
        (
            status,
            sum(row["status"] == status for row in rows),
            next(row["note"] for row in rows if row["status"] == status),
        )
        for status in statuses
    ]


def _shade(gap: float | None) -> str:
    """CSS class of a gap; five steps that differ in lightness too."""
    if gap is None:
        return "none"
    for name, most in (("g0", 1e-6), ("g1", 1e-4), ("g2", 1e-2), ("g3", 5e-2)):
        if gap <= most:
            return name
    return "g4"


def _inline(path: Path) -> str:
    return "data:image/svg+xml;base64," + base64.b64encode(path.read_bytes()).decode()
