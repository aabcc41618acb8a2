"""Commands: what they print, and one clear line for bad input."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands_run import command

from compare.__main__ import main


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("all", "--cases", "sr4d"), ("--cases", "sr4d", "sr4c", "bagging")),
        (("all", "--swarms", "psoo"), ("--swarms", "psoo", "pso-linear", "whale")),
        (("all", "--swarms", "nowhere:swarm"), ("--swarms", "nowhere:swarm", "ModuleNotFoundError")),
        (("all", "--swarms", "ipso"), ("--swarms", "ipso", "not reproducible")),
        (("all", "--apart", "0"), ("--apart", "0")),
        (("all", "--codings", "x"), ("--codings", "published", "stretched")),
        (("all", "--cases", ","), ("--cases", "none given", "sr4c")),
        (("all", "--seeds", "0"), ("--seeds", "0")),
        (("all", "--jobs", "-1"), ("--jobs", "-1")),
        (("all", "--budget", "many"), ("--budget", "many")),
        (("all", "--quickly"), ("--quickly",)),
        (("all", "--quick", "--full"), ("--full", "--quick")),
        (("all", "--out", "/dev/null/report"), ("--out", "/dev/null/report")),
        (("solve", "nowhere.toml"), ("nowhere.toml", "no such file", "sr4c")),
        (("solve",), ("FILE",)),
        (("solve", "sr4c", "--json", "/dev/null/x.json"), ("/dev/null/x.json", "cannot be written")),
        (("report", "/nowhere"), ("/nowhere",)),
        (("speed", "--case", "bagging"), ("bagging", "3-5-3")),
    ],
)
def test_bad_input_is_one_clear_line_and_exit_code_2(
    options: tuple[str, ...], words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(options) == 2
    said = capsys.readouterr().err
    assert "Traceback" not in said
    last = said.strip().splitlines()[-1]
    for word in words:
        assert word in last


def test_the_exit_code_and_the_line_are_those_of_the_process() -> None:
    done = command("all", "--cases", "sr4d")
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("error: --cases: 'sr4d' is not known")
    assert done.stderr.count("\n") == 1


def test_solve_prints_the_ladder_and_writes_it_as_json(tmp_path: Path) -> None:
    target = tmp_path / "ladder.json"
    done = command("solve", "cobot", "--json", str(target))
    assert done.returncode == 0, done.stderr
    assert "3.3495" in done.stdout
    assert '"family_longest_segment"' in target.read_text()


def test_speed_names_its_rivals_and_their_errors() -> None:
    done = command("speed", "--rounds", "1")
    assert done.returncode == 0, done.stderr
    for word in ("14x14", "one candidate at a time", "independent check", "times slower"):
        assert word in done.stdout
