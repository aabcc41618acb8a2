"""The chapters of papers, ``view``, ``grade``, ``rivals`` and the suite in a browser, as the report."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from report_in_browser import JOINTS, PLANTED, Open
from stored_items import stored

from compare.__main__ import main
from compare.benchmark.records.provenance import machine, versions_text
from compare.files import write_json
from compare.papers import ITEMS, page
from compare.papers.shelf import OK

ASKED = """\
unit = "deg"
arm = "ur5"
waypoints = [[0, -60, 60, 0, 30, 0], [35, -40, 35, 10, 5, 25], [65, -70, 75, -15, 10, 5]]

[limits]
velocity = 180
acceleration = 600
jerk = 6000

[[conditions.segment]]
from = 1
limits = {velocity = 60}
"""
SMALL = ["--seeds", "4", "--budget", "60", "--jobs", "1"]


def chapter(folder: Path) -> Path:
    """The chapter of Li 2022, of its stored numbers."""
    for item in ITEMS["bagging"]:
        made = {
            "full": False, "status": OK, "note": "", "seconds": 1.0, "versions": versions_text(),
            "machine": machine(), "data": stored("bagging", item.key),
        }  # fmt: skip
        path = folder / "papers" / "bagging" / f"{item.key}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        write_json(path, made)
    assert page.render(str(folder), "bagging", ITEMS["bagging"]).faults == {}
    return folder / "papers" / "bagging.html"


def viewed(folder: Path) -> Path:
    """A problem whose names are HTML, and a motion that misses its waypoints and is too fast."""
    (folder / "planted.toml").write_text(PLANTED, "utf-8")
    head = ",".join(f'"position_{name.replace(chr(34), 2 * chr(34))}"' for name in JOINTS)
    rows = "0,0,0.5\n0.4,0.6,0.1\n0.8,1.4,0.1\n"
    (folder / "bad.csv").write_text(f"time,{head}\n{rows}", "utf-8")
    given = ["view", str(folder / "planted.toml"), str(folder / "bad.csv"), "--no-open"]
    rungs = "free_form,free_form_lower,family"
    assert main([*given, "--rungs", rungs, "--out", str(folder / "view.html")]) == 3
    return folder / "view.html"


def graded(folder: Path) -> Path:
    """One swarm against another on two arms."""
    assert main(["versus", "pso", "random", "--cases", "sr4c,cobot", *SMALL, "--out", str(folder)]) == 0
    return folder / "versus.html"


def suite(folder: Path) -> Path:
    """Two instances of the suite."""
    given = ["all", "--instances", "2", "--swarms", "pso,random", *SMALL, "--out", str(folder)]
    assert main(given) == 0
    return folder / "index.html"


def demanding(folder: Path) -> Path:
    """A problem with zones, a window, a wait, a slow segment and a slow tool."""
    asked = [
        "--zone",
        "5",
        "--zone",
        "1=10",
        "--window",
        "1=1:1.5",
        "--wait",
        "1=0.3",
        "--tool-speed",
        "0.5",
    ]
    (folder / "asked.toml").write_text(ASKED, "utf-8")
    given = ["view", str(folder / "asked.toml"), *asked, "--rungs", "displacement", "--no-open"]
    assert main([*given, "--time-limit", "20", "--out", str(folder / "view.html")]) == 0
    return folder / "view.html"


def rivals(folder: Path) -> Path:
    """The fastest motion beside a program that is there, one that may not run, and toppra."""
    page = str(folder / "rivals.html")
    assert (
        main(
            ["rivals", "sr4c", "--rivals", "ruckig,jacobi,toppra", "--page", page, "--out", str(folder)]
        )
        == 0
    )
    return folder / "rivals.html"


@pytest.mark.long
@pytest.mark.parametrize(
    "make", [chapter, viewed, demanding, graded, suite, rivals], ids=lambda make: make.__name__
)
def test_the_page_reads_well_in_both_themes_and_widths(
    make: Callable[[Path], Path], open_page: Open, tmp_path: Path
) -> None:
    from axe_playwright_python.sync_playwright import Axe

    path = make(tmp_path)
    assert path.stat().st_size < 4_000_000
    for scheme in ("light", "dark"):
        shown = open_page(path, color_scheme=scheme)
        shown.draw_everything()
        violations = Axe().run(shown.page).response["violations"]
        assert [
            (one["id"], [node["html"][:200] for node in one["nodes"][:3]]) for one in violations
        ] == []
        for width in (1300, 420):
            shown.page.set_viewport_size({"width": width, "height": 900})
            shown.page.wait_for_timeout(200)
            shown.draw_everything()
            assert shown.page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
            assert shown.page.evaluate("() => inPage.clipped()") == []
            assert shown.page.evaluate("() => inPage.cutInCharts()") == []
        assert shown.faults == []
