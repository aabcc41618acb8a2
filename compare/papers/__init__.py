"""Every table and figure of the five papers that can be made again, printed beside reproduced."""

from __future__ import annotations

from compare.papers import bagging, cobot, sr4c, ur5, z1
from compare.papers.item import Item

ITEMS: dict[str, tuple[Item, ...]] = {
    "sr4c": sr4c.ITEMS,
    "bagging": bagging.ITEMS,
    "ur5": ur5.ITEMS,
    "z1": z1.ITEMS,
    "cobot": cobot.ITEMS,
}
"""Items by paper, in the order of the papers and of their pages."""
