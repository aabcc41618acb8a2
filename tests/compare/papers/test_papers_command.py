"""The command of the papers: nothing is lost, faults are shown."""

from __future__ import annotations

import html
import json
import os
import re
import tomllib
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest

from compare.__main__ import main
from compare.audit.paper import published_text
from compare.papers import ITEMS, page, shelf
from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.verdicts import held


def fine(full: bool) -> dict[str, Any]:
    with open(os.environ["TIMEBOUND_COUNT"], "a", encoding="utf-8") as lines:
        lines.write("made\n")
    return {"answer": 42}


def broken(full: bool) -> dict[str, Any]:
    raise ArithmeticError("planted <fault>")


def deadly(full: bool) -> dict[str, Any]:
    os._exit(3)


def unstorable(full: bool) -> dict[str, Any]:
    return {"answer": float("nan")}


def show(data: dict[str, Any]) -> Shown:
    verdict = ItemVerdict("the <b>answer", held(data["answer"] == 42))
    figure, axes = plt.subplots()
    axes.plot([0.0, 1.0])
    return Shown(
        [Table(["answer"], [[str(data["answer"])]]), figure], ['It is "what" it is.'], [verdict]
    )


def run(*options: str) -> int:
    return main(["papers", *options])


def test_failing_items_have_a_status_and_cost_no_other_item(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = {"Table 1": fine, "Table 2": broken, "Table 3": deadly, "Table 4": unstorable}
    items = tuple(
        Item(label, "planted", make, show, "as planted", cost=float(make is deadly))
        for label, make in made.items()
    )
    count = tmp_path / "count"
    monkeypatch.setenv("TIMEBOUND_COUNT", str(count))
    monkeypatch.setitem(ITEMS, "sr4c", items)
    options = ("sr4c", "--out", str(tmp_path), "--jobs", "1")
    assert run(*options) == 1
    errors = capsys.readouterr().err
    assert (
        "sr4c: Table 2: failed: ArithmeticError: planted <fault> (test_papers_command.py, line"
        in errors
    )
    assert "sr4c: Table 3: died: its process ended" in errors
    folder = tmp_path / "papers" / "sr4c"
    stored = {path.stem: json.loads(path.read_text("utf-8")) for path in folder.glob("*.json")}
    assert {name: entry["status"] for name, entry in stored.items()} == {
        "table-1": "ok", "table-2": "failed", "table-3": "died", "table-4": "failed",
    }  # fmt: skip
    assert stored["table-1"]["data"] == {"answer": 42}
    assert stored["table-2"]["data"] is None
    text = (tmp_path / "papers" / "sr4c.html").read_text("utf-8")
    assert '<td class="text">42</td>' in text
    assert "planted &lt;fault&gt;" in text
    assert count.read_text("utf-8") == "made\n"

    # what is finished is not made again, unless it is of another size; with nothing failing, all is well
    monkeypatch.setitem(ITEMS, "sr4c", items[:1])
    assert run(*options, "--resume") == 0
    assert count.read_text("utf-8") == "made\n"
    assert shelf.finished(tmp_path, "sr4c", items[0], False)
    assert not shelf.finished(tmp_path, "sr4c", items[0], True)
    assert not shelf.finished(tmp_path, "sr4c", items[1], False)


def test_each_chapter_ends_with_what_its_paper_file_says_was_left_out(tmp_path: Path) -> None:
    for paper in ITEMS:
        told = tomllib.loads(published_text(paper)).get("left_out", [])
        page.render(str(tmp_path), paper, ())
        text = html.unescape((tmp_path / "papers" / f"{paper}.html").read_text("utf-8"))
        cells = [" ".join(row[key].split()) for row in told for key in ("where", "what", "why")]
        assert re.findall(r'<td class="text">(.*?)</td>', text) == cells
        assert ("What was left out" in text) == bool(told)
    assert tomllib.loads(published_text("z1"))["left_out"]


def test_an_item_that_cannot_be_shown_costs_no_other_item(tmp_path: Path) -> None:
    items = [
        Item("Table 1", "", fine, show),
        Item("Table 2", "", fine, show),
        Item("Table 3", "", fine, show),
    ]
    for item, data in zip(items, ({"answer": 1}, {"other": 2}), strict=False):
        stored = shelf.Made(False, "ok", "", 0.0, "v", "m", data)
        shelf.keep(tmp_path, "sr4c", item, stored)
    chapter = page.render(str(tmp_path), "sr4c", items)
    assert chapter.faults == {
        "Table 2": "failed: cannot be shown: KeyError: 'answer'",
        "Table 3": "not made: ",
    }
    assert [v.outcome for v in chapter.verdicts["Table 1"]] == [held(False)]
    assert '<td class="text">1</td>' in (tmp_path / "papers" / "sr4c.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (["sr4x"], "KEY: 'sr4x' is not known; did you mean 'sr4c'? (known: sr4c, bagging"),
        (
            ["bagging", "--item", "Table 99"],
            "--item: 'Table 99' is not an item of bagging (known: Table 2",
        ),
        (["--jobs", "0"], "--jobs: 0 is not positive"),
    ],
)
def test_bad_input_is_one_line_that_names_it(
    options: list[str],
    named: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    assert run(*options, "--out", str(tmp_path)) == 2
    error = capsys.readouterr().err
    assert named in error
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())
