"""Every table and figure of the five papers that can be made again, printed beside reproduced."""

from __future__ import annotations

from compare.papers import li_2022 as bagging
from compare.papers import lu_2024 as z1
from compare.papers import wang_2025 as sr4c
from compare.papers import zhang_2025 as cobot
from compare.papers import zhou_2025 as ur5
from compare.papers.item import Item

ITEMS: dict[str, tuple[Item, ...]] = {
    "sr4c": sr4c.ITEMS,
    "bagging": bagging.ITEMS,
    "ur5": ur5.ITEMS,
    "z1": z1.ITEMS,
    "cobot": cobot.ITEMS,
}
"""Items by paper, in the order of the papers and of their pages."""
