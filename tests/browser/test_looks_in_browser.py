"""How the report looks: two themes, two widths, paper; and what a screen reader is told."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from report_in_browser import Open, Shown

pytestmark = pytest.mark.long

WIDTHS = (1300, 420)
COLOUR = "(element) => { const s = getComputedStyle(element); return [s.color, s.backgroundColor]; }"


def luminance(colour: str) -> float:
    """Relative luminance of ``rgb(r, g, b)`` by WCAG 2."""
    parts = [int(one) / 255.0 for one in re.findall(r"\d+", colour)[:3]]
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def colours(shown: Shown) -> tuple[float, float]:
    """Luminance of the body's text and ground; a chart's words must have the contrast of text."""
    ink, ground = shown.page.locator("body").evaluate(COLOUR)
    figure = shown.figure("cobot", "ladder")
    words = figure.locator(".xtitle").evaluate("(t) => getComputedStyle(t).fill")
    assert contrast(words, ground) >= 4.5
    assert shown.drawn("cobot", "ladder")["layout"]["font"]["color"]
    return luminance(ink), luminance(ground)


def test_the_page_is_as_light_or_dark_as_the_system(light: Shown, dark: Shown) -> None:
    ink, ground = colours(light)
    assert ink < 0.05
    assert ground > 0.9
    ink, ground = colours(dark)
    assert ink > 0.7
    assert ground < 0.05


def test_the_system_changes_its_mind_and_the_page_follows(light: Shown) -> None:
    before = colours(light), light.drawn("all", "arms")["data"][0]["marker"]["color"]
    light.page.emulate_media(color_scheme="dark")
    light.page.wait_for_function("() => document.documentElement.dataset.theme === 'dark'")
    after = colours(light), light.drawn("all", "arms")["data"][0]["marker"]["color"]
    light.page.emulate_media(color_scheme="light")
    light.page.wait_for_function("() => document.documentElement.dataset.theme === 'light'")
    assert after[0][1] < 0.05
    assert after[1] != before[1]
    assert (colours(light), light.drawn("all", "arms")["data"][0]["marker"]["color"]) == before


def test_the_button_changes_the_theme_of_text_and_charts(dark: Shown) -> None:
    button = dark.page.locator("#theme")
    before = (
        colours(dark),
        [trace["marker"]["color"] for trace in dark.drawn("cobot", "ladder")["data"]],
    )
    assert button.get_attribute("aria-label") == "Use light colours"
    button.click()
    after = colours(dark), [trace["marker"]["color"] for trace in dark.drawn("cobot", "ladder")["data"]]
    assert button.get_attribute("aria-label") == "Use dark colours"
    button.focus()
    button.press("Enter")
    assert after[0][1] > 0.9
    assert not set(after[1]) & set(before[1])
    assert colours(dark) == before[0]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_no_violation(scheme: str, request: pytest.FixtureRequest) -> None:
    """All rules of axe-core, the experimental ones and those of WCAG 2.2 AAA aside."""
    from axe_playwright_python.sync_playwright import Axe

    shown: Shown = request.getfixturevalue(scheme)
    shown.draw_everything()
    found = Axe().run(shown.page)
    assert len(found.response["passes"]) > 20
    told = [
        (one["id"], node["target"], node["html"][:160], node["failureSummary"])
        for one in found.response["violations"]
        for node in one["nodes"][:3]
    ]
    assert told == []


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_clipped(light: Shown, width: int) -> None:
    page = light.page
    page.set_viewport_size({"width": width, "height": 900})
    page.wait_for_timeout(200)  # the page draws its charts for the new width
    light.draw_everything()
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
    assert page.evaluate("() => inPage.clipped()") == []
    assert page.evaluate("() => inPage.cutInCharts()") == []
    assert page.evaluate("() => inPage.overlapsInCharts()") == []
    page.set_viewport_size({"width": 1300, "height": 900})


def test_paper_is_light_and_shows_what_is_open_whole(open_page: Open, tmp_path: Path) -> None:
    """Printed by a reader whose page is dark, before any chart was scrolled to."""
    shown = open_page(color_scheme="dark")
    page = shown.page
    page.locator("button[data-all=case]").click()
    page.evaluate("() => dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    assert page.locator("figure.chart").count() >= 11
    assert page.locator("figure.chart .canvas:not(:has(svg.main-svg))").count() == 0
    widths = page.locator("figure.chart svg.main-svg").evaluate_all(
        "(all) => all.map((one) => one.clientWidth)"
    )
    assert max(widths) <= 718  # A4 between the margins
    assert page.evaluate("() => inPage.cutInCharts()") == []
    ink, ground = page.locator("body").evaluate(COLOUR)
    assert contrast(ink, "rgb(255, 255, 255)") > 10.0
    assert luminance(ground) > 0.9
    words = page.locator("figure.chart .xtitle").evaluate_all(
        "(all) => all.map((t) => getComputedStyle(t).fill)"
    )
    assert len(words) > 5
    assert all(contrast(one, "rgb(255, 255, 255)") >= 4.5 for one in words)
    assert page.locator(".side").is_hidden()
    page.emulate_media(media=None)
    page.evaluate("() => dispatchEvent(new Event('afterprint'))")
    assert page.evaluate("() => document.documentElement.dataset.theme") == "dark"
    made = page.pdf(
        path=tmp_path / "report.pdf",
        format="A4",
        margin=dict.fromkeys(("left", "right", "top", "bottom"), "1cm"),
    )
    assert made.startswith(b"%PDF")
    assert len(made) > 100_000
    assert shown.faults == []


def test_a_chart_in_a_closed_part_is_drawn_anew_when_it_is_opened(dark: Shown) -> None:
    """It was drawn, its part was closed, and the theme and the width changed meanwhile."""
    figure, part = dark.figure("cobot", "ladder"), dark.page.locator("details.case[data-of=cobot]")
    part.evaluate("(one) => { one.open = false; }")
    dark.page.locator("#theme").click()
    dark.page.set_viewport_size({"width": 800, "height": 900})
    dark.page.wait_for_timeout(200)
    ink, ground = colours(dark)
    assert ground > 0.9
    assert ink < 0.05
    widths = figure.locator(".canvas").evaluate(
        "(c) => [c.clientWidth, c.querySelector('svg').clientWidth]"
    )
    assert widths[0] == pytest.approx(widths[1], abs=1.0)
    dark.page.set_viewport_size({"width": 1300, "height": 900})
    dark.page.locator("#theme").click()
    assert colours(dark)[1] < 0.05


def test_a_reader_who_wants_less_motion_sees_no_motion_that_was_not_asked_for(open_page: Open) -> None:
    shown = open_page(reduced_motion="reduce")
    running: Any = shown.page.evaluate("() => document.getAnimations().length")
    assert running == 0
    figure = shown.figure("cobot", "arm")
    assert float(figure.locator("input[type=range]").input_value()) == 0.0
    shown.page.wait_for_timeout(100)
    assert float(figure.locator("input[type=range]").input_value()) == 0.0
    assert shown.faults == []


def test_every_chart_states_its_result_in_words(light: Shown) -> None:
    labels = light.page.locator("figure.chart").evaluate_all("(all) => all.map((f) => f.ariaLabel)")
    assert len(labels) >= 11
    assert all(len(label) > 40 and re.search(r"\d", label) for label in labels)
