"""Every command of the list: help, its page, bad input in one line, exit codes, a quick start."""

from __future__ import annotations

import os
import re
import resource
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from compare.__main__ import application, first_steps, main
from compare.commands import COMMANDS
from formulations import NoFeasibleMotion

ROOT = Path(__file__).parents[3]
MODULES = ("all", "solve", "audit", "papers", "check_certificate")  # python -m compare.MODULE


def process(*arguments: str, **more: Any) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True, check=False, **more
    )


# --- all of them ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("columns", ["60", "80", "200"])
def test_help_names_the_command_its_options_and_an_example(
    name: str, columns: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    assert main([name, "--help"]) == 0
    shown = capsys.readouterr().out
    assert f"Usage: timebound {name}" in shown
    assert "Example: " in shown
    assert "\x1b" not in shown
    assert shown.endswith("\n")
    assert max(map(len, shown.splitlines())) <= int(columns)
    for option in application()[name].assemble_argument_collection():
        if option.parameter.show:
            assert option.parameter.help, option.name  # every option says what it is


@pytest.mark.parametrize("name", COMMANDS)
def test_the_page_of_the_commands_has_every_command(name: str) -> None:
    lines = (ROOT / "docs" / "reference" / "commands.md").read_text("utf-8").splitlines()
    assert any(line.startswith(f"timebound {name} ") or line == f"timebound {name}" for line in lines)


@pytest.mark.parametrize(
    "path",
    [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("notebooks/*.ipynb")],
    ids=lambda p: p.name,
)
def test_no_page_names_a_command_that_is_not_there(path: Path) -> None:
    if path.name == "CHANGELOG.md":  # of its time
        return
    # code, not prose: blocks and what stands in backquotes
    text = "\n".join(re.findall(r"```.*?```|`[^`]+`", path.read_text("utf-8"), re.DOTALL))
    assert {*re.findall(r"(?:timebound|-m compare) ([a-z_0-9]+)", text)} <= {*COMMANDS}
    assert {*re.findall(r"-m compare\.([a-z_0-9]+)", text)} <= {*MODULES}


@pytest.mark.parametrize("name", COMMANDS)
def test_an_example_can_be_parsed(name: str) -> None:
    program, *arguments = shlex.split(COMMANDS[name].example)
    assert program == "timebound"
    application(name).parse_args(arguments, exit_on_error=False, print_error=False)


@pytest.mark.parametrize("name", COMMANDS)
def test_an_unknown_option_is_one_line(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    given = [name, *["sr4c"] * ((name in NEED_A_FILE) + (name == "check"))]  # it needs two
    assert main([*given, "--nonsense", "1"]) == 2
    said = capsys.readouterr()
    assert said.err.startswith("error: ")
    assert "--nonsense" in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""


NEED_A_FILE = (
    "cite",
    "solve",
    "plan",
    "check",
    "view",
    "split",
    "motion_picture",
    "check_certificate",
    "report",
)

BAD = {
    "new": (["--limits", "joint_limits.yaml"], "joint_limits.yaml: no such file"),
    "grade": (["psoo"], "'psoo' is not known"),
    "versus": (["pso", "pso"], "pso: is the swarm itself"),
    "solve": (["nowhere.toml"], "nowhere.toml: no such file"),
    "plan": (["sr4c", "--stop", "soon"], '--stop: unable to convert "soon" into int'),
    "check": (["sr4c", "nowhere.csv"], "nowhere.csv: no such file"),
    "view": (["sr4d"], "sr4d: no such file, and no case of that name"),
    "retime": (["nowhere.csv", "--limits", "sr4c"], "nowhere.csv: no such file"),
    "split": (["sr4c", "--swarm", "psoo"], "--swarm: 'psoo' is not known; did you mean 'pso'?"),
    "motion_picture": (["sr4d"], "sr4d: no such file, and no case of that name"),
    "check_certificate": (["nowhere.json"], "nowhere.json: cannot be read"),
    "all": (["--cases", "sr4d"], "--cases: 'sr4d' is not known; did you mean 'sr4c'?"),
    "report": (["/nowhere"], "/nowhere: holds no comparison"),
    "merge": (["/nowhere", "/elsewhere"], "/nowhere: holds no comparison"),
    "export": (["/nowhere", "--csv"], "/nowhere: holds no comparison"),
    "audit": (["nowhere.toml"], "nowhere.toml"),
    "papers": (["sr4x"], "KEY: 'sr4x' is not known; did you mean 'sr4c'?"),
    "cite": (["sr4d"], "sr4d: no such file, and no case of that name"),
    "table8": (["--runs", "0"], "--runs: 0 is not positive"),
    "ablation": (["--jobs", "0"], "--jobs: 0 is not positive"),
    "readings": (["--seeds", "-3"], "--seeds: -3 is not positive"),
    "bias": (["--cases", ","], "--cases: none given (known: bagging"),
    "tune": (["--trials", "0"], "--trials: 0 is not positive"),
    "proofs": (["--each", "two"], '--each: unable to convert "two" into int'),
    "speed": (["--case", "bagging"], "--case: the papers' 14x14 matrix is 3-5-3's, bagging is 4-3-4"),
    "condition_gaps": (["--count", "0"], "--count"),
    "scale": (["--counts", "10,1"], "--counts: 1 is no number of waypoints (2 to 2000)"),
    "tool_gaps": (["--time-limit", "0"], "--time-limit: 0 is not positive"),
    "torque_gaps": (["nowhere.urdf"], "nowhere.urdf: no such file"),
    "free_form_study": (["--solver", "x"], '--solver: Invalid value "x"'),
    "rivals": (["--rivals", "pilz"], "--rivals: 'pilz' is not known (known: drake_spline"),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_bad_input_is_one_line_that_names_key_and_value(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments, words = BAD[name]
    assert main([name, *arguments]) == 2
    said = capsys.readouterr()
    assert said.err.startswith(f"error: {words}"), said.err
    assert said.err.count("\n") == 1
    assert said.out == ""


# --- how it starts and ends -----------------------------------------------------------------------


def test_nothing_heavy_is_loaded_for_the_list_of_commands() -> None:
    code = (
        "import sys; from compare.__main__ import main; main(['--help']); main([]);"
        "print(sorted({'numpy', 'casadi', 'numba', 'formulations', 'matplotlib'} & {*sys.modules}))"
    )
    found = process("-c", code)
    assert found.stdout.splitlines()[-1] == "[]"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    process("-m", "compare", "--help")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    # time of the processor: others may use the machine
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 1.0


def test_the_checker_is_run_without_loading_the_prover(tmp_path: Path) -> None:
    (tmp_path / "proof.json").write_text("{}")
    code = (
        "import sys; from compare.__main__ import main;"
        f"main(['check_certificate', {str(tmp_path / 'proof.json')!r}]);"
        "print(sorted({'formulations', 'numba', 'casadi', 'metaheuristics'} & {*sys.modules}))"
    )
    assert process("-c", code).stdout.splitlines()[-1] == "[]"


def test_alone_it_shows_first_steps_and_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    shown = capsys.readouterr().out
    assert shown.strip() == first_steps().strip()
    for name in COMMANDS:
        assert f"\n  {name} " in shown
    for line in shown.splitlines():  # what it tells people to type is there
        if line.startswith("  timebound "):
            assert line.split()[1] in COMMANDS
    assert max(map(len, shown.splitlines())) <= 104


def test_a_dash_does_for_an_underscore(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check-certificate", "--help"]) == 0
    assert "timebound check_certificate" in capsys.readouterr().out


def test_a_misspelt_command_is_told_the_nearest(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sovle"]) == 2
    assert 'Did you mean "solve"?' in capsys.readouterr().err


def test_the_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.strip()


@pytest.mark.parametrize("module", MODULES)
def test_old_spellings_still_work(module: str) -> None:
    done = process("-m", f"compare.{module}", "--help")
    assert done.returncode == 0, done.stderr
    assert f"Usage: timebound {module}" in done.stdout


def test_a_task_without_a_solution_ends_with_2_and_the_reason(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    from compare.commands.motions import motion_picture

    def none(problem: Any) -> Any:
        raise NoFeasibleMotion("sr4c: every spline leaves the position limits")

    monkeypatch.setattr(motion_picture, "family_optimum", none)
    assert main(["motion_picture", "sr4c", "--out", str(tmp_path / "x.svg")]) == 2
    assert capsys.readouterr().err == "error: sr4c: every spline leaves the position limits\n"


def test_an_interrupt_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    from compare.commands.motions import motion_picture

    def interrupted(problem: Any) -> Any:
        raise KeyboardInterrupt

    monkeypatch.setattr(motion_picture, "family_optimum", interrupted)
    assert main(["motion_picture", "sr4c", "--out", str(tmp_path / "x.svg")]) == 130
    assert capsys.readouterr().err == "interrupted; what was finished is on disk\n"


def test_a_fault_of_the_program_is_not_taken_for_bad_input(monkeypatch: pytest.MonkeyPatch) -> None:
    from compare.commands.motions import motion_picture

    def broken(problem: Any) -> Any:
        raise ArithmeticError("planted")

    monkeypatch.setattr(motion_picture, "family_optimum", broken)
    with pytest.raises(ArithmeticError, match="planted"):
        main(["motion_picture", "sr4c"])


def test_a_reader_that_has_gone_is_not_an_error_message() -> None:
    shell = f"{sys.executable} -m compare papers --list | head -c 1"
    done = subprocess.run(["bash", "-c", shell], cwd=ROOT, capture_output=True, text=True, check=False)
    assert "Traceback" not in done.stderr
    assert "BrokenPipe" not in done.stderr


def test_completion_is_installed_where_it_is_asked_for(tmp_path: Path) -> None:
    script = tmp_path / "timebound.bash"
    home = {**os.environ, "HOME": str(tmp_path)}
    done = process(
        "-m", "compare", "--install-completion", "--shell", "bash", "--output", str(script), env=home
    )
    assert done.returncode == 0, done.stderr
    text = script.read_text()
    assert all(name in text for name in COMMANDS)
