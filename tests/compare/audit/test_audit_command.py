"""The command of the audit, and its chapter of the report."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import jinja2
from printed_papers import synthetic

from compare.audit import FAULTS, audit, chapter, parse_papers


def test_the_command_audits_a_file(tmp_path: Path) -> None:
    text = synthetic(SHARE="31.41")
    text = "\n".join(line for line in text.splitlines() if not line.startswith(("longest", "total =")))
    (tmp_path / "mine.toml").write_text(text)
    out = tmp_path / "audit.json"
    call = [sys.executable, "-m", "compare.audit", str(tmp_path / "mine.toml"), "--json", str(out)]
    done = subprocess.run(call, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "WRONG: the arithmetic does not add up" in done.stdout
    (data,) = json.loads(out.read_text())
    assert {row["feasible"] for row in data["motions"]} == {"within rounding"}
    wrong = [f for f in data["findings"] if f["fault"]]
    assert "sec. 4" in {f["where"] for f in wrong}
    assert all(f["meaning"] == FAULTS[f["kind"]] for f in wrong)


def test_the_command_refuses_what_is_not_there() -> None:
    call = [sys.executable, "-m", "compare.audit", "nothing.toml"]
    done = subprocess.run(call, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("error: nothing.toml: no such file, and no paper of that name")
    assert len(done.stderr.splitlines()) == 1


def test_the_chapter_of_the_report_is_drawn_from_stored_json() -> None:
    (paper,) = parse_papers(synthetic(SHARE="31.41"), "p")
    stored = json.loads(json.dumps(audit(replace(paper, rows=paper.rows[:1], totals=())).to_json()))
    (entry,) = chapter([stored])
    assert [group["kind"] for group in entry["faults"]] == ["sum"]
    assert entry["rows"][0]["cells"][0] == "Table 2, joint 1"
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("compare.report"), autoescape=True, undefined=jinja2.StrictUndefined
    )
    page = environment.get_template("audit.html.j2").render(audits=[entry])
    assert "31.41 is printed" in page
    assert page.count("<tr>") == 2
    assert "(a hint; it proves nothing)" not in page
    # a store of an earlier version has no hints; one with a hint shows it
    hint = {"question": "one sign wrong?", "text": "tried: joint 1 of waypoint 2 with the other sign"}
    assert chapter([{key: value for key, value in stored.items() if key != "hints"}])[0]["hints"] == []
    (hinted,) = chapter([stored | {"hints": [hint]}])
    page = environment.get_template("audit.html.j2").render(audits=[hinted])
    assert "<b>One sign wrong?</b> (a hint; it proves nothing) Tried: joint 1 of waypoint 2" in page
