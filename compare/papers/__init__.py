"""Every table and figure of the papers that can be made again, printed beside reproduced.

One folder per paper, named by author and year, with its printed numbers in ``printed.toml`` and one module
per table or figure. ``item`` says what a table or figure is; ``measure``, ``verdicts``, ``words`` and
``pictures`` are shared; ``shelf`` stores, ``page`` writes the page.
"""

from __future__ import annotations

from compare.audit.paper import CASE_OF
from compare.papers import li_2022, lu_2024, wang_2025, zhang_2025, zhou_2025
from compare.papers.item import Item

_PAPERS: dict[str, tuple[Item, ...]] = {
    "wang_2025": wang_2025.ITEMS,
    "li_2022": li_2022.ITEMS,
    "zhou_2025": zhou_2025.ITEMS,
    "lu_2024": lu_2024.ITEMS,
    "zhang_2025": zhang_2025.ITEMS,
}
ITEMS: dict[str, tuple[Item, ...]] = {CASE_OF[key]: items for key, items in _PAPERS.items()}
"""Items by the case of their paper, in the order of the pages."""
