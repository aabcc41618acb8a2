"""Hints: one change to a paper's numbers at a time, and which of its faults that change would explain.

hint       what a hint says
places     the places of a paper that can disagree, and whether they do after a change
units      deg and rad, s, min and ms, m and mm
order      signs, columns and rows, limits of another table
dh_forms   other readings of the DH table
search     tries every change and keeps those that explain something

A hint is computed from the numbers alone and proves nothing: it says what was tried and what it would explain.
"""

from __future__ import annotations

from compare.audit.hints.hint import QUESTIONS, Hint
from compare.audit.hints.search import hints_of

__all__ = ["QUESTIONS", "Hint", "hints_of"]
