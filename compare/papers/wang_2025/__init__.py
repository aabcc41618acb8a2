"""Paper 000 (Wang et al. 2025, SR4C): every table and figure that can be made again, in its order."""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.wang_2025 import ablation, joint_1, joints, motions, speeds, swarm

_ORDER = ("Fig 4", "Fig 5", "Table 3", "Table 5", "Figs 7-9", "Table 8", "Fig 10", "Table 9", "Fig 11",
          "Table 10", "Figs 12-14")  # fmt: skip
_PARTS = (ablation, joint_1, joints, motions, speeds, swarm)
_BY_LABEL = {item.label: item for part in _PARTS for item in part.ITEMS}
ITEMS: tuple[Item, ...] = tuple(_BY_LABEL[label] for label in _ORDER)
