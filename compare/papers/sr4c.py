"""Paper 000 (Wang et al. 2025, SR4C): every table and figure that can be made again."""

from __future__ import annotations

from compare.papers import sr4c_swarm, sr4c_times
from compare.papers.item import Item

ITEMS: tuple[Item, ...] = (*sr4c_swarm.ITEMS, *sr4c_times.ITEMS)
