"""Wang 2025 (SIASUN SR4C, MIPSO): every table, figure and system that can be made again, in its order.

Each module is named by the tables and figures that it makes: Table 8 is ``tables/table_8``. What several of
them share stands beside the two folders: joint 1 of Tables 8 and 10 and Figs 10 and 12 to 14 in ``joint_1``,
the motions of Figs 7 to 9, 11 and 17 to 19 in ``motions``, the runs of Table 3 in ``ablation`` and
``cec2017``; the printed numbers in ``printed.toml``.
"""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.wang_2025.equations_5_7 import EQUATIONS_5_7
from compare.papers.wang_2025.figures.figure_10 import FIGURE_10
from compare.papers.wang_2025.figures.figure_11 import FIGURE_11
from compare.papers.wang_2025.figures.figures_4_5 import FIGURE_4, FIGURE_5
from compare.papers.wang_2025.figures.figures_7_9 import FIGURES_7_9
from compare.papers.wang_2025.figures.figures_17_19 import FIGURES_17_19
from compare.papers.wang_2025.tables.table_3 import TABLE_3
from compare.papers.wang_2025.tables.table_5 import TABLE_5
from compare.papers.wang_2025.tables.table_8 import TABLE_8
from compare.papers.wang_2025.tables.table_9 import TABLE_9
from compare.papers.wang_2025.tables.table_10 import FIGURES_12_14, TABLE_10

ITEMS: tuple[Item, ...] = (
    EQUATIONS_5_7,
    FIGURE_4,
    FIGURE_5,
    TABLE_3,
    TABLE_5,
    FIGURES_7_9,
    TABLE_8,
    FIGURE_10,
    TABLE_9,
    FIGURE_11,
    TABLE_10,
    FIGURES_12_14,
    FIGURES_17_19,
)
