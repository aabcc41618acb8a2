"""Audit of published results: ``python -m compare.audit``."""

from __future__ import annotations

from compare.audit.audit import Audit, audit
from compare.audit.chapter import chapter
from compare.audit.findings import FAULTS, NOTES, Finding
from compare.audit.paper import Paper
from compare.audit.paper_file import PAPERS, load_papers, parse_papers

__all__ = [
    "FAULTS",
    "NOTES",
    "PAPERS",
    "Audit",
    "Finding",
    "Paper",
    "audit",
    "chapter",
    "load_papers",
    "parse_papers",
]
