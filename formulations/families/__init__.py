"""Spline families: rules that make durations into a spline through the waypoints.

One file each; add yours to ``FAMILIES``. ``polynomial`` holds the exact peaks and the stretch, which all share.
"""

from __future__ import annotations

from formulations.families.b_spline import B_SPLINE_3, B_SPLINE_5
from formulations.families.family import Family
from formulations.families.four_three_four import FOUR_THREE_FOUR
from formulations.families.quintic import QUINTIC
from formulations.families.three_five_three import THREE_FIVE_THREE

FAMILIES: dict[str, Family] = {
    family.name: family
    for family in (THREE_FIVE_THREE, FOUR_THREE_FOUR, QUINTIC, B_SPLINE_3, B_SPLINE_5)
}

__all__ = ["FAMILIES", "Family"]
