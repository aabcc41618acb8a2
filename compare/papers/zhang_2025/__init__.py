"""Paper 004 (Zhang et al. 2025, cobot): every table and figure that can be made again, in its order."""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.zhang_2025 import angles, motion, times

ITEMS: tuple[Item, ...] = (*angles.ITEMS, *times.ITEMS, *motion.ITEMS)
