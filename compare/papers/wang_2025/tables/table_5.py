"""Wang 2025, Table 5: the joint angles of the four path points of Table 4, by inverse kinematics."""

from __future__ import annotations

from typing import Any

from compare.papers.inverse import make_inverse, show_inverse
from compare.papers.item import Item
from compare.papers.wang_2025.paper import paper


def make_table_5(full: bool) -> dict[str, Any]:
    """Solve the poses of Table 4 for the joint angles."""
    return make_inverse(paper())


TABLE_5 = Item(
    "Table 5",
    "joint angles of the four path points",
    make_table_5,
    show_inverse,
    "The angles of Table 4 are read as roll, pitch and yaw about fixed axes. The arm is that of Table 1 with "
    "joint offsets, which are not printed. The paper does not say which of several solutions it means: the "
    "one nearest to the point before is taken.",
    cost=1.0,
)
