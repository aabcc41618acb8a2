"""The audit as a chapter of the report: from stored JSON (``Audit.to_json``) to rows of text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from compare.audit.findings import FAULTS, NOTES
from compare.audit.judged import JudgedTimes

_PROVED = 1e-4  # relative gap below which an optimum counts as proved in a table

HEADER = ("time vector", "total", "keeps limits", "stretch", "honest", "optimum", "own limits")
CAPTION = (
    "Totals in s. Stretch: least factor on all times that keeps the stated limits; honest: the total "
    "after it; optimum: certified, under the stated limits; own limits: the same under the least "
    "limits that the motion itself keeps. Two numbers: where the proof ends, and the best motion known."
)


def chapter(audits: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Turn stored audits into text, ready for a template.

    Parameters
    ----------
    audits : iterable of dict
        As ``Audit.to_json`` gives them.

    Returns
    -------
    list of dict
        One per paper: name, title, source, notes; header, caption and rows (cells as text; feasible);
        faults and notes_found, each a list of kind, meaning, proved and items (where, text); hints, each
        with question and text. What concerns all joints together comes first.
    """
    return [
        {
            "name": data["paper"],
            "title": data["title"],
            "source": data["source"],
            "notes": data["notes"],
            "header": HEADER,
            "caption": CAPTION,
            "rows": [
                {"cells": cells(row), "feasible": row.feasible}
                for row in (JudgedTimes(**motion) for motion in data["motions"])
            ],
            "faults": _by_kind(data, FAULTS),
            "notes_found": _by_kind(data, NOTES),
            "hints": data.get("hints", []),  # stores of earlier versions have none
        }
        for data in audits
    ]


def cells(row: JudgedTimes) -> list[str]:
    """Write one time vector as text.

    Parameters
    ----------
    row : JudgedTimes
        As the audit or the store gives it.

    Returns
    -------
    list of str
        In the order of ``HEADER``.
    """
    factor, honest = ("-" if value is None else f"{value:.4f}" for value in (row.stretch, row.honest))
    stated = _proved(row.minimum, row.optimum)
    own = _proved(row.implied_minimum, row.implied_optimum)
    return [row.where, f"{row.total:.4f}", row.feasible, factor, honest, stated, own]


def _proved(least: float | None, best: float | None) -> str:
    """Write a certified optimum; while its proof is open, write the bound and the best time."""
    if least is None or best is None:
        return "-"
    return f"{best:.4f}" if best <= least * (1.0 + _PROVED) else f"{least:.4f}, {best:.4f}"


def _by_kind(data: dict[str, Any], kinds: dict[str, str]) -> list[dict[str, Any]]:
    groups = []
    whole = {row["where"] for row in data["motions"] if row["joint"] is None}
    findings = sorted(data["findings"], key=lambda f: f["where"] not in whole)
    for kind, meaning in kinds.items():
        found = [f for f in findings if f["kind"] == kind]
        if found:
            groups.append(
                {
                    "kind": kind,
                    "meaning": meaning,
                    "proved": any(f["proved"] for f in found),
                    "items": [{"where": f["where"], "text": f["text"]} for f in found],
                }
            )
    return groups
