"""Li 2022, Table 2: the joint angles of the seven points of Fig. 4, by inverse kinematics."""

from __future__ import annotations

from typing import Any

from compare.papers.inverse import make_inverse, show_inverse
from compare.papers.item import Item
from compare.papers.li_2022.paper import paper


def make_table_2(full: bool) -> dict[str, Any]:
    """Solve the points of Fig. 4 for the joint angles."""
    return make_inverse(paper())


TABLE_2 = Item(
    "Table 2",
    "joint angles of the seven points",
    make_table_2,
    show_inverse,
    "No orientation is printed for the points of Fig. 4: that of the printed angles is kept. Of several "
    "solutions the one nearest to the point before is taken.",
    cost=1.0,
)
