"""What can be graded, by path, module or library; what is near to a name that is not there."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from compare.__main__ import main
from compare.commands.names import found_swarms
from compare.grading.names import swarm_name

SWARM = """from metaheuristics import ALGORITHMS


def swarm(task, *, population=50):
    while True:
        yield task.sample(population)


raise_me = None
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(sys, "path", list(sys.path))
    (tmp_path / "my_flock.py").write_text(SWARM)
    return tmp_path


def test_a_file_a_module_a_library_and_a_name_are_taken(folder: Path) -> None:
    assert swarm_name(f"{folder / 'my_flock.py'}:swarm") == "my_flock:swarm"
    assert swarm_name("my_flock:swarm") == "my_flock:swarm"  # its folder is a place of modules now
    assert swarm_name("pso") == "pso"
    assert swarm_name("mealpy:GWO") == "mealpy:GWO"
    assert "my_flock" not in sys.modules  # its code is loaded by a process of its own


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ("psoo", "did you mean 'pso'"),
        ("mealpy:GWOO", "did you mean mealpy:"),
        ("mealpy:BaseGWO", "did you mean mealpy:"),
        ("pymoo:PSOO", "did you mean pymoo:PSO"),
        ("nevergrad:NGOp", "nevergrad:NGOpt"),
        ("minion:LSHAD", "minion:LSHADE"),
        ("ipso", "not reproducible"),
        ("{folder}/my_flok.py:swarm", "there is no file .*; did you mean 'my_flock.py'"),
        ("{folder}/my_flock.py:swrm", "defines no 'swrm'; did you mean 'swarm'"),
        ("{folder}/my_flock.py", r"a name is missing after the file \(my_flock.py defines swarm\)"),
        ("{folder}/random.py:swarm", "another module is called random; rename the file"),
        ("{folder}/broken.py:swarm", "is no Python file, line 1"),
        ("my_flok:swarm", "my_flok"),
    ],
)
def test_a_name_that_is_not_there_gets_a_hint(folder: Path, typed: str, words: str) -> None:
    (folder / "random.py").write_text(SWARM)
    (folder / "broken.py").write_text("def swarm(:")
    with pytest.raises(ValueError, match=words):
        swarm_name(typed.format(folder=folder))


def test_the_command_says_it_in_one_line_with_code_2(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grade", "psoo"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: 'psoo' is not known")
    assert said.count("\n") == 1
    assert main(["versus", "pso", "pso"]) == 2
    assert "is the swarm itself" in capsys.readouterr().err
    assert main(["grade", "mpso", "--cases", "sr4d"]) == 2
    assert "sr4d" in capsys.readouterr().err


def test_a_file_is_taken_wherever_swarms_are_named(folder: Path) -> None:
    file = folder / "my_flock.py"
    assert found_swarms(f"{file}:swarm,pso,my_flock:swarm") == ("my_flock:swarm", "pso")
    with pytest.raises(ValueError, match=r"defines no 'swarn'; did you mean 'swarm'\?"):
        found_swarms(f"{file}:swarn")
    with pytest.raises(ValueError, match=r"there is no file nowhere\.py"):
        found_swarms("nowhere.py:swarm")
