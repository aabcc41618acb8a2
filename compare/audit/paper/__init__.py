"""A paper as data: what it prints, read from its TOML file, and the task that its numbers state."""

from __future__ import annotations

from compare.audit.paper.digits import Printed
from compare.audit.paper.limits import StatedLimits, with_limits
from compare.audit.paper.reader import parse_papers
from compare.audit.paper.records import ArithmeticClaim, Paper, Point, PrintedTimes, Total
from compare.audit.paper.shipped import CASE_OF, PAPERS, load_papers, published_text, settings

__all__ = [
    "CASE_OF",
    "PAPERS",
    "ArithmeticClaim",
    "Paper",
    "Point",
    "Printed",
    "PrintedTimes",
    "StatedLimits",
    "Total",
    "load_papers",
    "parse_papers",
    "published_text",
    "settings",
    "with_limits",
]
