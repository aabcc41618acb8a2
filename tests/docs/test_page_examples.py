"""Every example of the pages runs as it stands, and prints what the page says that it prints."""

from __future__ import annotations

import html
import json
import re
import runpy
import shlex
import sqlite3
import subprocess
import sys
import tomllib
from contextlib import closing, suppress
from pathlib import Path

import pytest
from cyclopts import CycloptsError, MissingArgumentError
from graded_runs import graded

from compare.__main__ import application
from compare.benchmark.records.store import Store
from compare.commands import COMMANDS
from formulations import load, parse
from formulations.problem.toml_file.keys import PROBLEM_KEYS

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
README = ROOT / "README.md"
PAGES = sorted([*DOCS.rglob("*.md"), README])
ROBOTS = DOCS / "robots.md"  # runs in tests/compare/commands/test_worked_examples.py
NEEDS = {  # extras of the examples
    "better_swarm": ("statsmodels", "scikit_posthocs", "baycomp"),
    "certificate": ("flint",),
    "certificates": ("flint",),
    "cite": ("mealpy",),
    "could_it_be_that_fast": ("flint",),
}
CODE = re.compile(r"^(timebound .*?) *# exit code (\d+)$", re.MULTILINE)
PROSE = re.compile(r"`((?:timebound |python -m compare[ .])\w+(?![.\w])[^`]*)`")
NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"


def blocks(path: Path, *languages: str) -> list[tuple[str, str]]:
    found = re.findall(r"^```(\w+)\n(.*?)^```$", path.read_text("utf-8"), re.DOTALL | re.MULTILINE)
    return [(language, text) for language, text in found if language in languages]


def run(language: str, text: str, folder: Path) -> str:
    """Run a block; a command may say in a comment that it ends with another exit code than 0."""
    if language == "python":
        command = [sys.executable, "-c", text]
    else:
        text = CODE.sub(r"code=0; \1 || code=$?; test $code -eq \2", text)
        shim = f'timebound() {{ {sys.executable} -m compare "$@"; }}\nset -e\n'
        command = ["bash", "-c", shim + text]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, check=False, timeout=600,
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin", "MPLBACKEND": "Agg", "HOME": str(folder)},
    )  # fmt: skip
    assert done.returncode == 0, f"{text}\n{done.stderr}"
    return done.stdout


def is_said(line: str, said: str) -> bool:
    """Whether the output has the line, with numbers to one per cent: machines differ in the last digits."""
    words = re.split(f"({NUMBER})", " ".join(line.split()))
    pattern = "".join(f"({NUMBER})" if k % 2 else re.escape(word) for k, word in enumerate(words))
    for match in re.finditer(pattern, " ".join(said.split())):
        pairs = zip(match.groups(), words[1::2], strict=True)
        if all(abs(float(a) - float(b)) <= 0.02 * abs(float(b)) for a, b in pairs):
            return True
    return False


RUN = [path for path in PAGES if blocks(path, "sh", "python") and path not in (README, ROBOTS)]


@pytest.mark.long
@pytest.mark.parametrize("path", RUN, ids=lambda path: path.stem)
def test_the_examples_of_a_page_run_in_their_order(path: Path, tmp_path: Path) -> None:
    for module in NEEDS.get(path.stem, ()):
        pytest.importorskip(module)
    said = ""
    for language, text in blocks(path, "sh", "python", "text"):
        if language != "text":
            said = run(language, text, tmp_path)
            continue
        for line in filter(None, text.splitlines()):
            assert is_said(line, said), f"{line}\nis not in\n{said}"


@pytest.mark.long
def test_the_first_commands_of_the_readme_run(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(blocks(DOCS / "howto" / "own_swarm.md", "python")[0][1])
    lines = [line for _, text in blocks(README, "sh") for line in text.splitlines()]
    # these run in test_worked_examples.py, or take minutes
    others = ("new", "plan", "check", "grade", "all")
    mine = [line for line in lines if line.startswith("timebound ") and line.split()[1] not in others]
    assert [line.split()[1] for line in mine] == ["split", "cite", "audit", "audit", "solve"]
    run("sh", "\n".join(mine), tmp_path)


def parsed(line: str) -> None:
    """Let the parser of the command line read a call, without running it."""
    line = re.sub(r"^python -m compare[. ]", "timebound ", line)
    line = re.sub(r"\b(mine|module)(\.py)?:\w+", "whale", line)  # there is no such file
    words = shlex.split(line.replace(" 2>&1 ", " "), comments=True)
    if words[1] != "NAME" and not words[1].startswith("-"):
        assert words[1] in COMMANDS, line
        application(words[1]).parse_args(words[1:], exit_on_error=False, print_error=False)


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_command_of_a_page_can_be_parsed(path: Path) -> None:
    for _, text in blocks(path, "sh", "console"):
        for line in text.splitlines():
            if line.startswith("timebound "):
                parsed(line)
    for line in PROSE.findall(re.sub(r"^```.*?^```$", "", path.read_text("utf-8"), flags=re.S | re.M)):
        with suppress(MissingArgumentError):  # a sentence may leave out what the command is about
            parsed(line)


def test_a_call_that_is_not_valid_is_found() -> None:
    for line in (
        "timebound slove sr4c",
        "timebound solve sr4c --gapp 1",
        "timebound plan ur5 --rate x",
    ):
        with pytest.raises((AssertionError, CycloptsError)):
            parsed(line)


@pytest.mark.parametrize(
    "path", [*PAGES, *ROOT.glob("C*.md")], ids=lambda path: str(path.relative_to(ROOT))
)
def test_every_link_has_words_and_leads_somewhere(path: Path) -> None:
    """On a code-hosting page, where no program fills in titles; the site's own test has the anchors."""
    text = re.sub(r"^```.*?^```$|`[^`]*`", "", path.read_text("utf-8"), flags=re.S | re.M)
    for words, target in re.findall(r"\[([^][]*)\]\(([^() ]+)\)", text):
        assert words.strip(), target
        if "://" in target:
            assert re.fullmatch(r"https://[\w.-]+\.[a-z]+(/[\w./~%#-]*)?", target), target
        else:
            assert (path.parent / target.partition("#")[0]).exists(), target


def test_the_query_of_the_store_runs(tmp_path: Path) -> None:
    (query,) = re.findall(
        r'^sqlite3 report/results.sqlite "(.*)"$', (DOCS / "store.md").read_text(), re.M
    )
    store = Store(tmp_path)
    store.clear()
    store.add(graded(load("sr4c"), 4.8, "stretched", "pso", 0, 30))
    store.close()
    with closing(sqlite3.connect(tmp_path / "results.sqlite")) as database:
        ((swarm, count, gap),) = database.execute(query).fetchall()
    assert (swarm, count) == ("pso", 1)
    assert 0.0 < gap < 1.0


def test_the_table_and_the_picture_of_the_readme_are_what_is_computed() -> None:
    picture = runpy.run_path(str(DOCS / "pictures" / "ladder.py"))
    found = picture["numbers"]()
    drawn = re.search(
        r"<dc:description>(.*?)</dc:description>", picture["FILE"].read_text("utf-8"), re.S
    )
    assert drawn
    assert json.loads(html.unescape(drawn[1])) == pytest.approx(found, rel=1e-6)
    table = re.findall(r"^\| .* \| \**(\d\.\d+)\** \|.*$", README.read_text("utf-8"), re.M)
    keys = (
        "no motion is faster", "fastest motion", "rule", "no 3-5-3 spline is faster",
        "fastest 3-5-3 spline", "published", "stop at each waypoint", "rule, slowed down",
    )  # fmt: skip
    for text, key in zip(table, keys, strict=True):
        assert abs(float(text) - found[key]) <= 1.01 * 10.0 ** -len(text.partition(".")[2]), key
    assert f"{found['rule breaks a limit by']:.2f} times its limit" in README.read_text("utf-8")


def test_the_problem_files_of_the_reference_are_problems() -> None:
    first, files, asked, second = blocks(DOCS / "reference" / "problem_file.md", "toml")
    assert parse(first[1]).dof == 2
    assert len(parse(first[1] + asked[1]).conditions.asked) == 6
    assert set(tomllib.loads(files[1])) <= set(PROBLEM_KEYS)
    pytest.importorskip("eaik")
    assert parse(second[1]).waypoints.shape == (2, 6)


def test_every_extra_is_on_the_page_of_installing() -> None:
    rows = re.findall(r"^\| `(\w+)` \|", (DOCS / "howto" / "install.md").read_text("utf-8"), re.M)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert sorted(rows) == sorted(project["optional-dependencies"])


def test_the_comparison_of_lines_can_fail() -> None:
    assert is_said("a  1.00 s", "b\na 1.001 s\n")
    assert not is_said("a 1.00 s", "a 1.1 s")
    assert not is_said("a 1.00 s", "a 1.00 m")
