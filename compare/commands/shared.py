"""What all commands share: one clear line for bad input, exit codes, safe writing, progress."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from formulations import InputError
from metaheuristics import ALGORITHMS, MissingLibraryError, UnknownAlgorithmError, algorithm

DONE, FAILED, BAD_INPUT = 0, 1, 2


def run(main: Callable[[], int]) -> None:
    """Run a command and exit: 0 done, 2 bad input, 1 anything else that failed, 130 interrupted."""
    try:
        code = main()
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        code = BAD_INPUT
    except KeyboardInterrupt:
        print("interrupted; what was finished is on disk", file=sys.stderr)
        code = 130
    except BrokenPipeError:
        sys.stderr.close()  # the reader has gone; say nothing more
        code = FAILED
    sys.exit(code)


def parser(name: str, purpose: str, example: str) -> argparse.ArgumentParser:
    """An argument parser whose help ends with an example."""
    return argparse.ArgumentParser(
        prog=f"python -m compare.{name}",
        description=purpose,
        epilog=f"example:\n  {example}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )


def chosen(kind: str, names: str | None, known: Iterable[str]) -> list[str]:
    """A comma-separated choice among known names; all of them if left out.

    Raises InputError that lists the known names.
    """
    known = list(known)
    if names is None:
        return known
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    for name in wanted:
        if name not in known:
            raise InputError(f"{kind}: {name!r} is not known (known: {', '.join(known)})")
    if not wanted:
        raise InputError(f"{kind}: none given (known: {', '.join(known)})")
    return list(dict.fromkeys(wanted))


def swarms(kind: str, names: str | None, standard: list[str]) -> list[str]:
    """A comma-separated choice of algorithms, each one found; the standard ones if left out.

    Raises InputError that says why there is none of a name, or how to install its library.
    """
    if names is None:
        return standard
    wanted = list(dict.fromkeys(name.strip() for name in names.split(",") if name.strip()))
    if not wanted:
        raise InputError(f"{kind}: none given (known: {', '.join(ALGORITHMS)})")
    for name in wanted:
        try:
            algorithm(name)
        except (UnknownAlgorithmError, MissingLibraryError) as error:
            raise InputError(f"{kind}: {error}") from error
    return wanted


def positive(kind: str, value: int) -> int:
    """The value, if it is at least 1; InputError otherwise."""
    if value < 1:
        raise InputError(f"{kind}: {value} is not positive")
    return value


def output_folder(path: str) -> Path:
    """A folder that can be written to, made if need be. Raises InputError in one line."""
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / ".writable"
        probe.write_bytes(b"timebound")
        probe.unlink()
    except OSError as error:
        raise InputError(f"--out: {path}: cannot be written: {error.strerror or error}") from None
    return folder


def write_text(path: Path, text: str) -> None:
    """Write a file whole or not at all. Raises InputError in one line."""
    temporary = path.with_name(path.name + ".part")
    try:
        with temporary.open("w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())  # or a power cut could leave the new name on an empty file
        os.replace(temporary, path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None


def write_json(path: Path, data: Any) -> None:
    """Write strict JSON (no NaN) whole or not at all."""
    write_text(path, json.dumps(data, indent=2, allow_nan=False) + "\n")


def table(header: Sequence[str], rows: Sequence[Sequence[str]], right: Sequence[int] = ()) -> str:
    """A plain text table; columns in ``right`` are aligned to the right."""
    widths = [max(len(str(row[i])) for row in [header, *rows]) for i in range(len(header))]
    lines = []
    for row in [header, ["-" * width for width in widths], *rows]:
        cells = [
            str(cell).rjust(width) if i in right else str(cell).ljust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append("  ".join(cells).rstrip())
    return "\n".join(lines)
