"""Zhang 2025 (moxibustion cobot, improved PSO): every table and figure that can be made again, in order.

Each module is named by the tables and figures that it makes; the printed numbers stand in ``printed.toml``.
"""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.zhang_2025.figures_6_9 import FIGURE_6, FIGURES_7_9
from compare.papers.zhang_2025.table_3 import TABLE_3
from compare.papers.zhang_2025.table_4 import TABLE_4

ITEMS: tuple[Item, ...] = (TABLE_3, TABLE_4, FIGURE_6, FIGURES_7_9)
