"""Paper 003 (Lu & Wang 2024, Unitree Z1): every table and figure that can be made again, in its order."""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.lu_2024 import arm, chaos, motion

ITEMS: tuple[Item, ...] = (*chaos.ITEMS, *arm.ITEMS, *motion.ITEMS)
