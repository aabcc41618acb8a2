"""The directive ``timebound-registry``: one registry of the code as a table."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from docutils import nodes
from sphinx.util.docutils import SphinxDirective

from compare.citations.bibliography import entries
from compare.citations.cited import CITED, CitedKind
from formulations import CASES, FAMILIES, RUNGS, load
from formulations.proofs.family import PROVERS, affordable_gap
from metaheuristics import ALGORITHMS, GROUPS, NOT_REPRODUCIBLE

Table = tuple[tuple[str, ...], list[tuple[str, ...]]]  # header and rows, in Markdown


class RegistryDirective(SphinxDirective):
    """The registry that the argument names: cases, families, bounds, algorithms or references."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Make the table.

        Returns
        -------
        list of Node
        """
        name = self.arguments[0]
        if name == "references":
            text = "\n\n".join(entries().values())
            return self.parse_text_to_nodes(f"```bibtex\n{text}\n```")
        if name not in _TABLES:
            raise self.error(f"{name!r} is not known (known: references, {', '.join(_TABLES)})")
        header, rows = _TABLES[name]()
        lines = [header, tuple("---" for _ in header), *rows]
        return self.parse_text_to_nodes("\n".join(f"| {' | '.join(line)} |" for line in lines))


def _cases() -> Table:
    rows = []
    for name in CASES:
        problem = load(name)
        size = f"{len(problem.waypoints)} of {problem.dof} joints"
        rows.append(
            (f"`{name}`", problem.title, size, problem.family, " ".join(problem.source.split()))
        )
    return ("case", "title", "waypoints", "family", "source, and what is assumed"), rows


def _families() -> Table:
    rows = [
        (
            f"`{name}`",
            family.title,
            family.source,
            _proved(name),
        )
        for name, family in FAMILIES.items()
    ]
    return ("key", "what it is", "source", "bound that is proved"), rows


def _proved(family: str) -> str:
    """What is proved of a family where nothing else is asked for."""
    if family not in PROVERS:
        return "that of every motion"
    gap = np.format_float_scientific(affordable_gap(family)[0], trim="-", exp_digits=1)
    return f"to a gap of {gap}"


def _bounds() -> Table:
    rows = [
        (
            f"`{key}`",
            str(rung.kind.value),
            "yes" if rung.certified else "no",
            rung.meaning,
            ", ".join(_cited(CitedKind.rung, key)),
        )
        for key, rung in RUNGS.items()
    ]
    return ("key", "kind", "certified", "what the number says", "cited as"), rows


def _algorithms() -> Table:
    rows = [
        (
            f"`{name}`",
            f"{entry.title} ({GROUPS[entry.group]})",
            f"{entry.source} ({', '.join(_cited(CitedKind.algorithm, name))})",
            ", ".join(f"{key} = {value}" for key, value in entry.parameters.items()),
        )
        for name, entry in ALGORITHMS.items()
    ]
    rows += [
        (f"`{name}`", f"{one.title} (not reproducible: {one.reason})", one.source, "")
        for name, one in NOT_REPRODUCIBLE.items()
    ]
    return ("name", "what it is", "source, cited as", "parameters"), rows


def _cited(kind: CitedKind, name: str) -> list[str]:
    return [f"`{paper}`" for paper in CITED[kind][name]]


_TABLES: dict[str, Callable[[], Table]] = {
    "cases": _cases,
    "families": _families,
    "bounds": _bounds,
    "algorithms": _algorithms,
}
