"""Paper 002 (Zhou 2025, UR5): every table and figure that can be made again, in its order."""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.zhou_2025 import angles, motion, times

ITEMS: tuple[Item, ...] = (*angles.ITEMS, *times.ITEMS, *motion.ITEMS)
