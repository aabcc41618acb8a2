"""The site of the documentation: built without a warning or a network, complete, its links lead somewhere."""

from __future__ import annotations

import runpy
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest

import formulations
import metaheuristics
from compare.__main__ import application
from compare.citations.bibliography import entries
from compare.commands import COMMANDS
from formulations import CASES, FAMILIES, RUNGS
from formulations.problem.toml_file.keys import (
    CONDITION_KEYS,
    LIMIT_KEYS,
    POSE_KEYS,
    PROBLEM_KEYS,
    SEGMENT_KEYS,
    WAYPOINT_KEYS,
)
from metaheuristics import ALGORITHMS

pytestmark = pytest.mark.long
ROOT = Path(__file__).parents[2]
BUILD = """
import socket, sys

def refused(*arguments, **options):
    raise OSError("the build asked for the network")

socket.socket.connect = socket.create_connection = socket.getaddrinfo = refused
from sphinx.cmd.build import main
sys.exit(main(sys.argv[1:]))
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    for module in ("sphinx", "furo", "myst_nb"):
        pytest.importorskip(module, reason="pip install 'timebound[docs]'")
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-c", BUILD, "-q", "-W", "--keep-going", "-d", f"{folder}/trees", "docs",
         f"{folder}/html"],
        cwd=ROOT, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder / "html"


class Page(HTMLParser):
    """The anchors of a page, what it links to, and what it loads by itself."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.anchors: set[str] = {""}
        self.links: list[str] = []
        self.loads: list[str] = []
        self.text: list[str] = []
        self.feed(path.read_text("utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        found = {key: value or "" for key, value in attributes}
        self.anchors |= {found[key] for key in ("id", "name") if key in found}
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        self.loads += [found[key] for key in ("src", "href") if key in found and tag != "a"]

    def handle_data(self, data: str) -> None:
        self.text.append(data)


@cache
def page(path: Path) -> Page:
    return Page(path)


def pages(site: Path) -> Iterator[Path]:
    return site.rglob("*.html")


def shown(site: Path, name: str) -> str:
    return " ".join("".join(page(site / f"{name}.html").text).split())


def test_nothing_is_loaded_from_elsewhere(site: Path) -> None:
    for path in pages(site):
        assert not [url for url in page(path).loads if "//" in url], path


def test_every_link_between_pages_leads_to_a_place(site: Path) -> None:
    count = 0
    for path in pages(site):
        if path.name in ("search.html", "genindex.html"):
            continue
        for link in page(path).links:
            if ":" in link.split("/")[0]:
                continue
            there, _, anchor = link.partition("#")
            target = (path.parent / unquote(there)).resolve() if there else path
            assert target.is_file(), (path.name, link)
            if target.suffix == ".html":
                assert unquote(anchor) in page(target).anchors, (path.name, link)
            count += 1
    assert count > 2000


def test_every_command_has_its_options_and_its_example(site: Path) -> None:
    found = page(site / "reference" / "commands.html")
    text = shown(site, "reference/commands")
    for name, command in COMMANDS.items():
        assert f"timebound-{name}" in found.anchors
        assert command.example in text
        for option in application(name)[name].assemble_argument_collection():
            if option.parameter.show:
                assert option.name in text, (name, option.name)


def test_every_entry_of_the_registries_is_in_its_table(site: Path) -> None:
    tables = {"cases": CASES, "families": FAMILIES, "bounds": RUNGS, "algorithms": ALGORITHMS}
    for name, registry in tables.items():
        words = set(shown(site, f"reference/{name}").split())
        assert set(registry) <= words, name
    assert all(f"{{{key}," in shown(site, "reference/references") for key in entries())


def test_every_notebook_is_shown_with_its_pictures_and_its_answer(site: Path) -> None:
    notebooks = sorted((ROOT / "notebooks").glob("*.ipynb"))
    assert notebooks
    for path in notebooks:
        name = f"tutorials/notebooks/{path.stem}"
        assert " Answer. " in shown(site, name)
        if "|:--|" in path.read_text("utf-8"):
            assert "<table" in (site / f"{name}.html").read_text("utf-8")
        assert sum(url.endswith(".png") for url in page(site / f"{name}.html").loads) >= 2


def test_every_key_of_the_files_is_explained(site: Path) -> None:
    words = set(shown(site, "reference/problem_file").split())
    assert {*PROBLEM_KEYS, *LIMIT_KEYS, *POSE_KEYS} <= words
    assert {*CONDITION_KEYS, *WAYPOINT_KEYS, *SEGMENT_KEYS} <= words
    words = set(shown(site, "paper_file").split())
    assert {"family", "rows", "[[table]]", "[[claim]]", "rule", "[settings.swarm]", "alpha"} <= words


@pytest.mark.parametrize("package", [formulations, metaheuristics], ids=lambda p: p.__name__)
def test_every_public_name_is_in_the_reference_of_the_api(site: Path, package: object) -> None:
    anchors = set().union(*(page(path).anchors for path in (site / "reference" / "api").glob("*.html")))
    name = package.__name__  # type: ignore[attr-defined]
    missing = {f"{name}.{one}" for one in package.__all__} - anchors  # type: ignore[attr-defined]
    assert not missing


def test_formulas_are_on_the_pages_without_a_script(site: Path) -> None:
    path = site / "methods" / "every_motion.html"
    assert path.read_text("utf-8").count("<math ") > 50
    assert not [url for url in page(path).loads if "mathjax" in url.lower()]


def luminance(colour: str) -> float:
    """Relative luminance (WCAG 2) of six hexadecimal digits."""
    shares = [int(colour[k : k + 2], 16) / 255 for k in (0, 2, 4)]
    red, green, blue = (s / 12.92 if s <= 0.03928 else ((s + 0.055) / 1.055) ** 2.4 for s in shares)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("style", ["pygments_style", "pygments_dark_style"])
def test_code_can_be_read_in_every_colour(style: str) -> None:
    styles = pytest.importorskip("pygments.styles")
    pytest.importorskip("furo")  # brings the styles
    assert contrast("777777", "ffffff") == pytest.approx(4.48, abs=0.01)  # just too little for AA
    settings = runpy.run_path(str(ROOT / "docs" / "conf.py"))
    found = styles.get_style_by_name(settings[style])
    ground = found.background_color.removeprefix("#")
    for token, look in found:
        if look["color"]:
            assert contrast(look["color"], look["bgcolor"] or ground) >= 4.5, token
