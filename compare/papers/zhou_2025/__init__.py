"""Zhou 2025 (UR5, ISSA): every table and figure that can be made again, in the paper's order.

Each module is named by the tables and figures that it makes; the printed numbers stand in ``printed.toml``.
"""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.zhou_2025.figures_5_7 import FIGURE_5, FIGURE_6, FIGURE_7
from compare.papers.zhou_2025.table_2 import TABLE_2
from compare.papers.zhou_2025.tables_4_6 import TABLES_4_6

ITEMS: tuple[Item, ...] = (TABLE_2, TABLES_4_6, FIGURE_5, FIGURE_6, FIGURE_7)
