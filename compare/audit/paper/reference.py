"""The reference of the keys (docs/paper_file.md) and the template of a paper file, made of ``FORMAT``.

``python -m compare.audit.paper.reference > docs/paper_file.md`` writes the page anew.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping

from compare.audit.paper.format import FORMAT
from compare.audit.paper.keys import Key, KeyTable
from compare.audit.paper.settings_format import LEFT_OUT, SETTINGS

_WIDTH = 100  # characters of a comment

_PAGE = """\
# The paper file: what `timebound audit FILE` reads

`timebound audit --template mine.toml` writes a small paper that is sound, with a comment on every line. Put
the numbers of your paper in their place and delete what it does not print; `timebound audit mine.toml` judges
it. Only `family` and `[waypoints]` are needed.

- A number in quotes is rounded and stands as it is printed: `"0.8660"` is known to half a unit of its last
  digit, and a verdict holds for every number that prints like it. A number without quotes is exact.
- An unknown key is refused, with the nearest known one: a key that nobody reads would switch off a check in
  silence.
- Joints and waypoints count from 1. Times are in seconds.
- The files of the five shipped papers are `compare/papers/*/printed.toml`.

## Hints

Where numbers are wrong, the audit also tries one change at a time and names each that would explain faults and
makes nothing else wrong: what was tried, which places it would explain, how many of the faults it removes. A
hint is computed from the numbers alone and proves nothing. Nothing is said where no change explains anything.

- deg and rad mixed? Limits (all, or one quantity), waypoints (all, one, one joint), orientations.
- seconds and minutes or milliseconds mixed? Times, totals, or both, of one table.
- m and mm mixed? The positions of the points.
- one sign wrong? In the waypoints, or in the position of a point.
- two columns or rows swapped? In waypoints, limits, time vectors, points.
- limits of another table in force?
- another reading of the DH table? The form, the units, columns a and d, one sign, one length, and joint offsets
  of quarter and half turns of up to three joints. A reading that explains no fault is named if it brings every
  point four times as near.

A sum that leaves out a segment is named with the sum itself.

## Keys

This page is made of `compare/audit/paper/format.py`, which the reader of the file uses too.
"""


def reference() -> str:
    """Write the reference of all keys.

    Returns
    -------
    str
        Markdown: one table of keys per table of the file.
    """
    return "\n".join([_PAGE, *_sections("", KeyTable("", FORMAT)), ""])


def template() -> str:
    """Write a paper file with every key that a reviewer may need, each with its comment.

    Returns
    -------
    str
        TOML: a paper that the audit reads and finds nothing wrong with.
    """
    lines = [
        "# A paper as data. Numbers in quotes are rounded, digits as printed; numbers without quotes are",
        "# exact. Replace these by your paper's and delete what it does not print; lines that begin with",
        '# "#:" are further keys. Needed are the keys that say so.',
        *_body(FORMAT, ""),
    ]
    for name, entry in FORMAT.items():
        if isinstance(entry, KeyTable) and entry not in (SETTINGS, LEFT_OUT):
            mark = "" if entry.shown else "#:"
            lines += ["", *_comment(f"{entry.meaning}{' Needed.' if entry.needed else ''}")]
            lines += [f"{mark}{_head(name, entry)}", *_body(entry.keys, mark)]
    return "\n".join([*lines, ""])


def _head(name: str, table: KeyTable) -> str:
    return f"[[{name}]]" if table.many else f"[{name}]"


def _body(keys: Mapping[str, Key | KeyTable], mark: str) -> Iterator[str]:
    for name, key in keys.items():
        if isinstance(key, Key):
            unit = f" [{key.unit}]" if key.unit else ""
            yield from _comment(f"{key.meaning}{unit}{' (needed)' if key.needed else ''}")
            yield f"{mark if key.shown or mark else '#:'}{name} = {key.example}"


def _comment(text: str) -> list[str]:
    return textwrap.wrap(text, _WIDTH, initial_indent="# ", subsequent_indent="#   ")


def _sections(path: str, table: KeyTable) -> Iterator[str]:
    rows = [(name, key) for name, key in table.keys.items() if isinstance(key, Key)]
    if rows:
        yield "| key | meaning | type | unit | needed | example |"
        yield "|---|---|---|---|---|---|"
        for name, key in rows:
            cells = (f"`{name}`", key.meaning, key.kind, key.unit, "yes" if key.needed else "no")
            yield f"| {' | '.join(cells)} | `{key.example}` |"
        yield ""
    for name, entry in table.keys.items():
        if isinstance(entry, KeyTable):
            below = f"{path}.{name}" if path else name
            needed = "Needed." if entry.needed else "Not needed."
            repeated = " May stand several times." if entry.many else ""
            yield f"## `{_head(below, entry)}`\n\n{entry.meaning} {needed}{repeated}\n"
            yield from _sections(below, entry)


if __name__ == "__main__":
    print(reference(), end="")
