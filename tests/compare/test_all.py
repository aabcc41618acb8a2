"""The whole comparison: its rows, its report, its interrupts."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import pytest
from commands_run import ROOT, command
from graded_runs import without_times

from compare.benchmark.records.rows import COLUMNS
from compare.benchmark.records.store import Store

SMALL = ("--cases", "sr4c,cobot", "--swarms", "pso,whale", "--seeds", "2", "--budget", "200")


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("report")
    done = command("all", *SMALL, "--jobs", "2", "--out", str(folder))
    assert done.returncode == 0, done.stderr
    return folder


def comparable(folder: Path) -> list[dict[str, object]]:
    return [without_times(row) for row in Store(folder).rows()]


@pytest.mark.long
def test_one_worker_and_two_write_the_same_rows(report: Path, tmp_path: Path) -> None:
    done = command("all", *SMALL, "--jobs", "1", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert len(comparable(tmp_path)) == 2 * 2 * 4 * 2  # the published coding by two budgets
    assert comparable(tmp_path) == comparable(report)


def test_the_page_stands_alone_and_holds_what_it_promises(report: Path) -> None:
    page = (report / "index.html").read_text()
    assert len(page) < 4_000_000
    text_of_page = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
    sources = re.findall(r'(?:src|href)="([^"]{0,40})', text_of_page)
    assert not [s for s in sources if s.startswith(("http", "//"))]  # but links that a reader follows
    assert "<link" not in page
    charts = re.findall(
        r'<figure class="chart" data-kind="(\w+)" data-of="(\w+)" aria-label="[^"]{20,}">', page
    )
    kinds = ("ladder", "arm", "motion", "seeds", "progress", "split")
    assert charts == [("arms", "all"), *((kind, case) for case in ("sr4c", "cobot") for kind in kinds)]
    data = json.loads(re.search(r'id="data">(.*?)</script>', page, re.DOTALL)[1])
    assert all(len(data[case][kind]["alt"]) > 20 for kind, case in charts)
    for word in ("breaks", "Known limitations", "numpy=", "cores", "pso", "whale", "4.7007"):
        assert word in page
    text = (report / "report.md").read_text()
    assert "| pso |" in text
    for words in ("The papers", "What is known of its task", "What its published numbers say"):
        assert words in page
        assert words in text
    # of each paper one verdict that was checked by hand
    for proof in ("0.471 % below the certified minimum", "3.139 is printed, the sum is 4.1358"):
        assert proof in page
        assert proof in text
    assert "papers/sr4c.html" not in page  # nobody has written it
    assert "<animate" in (report / "figures" / "sr4c-arm.svg").read_text()
    assert set(Store(report).audits()) == {"sr4c", "cobot"}
    for case in ("sr4c", "cobot"):
        for name in ("ladder", "gaps", "convergence", "motion"):
            assert (report / "figures" / f"{case}-{name}.svg").stat().st_size > 5000
            assert f"figures/{case}-{name}.svg" in text


def test_every_run_is_a_row_with_versions_seed_budget_and_machine(report: Path) -> None:
    with (report / "rows.csv").open() as lines:
        rows = list(csv.DictReader(lines))
    assert len(rows) == 32
    for row in rows:
        assert row["versions"].startswith("python=")
        assert "cores" in row["machine"]
        assert row["budget"] == ("1200" if row["track"] == "paper" else "200")
        assert row["seed"] in "01"


@pytest.mark.long
def test_the_report_can_be_drawn_again_from_its_rows(report: Path) -> None:
    before = (report / "index.html").read_text()
    done = command("report", str(report))
    assert done.returncode == 0, done.stderr
    assert (report / "index.html").read_text() == before


@pytest.mark.long
def test_a_planted_line_is_a_fault_in_the_report_and_none_of_its_numbers_is_shown(
    report: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "report"
    shutil.copytree(report, folder)
    store = Store(folder)
    store.close()
    with closing(sqlite3.connect(store.file)) as other, other:
        other.execute("UPDATE runs SET seconds = 1.0, gap = -0.7, status = 'ok' WHERE id = 3")
    done = command("report", str(folder))
    assert done.returncode == 0, done.stderr
    for name in ("index.html", "report.md"):
        text = (folder / name).read_text()
        assert "it states 1 s, its durations add up to" in text
        assert "-70 %" not in text
        assert ">-70<" not in text
        assert "Stored rows that do not hold" in text


@pytest.mark.long
def test_a_killed_run_leaves_readable_rows_and_resume_ends_like_an_unbroken_one(
    report: Path, tmp_path: Path
) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "compare.all", *SMALL, "--jobs", "1", "--out", str(tmp_path)],
        cwd=ROOT, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    deadline = time.monotonic() + 120.0
    while time.monotonic() < deadline and process.poll() is None:
        if len(Store(tmp_path).rows()) >= 5:
            break
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    left = comparable(tmp_path)
    assert len(left) >= 5
    assert all(row in comparable(report) for row in left)
    done = command("all", *SMALL, "--jobs", "1", "--out", str(tmp_path), "--resume")
    assert done.returncode == 0, done.stderr
    assert comparable(tmp_path) == comparable(report)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
def test_an_interrupt_is_one_line_and_leaves_whole_rows(tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "compare.all", "--swarms", "pso", "--seeds", "5000", "--cases", "cobot",
         "--out", str(tmp_path)],
        cwd=ROOT, stderr=subprocess.PIPE, text=True, start_new_session=True,
        # a shell that runs the tests in the background ignores interrupts, and so would the child
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    deadline = time.monotonic() + 120.0
    while time.monotonic() < deadline and len(Store(tmp_path).rows()) < 5:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in errors
    with (tmp_path / "rows.csv").open() as lines:
        assert next(csv.reader(lines)) == list(COLUMNS)
    assert errors.strip().splitlines()[-1] == "interrupted; what was finished is on disk"
    assert len(Store(tmp_path).rows()) >= 5
