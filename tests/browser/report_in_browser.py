"""A small report with planted names, and pages that show it in Debian's Chromium and note every fault."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from compare.benchmark.grade import Run, grade
from compare.benchmark.known_times import key_of_paper
from compare.benchmark.ladders import ladder_record
from compare.benchmark.records.rows import Row, RowStatus
from compare.benchmark.records.settings import Settings
from compare.benchmark.records.store import Store
from compare.benchmark.run import audits, tabulate_known_times
from compare.benchmark.summaries import bound_of
from compare.engines import ThisProcess
from compare.report import page as report_page
from compare.studies import study, zones
from formulations import Problem, ladder, load

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

NAMES = ("chromium", "chromium-browser", "google-chrome")
TITLE = "<script>alert('title')</script> \"quoted\" & 'single' <img src=x onerror=alert(1)>"
SOURCE = "<b>bold</b> </script><script>alert('source')</script>"
JOINTS = ("<script>alert('joint')</script>", "b\"'</td><b>")
SWARM = "<script>alert('swarm')</script><b>\"'"  # a plug-in can be called anything
PLANTED = f"""\
name = "planted"
title = '''{TITLE}'''
source = '''{SOURCE}'''
joints = ['''{JOINTS[0]}''', '''{JOINTS[1]}''']
unit = "rad"
family = "3-5-3"
waypoints = [[0.0, 0.5], [0.6, 0.2], [1.1, -0.4], [1.4, 0.1]]

[limits]
unit = "rad"
velocity = [1.5, 2.0]
acceleration = [2.0, 3.0]
jerk = [8.0, 20.0]
"""
SWARMS = ("pso", "whale", "random")
SEEDS = (0, 1)


@dataclass(frozen=True)
class SmallReport:
    """A report, and what it was made from."""

    page: Path
    problems: dict[str, Problem]
    ladders: dict[str, Any]
    rows: list[Row]


@pytest.fixture(scope="session")
def small_report(chromium: str, tmp_path_factory: pytest.TempPathFactory) -> SmallReport:
    """The report of an arm with a paper, and of a problem whose names are HTML."""
    folder = tmp_path_factory.mktemp("browser")
    (folder / "planted.toml").write_text(PLANTED, "utf-8")
    problems = {"cobot": load("cobot"), "planted": load(folder / "planted.toml")}
    store, here = Store(folder), ThisProcess()
    settings = Settings("default", tuple(problems), SEEDS, "60 evaluations")
    store.write_settings(settings)
    for case, problem in problems.items():
        store.write_ladder(case, ladder_record(ladder(problem)))
    audits(here, [key_of_paper("cobot")], store)
    ladders = store.ladders()
    for case, problem in problems.items():
        for coding in ("published", "shared", "stretched"):
            for swarm in SWARMS:
                made = [
                    grade(Run(case, coding, swarm, seed, 60, 10), problem, *bound_of(ladders[case]))
                    for seed in SEEDS
                ]
                store.add_all((_as_shown(one.row), one.traces) for one in made)
    tabulate_known_times(here, problems, store)
    study.run(zones.STUDY, zones.calls(["cobot"], (0.01, 0.1)), folder=folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(report_page, "draw_case", _no_pictures)  # they are tested elsewhere
        page = report_page.render(here, folder, problems, settings)
    return SmallReport(page, problems, ladders, store.rows())


def _no_pictures(*_: object) -> None:
    """Draw nothing."""


def _as_shown(row: Row) -> Row:
    """Give one swarm the planted name; another finds nothing in one column."""
    if row.swarm == "random":
        row = replace(row, swarm=SWARM)
    if row.swarm == "whale" and (row.case, row.coding) == ("cobot", "shared"):
        nothing = dict.fromkeys(("claimed", "keeps_limits", "stretch", "seconds", "gap", "claimed_gap"))
        row = replace(row, status=RowStatus.no_feasible_point, durations=(), worst="", **nothing)
    return row


@pytest.fixture(scope="session")
def chromium() -> str:
    """The browser; the tests are skipped where there is none, and fail where they have to run."""
    found = next(filter(None, map(shutil.which, NAMES)), None)
    if found is None:
        why = f"no browser is installed: none of {', '.join(NAMES)} is on the PATH"
        if os.environ.get("CI") == "true":
            pytest.fail(why)
        pytest.skip(why)
    return found


# not for the session: its event loop would be in the way of every other test that has one
@pytest.fixture(scope="module")
def browser(chromium: str) -> Iterator[Browser]:
    """Chromium, with 3-D drawn in software."""
    from playwright.sync_api import sync_playwright

    flags = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    if getattr(os, "geteuid", lambda: 1)() == 0:
        flags.append("--no-sandbox")
    with sync_playwright() as driver:
        running = driver.chromium.launch(executable_path=chromium, args=flags)
        yield running
        running.close()


@dataclass
class Shown:
    """A page in a browser, and every fault since it was opened."""

    page: Page
    faults: list[str] = field(default_factory=list)

    def figure(self, of: str, kind: str) -> Locator:
        """One chart, scrolled into view and drawn; the part that it stands in is opened."""
        found = self.page.locator(f'figure.chart[data-of="{of}"][data-kind="{kind}"]')
        found.evaluate("(f) => inPage.open(f)")
        found.scroll_into_view_if_needed()
        self.page.wait_for_selector(f'figure[data-of="{of}"][data-kind="{kind}"][data-drawn]')
        return found

    def drawn(self, of: str, kind: str) -> dict[str, Any]:
        """What plotly holds of a chart: its traces and its layout."""
        found: dict[str, Any] = self.figure(of, kind).evaluate("(f) => inPage.drawn(f)")
        return found

    def draw_everything(self) -> None:
        """Open every part and draw every chart, as scrolling through the page would."""
        self.page.evaluate("() => inPage.drawEverything()")


_OF_SPEED = ("Canvas2D: Multiple readback operations", "[.WebGL-")

Open = Callable[..., Shown]


@pytest.fixture(scope="module")
def open_page(browser: Browser, small_report: SmallReport) -> Iterator[Open]:
    """A function that opens the report, or another page, in a context of its own."""
    contexts = []

    def opened(path: Path | None = None, **how: Any) -> Shown:
        address = (path or small_report.page).as_uri()
        context = browser.new_context(**{"viewport": {"width": 1300, "height": 900}} | how)
        contexts.append(context)
        context.set_default_timeout(20_000)
        page = context.new_page()
        shown = Shown(page)
        page.add_init_script(path=Path(__file__).with_name("in_page.js"))
        page.on("console", lambda said: _note_said(said.type, said.text, shown.faults))
        page.on("pageerror", lambda error: shown.faults.append(str(error)))
        page.on("dialog", lambda box: (shown.faults.append(f"dialog: {box.message}"), box.dismiss()))
        page.on("request", lambda asked: _note(asked.url, address, shown.faults))
        page.goto(address)
        return shown

    yield opened
    for context in contexts:
        context.close()


def _note_said(kind: str, text: str, faults: list[str]) -> None:
    """Errors and warnings are faults; what the browser says of the speed of plotly's 3-D part is not."""
    if kind in ("error", "warning") and not text.startswith(_OF_SPEED):
        faults.append(text)


def _note(url: str, address: str, faults: list[str]) -> None:
    """What stands in the page itself is no request."""
    if url.split("#")[0] != address and not url.startswith(
        ("data:", f"blob:{address[:5]}", "blob:null")
    ):
        faults.append(f"request: {url}")


@pytest.fixture(scope="module")
def light(open_page: Open) -> Shown:
    """The report for a reader whose system is light."""
    return open_page(color_scheme="light")


@pytest.fixture(scope="module")
def dark(open_page: Open) -> Shown:
    """The report for a reader whose system is dark."""
    return open_page(color_scheme="dark")


@pytest.fixture(autouse=True)
def _no_faults(request: pytest.FixtureRequest) -> Iterator[None]:
    """No test leaves an error, a warning or a request behind in the page it used."""
    yield
    for name in ("light", "dark"):
        shown = request.node.funcargs.get(name)
        if isinstance(shown, Shown):
            found, shown.faults[:] = list(shown.faults), []
            assert found == []
