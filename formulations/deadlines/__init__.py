"""When a computation has to end: a time limit or an interrupt, and how IPOPT is stopped by either."""

from __future__ import annotations

from formulations.deadlines.deadline import NEVER, Deadline

__all__ = ["NEVER", "Deadline"]
