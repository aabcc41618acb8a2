"""The directive ``timebound-keys``: the keys of a problem file, from the lists that its reader goes by."""

from __future__ import annotations

from docutils import nodes
from sphinx.util.docutils import SphinxDirective

from formulations.problem.toml_file.keys import (
    CONDITION_KEYS,
    LIMIT_KEYS,
    POSE_KEYS,
    PROBLEM_KEYS,
    SEGMENT_KEYS,
    WAYPOINT_KEYS,
)

_TABLES = {
    "problem": PROBLEM_KEYS,
    "limits": LIMIT_KEYS,
    "pose": POSE_KEYS,
    "conditions": CONDITION_KEYS,
    "waypoint": WAYPOINT_KEYS,
    "segment": SEGMENT_KEYS,
}


class KeysDirective(SphinxDirective):
    """A table of keys, by a name of ``_TABLES``."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Make the table.

        Returns
        -------
        list of Node
        """
        name = self.arguments[0]
        if name not in _TABLES:
            raise self.error(f"{name!r} is not known (known: {', '.join(_TABLES)})")
        rows = [f"| `{key}` | {meaning} |" for key, meaning in _TABLES[name].items()]
        return self.parse_text_to_nodes("\n".join(["| key | what it holds |", "| --- | --- |", *rows]))
