"""Li 2022 (valve-bag robot, MPSO): every table and figure that can be made again, in the paper's order.

Each module is named by the tables and figures that it makes; the printed numbers stand in ``printed.toml``.
"""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.li_2022.figure_5 import FIGURE_5
from compare.papers.li_2022.figures_4_6 import FIGURE_4, FIGURE_6
from compare.papers.li_2022.table_2 import TABLE_2
from compare.papers.li_2022.table_3 import TABLE_3

ITEMS: tuple[Item, ...] = (TABLE_2, FIGURE_4, FIGURE_5, TABLE_3, FIGURE_6)
