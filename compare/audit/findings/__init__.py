"""What can be wrong with a paper's numbers: one module per kind of evidence, each a list of findings."""

from __future__ import annotations

from compare.audit.findings.finding import FAULTS, IN_SHORT, NOTES, Finding

__all__ = ["FAULTS", "IN_SHORT", "NOTES", "Finding"]
