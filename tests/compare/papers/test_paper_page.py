"""The page of a paper: its verdicts on top, a way back, names as text, nothing from elsewhere."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest

from compare.__main__ import main
from compare.papers import ITEMS, page, shelf
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.verdicts import Reproduction

HOSTILE = '<script>alert("x")</script>'


def make(full: bool) -> dict[str, Any]:
    return {"name": "text", "outcome": "Not reproduced"}


def show(data: dict[str, Any]) -> Shown:
    name = data["name"]
    figure, axes = plt.subplots()
    axes.plot([0.0, 1.0])
    verdicts = [
        ItemVerdict(f"the time of {name}", Reproduction(data["outcome"])),
        ItemVerdict("the order", Reproduction.REPRODUCED),
    ]
    return Shown([Table([name], [[name]], name), figure], [f"Remark on {name}."], verdicts)


def nothing(data: dict[str, Any]) -> Shown:
    return Shown([], ["Drawn."], ())


class Page(HTMLParser):
    """Tags with their attributes, and the text of each row of the table of verdicts."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.rows: list[str] = []
        self._inside = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag == "table":
            self._inside = "verdicts" in (dict(attrs).get("class") or "")
        if tag == "tr" and self._inside:
            self.rows.append("")

    def handle_data(self, data: str) -> None:
        if self._inside and self.rows:
            self.rows[-1] += f"{data} "

    def handle_endtag(self, tag: str) -> None:
        self._inside = self._inside and tag != "table"

    def values(self, tag: str, name: str) -> list[str]:
        return [attributes.get(name) or "" for t, attributes in self.tags if t == tag]


@pytest.fixture
def items() -> list[Item]:
    return [
        Item("Table 1", f"times of {HOSTILE}", make, show, f"read as {HOSTILE}"),
        Item("Fig 2", "a drawing", make, nothing),
        Item("Fig 3", "never made", make, show),
    ]


def written(folder: Path, items: list[Item], **changed: Any) -> str:
    data = {"name": HOSTILE, "outcome": "Not reproduced"} | changed
    for item in items[:2]:
        shelf.keep(folder, "sr4c", item, shelf.Made(False, "ok", "", 1.0, HOSTILE, HOSTILE, data))
    page.render(str(folder), "sr4c", items, ["sr4c", "z1"])
    return (folder / "papers" / "sr4c.html").read_text("utf-8")


def test_the_verdicts_come_first(tmp_path: Path, items: list[Item]) -> None:
    text = written(tmp_path, items)
    assert "<h1>Wang 2025: 1 of 2 printed results are reproduced, 1 not</h1>" in text
    assert "<title>Wang 2025: 1 of 2 printed results are reproduced, 1 not</title>" in text
    rows = [" ".join(row.split()) for row in Page(text).rows]
    assert rows == [
        "item printed result verdict",
        f"Table 1 the time of {HOSTILE} ✕ not reproduced",
        "Table 1 the order ✓ reproduced",
        "Fig 2 a drawing – nothing to judge",
        "Fig 3 never made ⚠ not made yet: timebound papers makes it",
    ]
    again = written(tmp_path, items, outcome="Reproduced in kind")
    assert "1 of 2 printed results are reproduced, 1 in kind</h1>" in again
    assert "≈ reproduced in kind" in " ".join(Page(again).rows[1].split())


def test_links_lead_back_and_to_what_is_there(tmp_path: Path, items: list[Item]) -> None:
    links = Page(written(tmp_path, items)).values("a", "href")
    assert "../index.html" not in links
    assert "z1.html" in links
    assert "sr4c.html" not in links
    (tmp_path / "index.html").write_text("the report")
    found = Page(written(tmp_path, items))
    assert "../index.html" in found.values("a", "href")
    names = {attributes["id"] for _, attributes in found.tags if "id" in attributes}
    assert {link[1:] for link in found.values("a", "href") if link.startswith("#")} <= names


def test_names_stay_text_and_nothing_comes_from_elsewhere(tmp_path: Path, items: list[Item]) -> None:
    text = written(tmp_path, items)
    assert "<script>alert" not in text
    assert text.count("&lt;script&gt;alert") >= 8
    found = Page(text)
    assert not found.values("link", "href")
    assert not any(found.values("script", "src"))
    assert all(source.startswith("data:image/svg+xml;") for source in found.values("img", "src"))
    assert not [link for link in found.values("a", "href") if re.match(r"\w+:|//", link)]
    assert "default-src 'none'" in text


def test_a_picture_tells_its_result(tmp_path: Path, items: list[Item]) -> None:
    (alt,) = Page(written(tmp_path, items, name="joint 1")).values("img", "alt")
    assert alt == (
        f"Table 1, times of {HOSTILE}. Not reproduced: the time of joint 1. Remark on joint 1."
    )


def test_the_command_says_the_verdicts(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    items: list[Item],
) -> None:
    calm = (replace(items[0], label="Table 1"), items[1])
    monkeypatch.setitem(ITEMS, "sr4c", calm)
    for item in calm:
        data = {"name": "joint 1", "outcome": "Not reproduced"}
        shelf.keep(
            tmp_path, "sr4c", item, shelf.Made(False, "ok", "", 1.0, shelf.versions_text(), "", data)
        )
    options = ["papers", "sr4c", "--out", str(tmp_path), "--resume"]
    assert main(options) == 0
    told = capsys.readouterr().out
    assert "sr4c: Table 1: 1 of 2 reproduced, 1 of 2 not reproduced\n" in told
    assert "sr4c: Fig 2: nothing to judge\n" in told
    assert not re.search(r"\bok\b", told)
    assert main([*options, "--json", "-"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["made"] == answer["failed"] == []
    assert answer["verdicts"] == [
        {
            "paper": "sr4c",
            "item": "Table 1",
            "what": "the time of joint 1",
            "outcome": "not reproduced",
        },
        {"paper": "sr4c", "item": "Table 1", "what": "the order", "outcome": "reproduced"},
    ]
