"""``timebound NAME``, or ``python -m compare NAME``: every command by its name."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib import metadata

from cyclopts import App, CycloptsError, Group, Parameter
from cyclopts.exceptions import (
    CoercionError,
    MissingArgumentError,
    UnusedCliTokensError,
    ValidationError,
)

from compare.commands import BAD_INPUT, COMMANDS, DONE, FAILED, INTERRUPTED

_FIRST_STEPS = (
    (
        "You have waypoints and limits, and want the fastest safe motion:",
        ("timebound new", "asks, and writes FILE.toml"),
        ("timebound plan FILE.toml --export motion.csv --rate 125", "a file for the controller"),
        ("timebound solve FILE.toml", "every bound, and what limits the motion"),
        ("timebound check FILE.toml motion.csv", "yours: is it safe, and how far from the best?"),
        ("timebound view FILE.toml motion.csv", "the same to look at, with the arm in motion"),
    ),
    (
        "You have a new swarm, and want to know whether it is better:",
        ("timebound grade mine.py:swarm", "one verdict, and grade/grade.html"),
        ("timebound split sr4c --swarm module:function", "where its motion loses time"),
    ),
    (
        "You review a paper, and doubt its numbers:",
        ("timebound audit PAPER.toml", "limits, sums, and what could be that fast"),
        ("timebound check_certificate PROOF.json", "a bound proved again"),
    ),
    (
        "You want to see how bounds, optima and swarms relate:",
        ("timebound all --quick", "report/index.html, in half a minute"),
        ("timebound solve sr4c", "the bounds of one arm"),
    ),
)


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    argv : sequence of str, optional
        Name, arguments and options of the command; those of the process if left out.

    Returns
    -------
    int
        The exit code. 0: done; 2: bad input, or a task without a solution as posed; 1: anything else
        that failed; 3: a motion that was judged breaks something; 130: interrupted.
    """
    given = list(sys.argv[1:] if argv is None else argv)
    if given and given[0].replace("-", "_") in COMMANDS:
        given[0] = given[0].replace("-", "_")
    try:
        if not given:
            print(first_steps())
            return DONE
        code = application(given[0])(
            given, exit_on_error=False, print_error=False, result_action="return_value"
        )
        sys.stdout.flush()  # a reader that has gone is noticed here
        return code if isinstance(code, int) else DONE
    except CycloptsError as error:
        print(f"error: {_line(error)}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("interrupted; what was finished is on disk", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # the reader has gone
        return FAILED
    except Exception as error:
        if not _is_bad_input(error):
            raise
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT


def application(called: str = "") -> App:
    """Build the command-line application from ``COMMANDS``.

    Parameters
    ----------
    called : str
        The command that is called for: its help is the docstring of its function, that of the others
        the line in the list, which loads nothing.

    Returns
    -------
    App
        Every command by name; its module is imported when it is called for.
    """
    app = App(
        name="timebound",
        help="How far is a robot-arm motion from the fastest one there is, and why?",
        help_epilogue="`timebound NAME --help` shows the options of a command, with an example.",
        help_format="markdown",
        version=_version,
        default_parameter=Parameter(negative=(), show_default=_shown),
        group_arguments="Arguments",
        group_parameters="Options",
        help_on_error=False,
        suppress_keyboard_interrupt=False,
    )
    groups = {
        title: Group(title, sort_key=index)
        for index, title in enumerate(dict.fromkeys(c.group for c in COMMANDS.values()))
    }
    for command in COMMANDS.values():
        app.command(
            command.target,
            name=command.name,
            help=None if command.name == called else command.purpose,
            help_epilogue=f"Example: `{command.example}`",
            group=groups[command.group],
            sort_key=list(COMMANDS).index(command.name),
        )
    session = Group("Session", sort_key=len(groups))
    app.register_install_completion_command(group=session, help="Install completion for your shell.")
    for flag in ("--help", "--version"):
        app[flag].group = session
    return app


def first_steps() -> str:
    """Say what to do first: a task and its commands for each kind of user, then all commands.

    Returns
    -------
    str
        The page that ``timebound`` alone shows.
    """
    lines = ["timebound: how far is a robot-arm motion from the fastest one there is, and why?", ""]
    for task, *steps in _FIRST_STEPS:
        lines += [task, *(f"  {call:57}{answer}" for call, answer in steps), ""]
    for group in dict.fromkeys(command.group for command in COMMANDS.values()):
        listed = [c for c in COMMANDS.values() if c.group == group]
        lines += [group, *(f"  {c.name:19}{c.purpose}" for c in listed), ""]
    lines += [
        "FILE.toml states a problem (docs/reference/problem_file.md); the name of a shipped case, such as",
        "sr4c, stands for its file. timebound NAME --help shows the options of a command, with an example.",
    ]
    return "\n".join(lines)


def _shown(value: object) -> str | None:
    """Default value in a help screen; none for a switch that is off."""
    return None if value is False or value is None else str(value)


def _version() -> str:
    try:
        return metadata.version("timebound")
    except metadata.PackageNotFoundError:
        return "unknown: timebound is not installed"


def _line(error: CycloptsError) -> str:
    """One line that names key and value."""
    name = error.argument.name if error.argument is not None else ""
    if isinstance(error, ValidationError):
        text = f"{name}: {error.exception_message}"
    elif isinstance(error, CoercionError) and error.msg is not None:
        text = f"{name}: {error.msg}"
    elif isinstance(error, CoercionError):
        # cyclopts says: Invalid value for --name: unable to ..., or: Invalid value "x" for --name. ...
        text = f"{name}: {str(error).removeprefix(f'Invalid value for {name}: ')}"
    elif isinstance(error, MissingArgumentError) and error.command_chain:
        text = f"{name}: a value is missing (see timebound {error.command_chain[0]} --help)"
    elif isinstance(error, UnusedCliTokensError):
        text = f"{' '.join(error.unused_tokens or ())}: not expected here"
    else:
        text = str(error)
    return " ".join(text.split())


def _is_bad_input(error: Exception) -> bool:
    """Whether it is one of the named errors of the libraries, which are not loaded for this."""
    errors = sys.modules.get("formulations.problem.errors")
    return errors is not None and isinstance(error, errors.InputError | errors.NoFeasibleMotion)


if __name__ == "__main__":
    sys.exit(main())
