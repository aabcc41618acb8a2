"""Paper 000 (Wang et al. 2025, SR4C): every table and figure that can be made again, in its order."""

from __future__ import annotations

from compare.papers import (
    sr4c_ablation,
    sr4c_joint_1,
    sr4c_joints,
    sr4c_motions,
    sr4c_speeds,
    sr4c_swarm,
)
from compare.papers.item import Item

_ORDER = ("Fig 4", "Fig 5", "Table 3", "Table 5", "Figs 7-9", "Table 8", "Fig 10", "Table 9", "Fig 11",
          "Table 10", "Figs 12-14")  # fmt: skip
_PARTS = (sr4c_ablation, sr4c_joint_1, sr4c_joints, sr4c_motions, sr4c_speeds, sr4c_swarm)
_BY_LABEL = {item.label: item for part in _PARTS for item in part.ITEMS}
ITEMS: tuple[Item, ...] = tuple(_BY_LABEL[label] for label in _ORDER)
