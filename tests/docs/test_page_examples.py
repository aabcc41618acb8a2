"""Every example of the pages runs as it stands, and prints what the page says that it prints."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from compare.__main__ import application
from compare.commands import COMMANDS
from formulations import parse

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
RUN = sorted([*DOCS.glob("questions/*.md"), *DOCS.glob("howto/*.md")])
PAGES = sorted([*DOCS.rglob("*.md"), ROOT / "README.md"])
CODE = re.compile(r"^(timebound .*?) *# exit code (\d+)$", re.MULTILINE)
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


@pytest.mark.long
@pytest.mark.parametrize("path", RUN, ids=lambda path: path.stem)
def test_the_examples_of_a_page_run_in_their_order(path: Path, tmp_path: Path) -> None:
    if path.stem in ("could_it_be_that_fast", "certificates"):
        pytest.importorskip("flint")
    if path.stem == "better_swarm":
        for module in ("statsmodels", "scikit_posthocs", "baycomp"):
            pytest.importorskip(module)
    if path.stem == "cite":
        pytest.importorskip("mealpy")
    said = ""
    for language, text in blocks(path, "sh", "python", "text"):
        if language != "text":
            said = run(language, text, tmp_path)
            continue
        for line in filter(None, text.splitlines()):
            assert is_said(line, said), f"{line}\nis not in\n{said}"


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_command_of_a_page_can_be_parsed(path: Path) -> None:
    for _, text in blocks(path, "sh", "console"):
        for line in text.splitlines():
            words = shlex.split(
                line.replace("mine:swarm", "whale"), comments=True
            )  # there is no such file
            if words[:1] != ["timebound"]:
                continue
            assert words[1] in COMMANDS, line
            application(words[1]).parse_args(words[1:], exit_on_error=False, print_error=False)


def test_the_problem_files_of_the_reference_are_problems() -> None:
    first, second = blocks(DOCS / "reference" / "problem_file.md", "toml")
    assert parse(first[1]).dof == 2
    pytest.importorskip("eaik")
    assert parse(second[1]).waypoints.shape == (2, 6)


def test_the_comparison_of_lines_can_fail() -> None:
    assert is_said("a  1.00 s", "b\na 1.001 s\n")
    assert not is_said("a 1.00 s", "a 1.1 s")
    assert not is_said("a 1.00 s", "a 1.00 m")
