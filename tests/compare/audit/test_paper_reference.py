"""The reference of the keys, the template and the reader agree: all three are made of one description."""

from __future__ import annotations

import datetime
import json
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from compare.__main__ import main
from compare.audit import audit, parse_papers
from compare.audit.findings.points import points_of
from compare.audit.hints import QUESTIONS
from compare.audit.paper.format import FORMAT
from compare.audit.paper.keys import TYPES, Key, KeyTable
from compare.audit.paper.reference import reference, template
from formulations import InputError

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "paper_file.md").read_text("utf-8")


def entries(table: Any, path: str = "") -> Iterator[tuple[str, str, Key | KeyTable]]:
    """Every key with the heading under which it stands."""
    for name, entry in table.items():
        yield path, name, entry
        if isinstance(entry, KeyTable):
            below = f"{path}.{name}" if path else name
            yield from entries(entry.keys, below)


def test_the_page_is_made_of_the_description_that_the_reader_uses() -> None:
    # python -m compare.audit.paper.reference > docs/paper_file.md
    assert reference() == PAGE


def test_the_page_names_every_hint() -> None:
    assert [question for question in QUESTIONS.values() if f"- {question}" not in PAGE] == []


@pytest.mark.parametrize(("path", "name"), [(path, name) for path, name, _ in entries(FORMAT)])
def test_every_key_has_its_line_on_the_page(path: str, name: str) -> None:
    heads = {
        line.strip("#` []"): at for at, line in enumerate(PAGE.splitlines()) if line.startswith("## ")
    }
    lines = PAGE.splitlines()
    below = f"{path}.{name}" if path else name
    start = heads[path] if path else heads["Keys"]
    section = lines[start : min([at for at in heads.values() if at > start], default=len(lines))]
    assert below in heads or any(line.startswith(f"| `{name}` | ") for line in section)


@pytest.mark.parametrize(
    "entry", [entry for _, _, entry in entries(FORMAT)], ids=lambda e: e.meaning[:30]
)
def test_every_key_says_what_it_means_and_shows_an_example_of_its_type(entry: Key | KeyTable) -> None:
    assert len(entry.meaning) > 5
    if isinstance(entry, Key):
        value = tomllib.loads(f"x = {entry.example}")["x"]
        assert isinstance(value, TYPES[entry.kind])


def test_the_template_is_a_sound_paper() -> None:
    (paper,) = parse_papers(template(), "template")
    found = audit(paper)
    assert found.faults == []
    assert found.hints == ()
    assert {kind for kind in ("rows", "totals", "claims", "points") if getattr(paper, kind)} == {
        "rows", "totals", "claims", "points",
    }  # fmt: skip
    assert paper.dh is not None
    assert all(motion.stated for motion in found.motions)


def switched_on(text: str, heading: str, line: str) -> str:
    """The template with one of its further lines; limits of one joint hold one number."""
    before, after = text.split(heading, 1)
    on = heading + after.replace(line, line[2:], 1)
    if line == "#:joint = 1":
        for pair in (", 90]", ', "250"]', ", [-120, 120]]"):
            on = on.replace(pair, "]", 1)
        on = on.replace('limits = "Table 3"', "# no limits")
    return before + on


@pytest.mark.parametrize(
    ("heading", "line"),
    [
        (f"[[{top}]]" if entry.many else f"[{top}]", f"#:{name} = {key.example}")
        for top, entry in FORMAT.items()
        if isinstance(entry, KeyTable) and entry.shown
        for name, key in entry.keys.items()
        if isinstance(key, Key) and not key.shown
    ],
)  # fmt: skip
def test_every_further_line_of_the_template_may_be_switched_on(heading: str, line: str) -> None:
    text = switched_on(template(), heading, line)
    assert text != template()
    parse_papers(text, "p")


def test_the_further_table_of_the_template_may_be_switched_on() -> None:
    before, after = template().split("#:[[variant]]")
    _, variant = parse_papers(before + "[[variant]]" + after.replace("#:", ""), "p")
    assert variant.name == "corrected"


def test_the_command_writes_the_template_and_audits_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def run(*words: str) -> tuple[int, str, str]:
        code = main(["audit", *words])
        return code, *capsys.readouterr()

    file = tmp_path / "mine.toml"
    assert run("--template", str(file))[0] == 0
    assert file.read_text("utf-8") == template()
    assert run("--template")[1] == template()
    code, judged, _ = run(str(file))
    assert code == 0
    assert "nothing wrong was found" in judged
    assert "HINT" not in judged
    assert run("--template", str(file)) == (2, "", f"error: --template: {file} is there already\n")
    code, _, nowhere = run("--template", str(tmp_path / "no" / "mine.toml"))
    assert code == 2
    assert "cannot be written" in nowhere
    # a fault with its hint, on the screen and as JSON
    file.write_text(template().replace('["20.0", "45.0"]', '["-20.0", "45.0"]'))
    _, wrong, _ = run(str(file), "--json", str(tmp_path / "out.json"))
    assert "HINT: one sign wrong?\n  - tried: joint 1 of waypoint 2 with the other sign; " in wrong
    (data,) = json.loads((tmp_path / "out.json").read_text())
    (hint,) = data["hints"]
    assert hint["kind"] == "sign"
    assert hint["removes"] == hint["of"] == sum(f["fault"] for f in data["findings"])
    code, _, near = run("cobott")
    assert code == 2
    assert near.endswith("did you mean 'cobot'?\n")


WRONG: tuple[Any, ...] = (
    5, -1, 2.5, float("inf"), float("nan"), "x", "", "1e999", True, [], {}, [[]], [{}], [True], ["x"],
    datetime.date(2020, 1, 1), 10**30, "9" * 500, [1, 2, 3, 4, 5, 6, 7], [[1, 2], [3, 4]], [0, 0], [1e9, 1e9],
)  # fmt: skip


def as_toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {as_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(as_toml, value)) + "]"
    if isinstance(value, datetime.date):
        return value.isoformat()
    return json.dumps(value) if isinstance(value, str | bool) else repr(value)


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    below = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    for key, entry in below:
        yield (*path, key)
        yield from places(entry, (*path, key))


WHOLE = tomllib.loads(template())


@pytest.mark.parametrize("top", list(WHOLE))
def test_any_value_at_any_depth_is_read_or_refused_in_one_line_with_its_key(top: str) -> None:
    refused = 0
    for path in places(WHOLE):
        if path[0] != top or 1 in path:  # the second of a list is read as the first
            continue
        for wrong in WRONG:
            data = deepcopy(WHOLE)
            inner: Any = data
            for key in path[:-1]:
                inner = inner[key]
            inner[path[-1]] = wrong
            text = "\n".join(f"{json.dumps(k)} = {as_toml(v)}" for k, v in data.items())
            try:
                (paper,) = parse_papers(text, "p")
            except InputError as error:
                refused += 1
                message = str(error)
                assert "\n" not in message
                assert len(message) < 400
                # the key itself, or beside it the one that it has to fit
                key = next(part for part in reversed(path) if isinstance(part, str))
                assert key in message, (path, wrong, message)
            else:
                if top in ("dh", "point"):
                    points_of(paper)
    assert refused > 3
