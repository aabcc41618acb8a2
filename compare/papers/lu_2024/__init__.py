"""Lu 2024 (Unitree Z1, B-spline, WOA): every table and figure that can be made again, in the paper's order.

Each module is named by the tables, figures and equations that it makes; the printed numbers stand in
``printed.toml``.
"""

from __future__ import annotations

from compare.papers.item import Item
from compare.papers.lu_2024.equations_4_5 import EQUATIONS_4_5
from compare.papers.lu_2024.equations_17_22 import EQUATIONS_17_22
from compare.papers.lu_2024.figure_1 import FIGURE_1
from compare.papers.lu_2024.figure_4 import FIGURE_4
from compare.papers.lu_2024.figure_5 import FIGURE_5
from compare.papers.lu_2024.figures_6_8 import FIGURES_6_8

ITEMS: tuple[Item, ...] = (EQUATIONS_4_5, EQUATIONS_17_22, FIGURE_1, FIGURE_4, FIGURE_5, FIGURES_6_8)
