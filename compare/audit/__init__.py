"""Audit of published results: ``python -m compare.audit``.

``paper`` reads what a paper prints, ``motion`` puts its time vectors back into the spline, ``findings``
judges them, ``hints`` looks for one change that would explain what is wrong, ``whole_paper`` runs everything,
``chapters`` writes it down.
"""

from __future__ import annotations

from compare.audit.chapters import chapter
from compare.audit.findings import FAULTS, IN_SHORT, NOTES, Finding
from compare.audit.paper import CASE_OF, PAPERS, Paper, load_papers, parse_papers, published_text
from compare.audit.whole_paper import Audit, audit

__all__ = [
    "CASE_OF",
    "FAULTS",
    "IN_SHORT",
    "NOTES",
    "PAPERS",
    "Audit",
    "Finding",
    "Paper",
    "audit",
    "chapter",
    "load_papers",
    "parse_papers",
    "published_text",
]
