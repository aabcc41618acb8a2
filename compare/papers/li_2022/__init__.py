"""Paper 001 (Li et al. 2022, valve-bag robot): every table and figure that can be made again, in its order."""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.li_2022 import evolution, joints, motions

_ORDER = ("Table 2", "Fig 4", "Fig 5", "Table 3", "Fig 6")
_PARTS = (evolution, joints, motions)
_BY_LABEL = {item.label: item for part in _PARTS for item in part.ITEMS}
ITEMS: tuple[Item, ...] = tuple(_BY_LABEL[label] for label in _ORDER)
