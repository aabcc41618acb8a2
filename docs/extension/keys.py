"""The directive ``timebound-keys``: the keys of a file format, from the lists that its reader goes by."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.util.docutils import SphinxDirective

from compare.audit.paper.keys import FORMAT
from formulations.problem.toml_file.keys import LIMIT_KEYS, POSE_KEYS, PROBLEM_KEYS

_TABLES = {"problem": PROBLEM_KEYS, "limits": LIMIT_KEYS, "pose": POSE_KEYS}
_MEANINGS = Path(__file__).with_name("paper_keys.toml")


class KeysDirective(SphinxDirective):
    """A table of keys: ``problem``, ``limits`` or ``pose`` of a problem file, or ``paper``."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Make the table.

        Returns
        -------
        list of Node
        """
        name = self.arguments[0]
        if name == "paper":
            rows = _paper(self)
        elif name in _TABLES:
            rows = [f"| `{key}` | {meaning} |" for key, meaning in _TABLES[name].items()]
        else:
            raise self.error(f"{name!r} is not known (known: paper, {', '.join(_TABLES)})")
        return self.parse_text_to_nodes("\n".join(["| key | what it holds |", "| --- | --- |", *rows]))


def _paper(directive: SphinxDirective) -> list[str]:
    """Rows of the keys of a paper's file; its reader knows the keys, and the meanings have to match them."""
    meanings = tomllib.loads(_MEANINGS.read_text("utf-8"))
    keys = list(_dotted(FORMAT))
    if odd := sorted(set(keys) ^ set(meanings)):
        raise directive.error(f"{_MEANINGS.name}: {', '.join(odd)}: not both read and explained")
    return [f"| `{key}` | {meanings[key]} |" for key in keys]


def _dotted(known: dict[str, Any], place: str = "") -> Iterator[str]:
    """Every key of a format at every depth: ``[table].key``, ``[[tables]].key``."""
    for key, expected in known.items():
        if isinstance(expected, dict):
            yield f"[{place}{key}]"
            yield from _dotted(expected, f"{place}{key}.")
        elif isinstance(expected, list):
            yield f"[[{key}]]"
            yield from _dotted(expected[0], f"{key}.")
        else:
            yield f"{place}{key}"
