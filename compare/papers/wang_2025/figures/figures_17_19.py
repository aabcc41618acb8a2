"""Wang 2025, Figs 17 to 19: the curves of every joint with the optimised times, on the arm itself."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.verdicts import agrees, held, smooth
from compare.papers.wang_2025.motions import BEST, PLAN, RULE, STYLES, curves, motions
from compare.papers.wang_2025.paper import fitting_limits, paper
from compare.papers.words import above, listed
from formulations import load

SAID = (1, 5)
"""Joints whose acceleration grows markedly, by sec. 4.3.2."""


def make_verification(full: bool) -> dict[str, Any]:
    """Judge the printed result, the plan and the optimum; find their peaks and jumps."""
    single = [row for row in paper().rows if row.where.startswith("Table 9")]
    return {
        "motions": motions(list(STYLES)),
        "limits": np.degrees(load("sr4c").limits.derivatives[:2]).tolist(),
        "fitting": [fitting_limits(row)[1] for row in single],
    }


def show_verification(data: dict[str, Any]) -> Shown:
    """Show every joint with its limits, the peaks, and by how much the accelerations grow."""
    found, limits, fitting = data["motions"], data["limits"], data["fitting"]
    plan, rule, best = (found[name] for name in (PLAN, RULE, BEST))
    header = ["joint", "velocity limit [deg/s]", "plan", "result", "optimum", "acceleration limit [deg/s²]",
              "plan", "result", "optimum", "result over plan", "limit that fits Table 9",
              "result over it"]  # fmt: skip
    grown = [r / p for r, p in zip(rule["peaks"][1], plan["peaks"][1], strict=True)]
    beyond = [r / limit for r, limit in zip(rule["peaks"][1], fitting, strict=True)]
    rows = []
    for j in range(len(fitting)):
        row = [str(j + 1)]
        for order in range(2):
            row.append(f"{limits[order][j]:g}")
            row += [f"{m['peaks'][order][j]:.2f}" for m in (plan, rule, best)]
        rows.append([*row, f"{grown[j]:.2f}", f"{fitting[j]:.3g}", f"{beyond[j]:.2f}"])
    table = Table(
        header,
        rows,
        "Peaks of velocity [deg/s] and of acceleration [deg/s²] of the plan (Figs 7-9), of the printed result "
        "and of the optimum. The limits that fit Table 9 are the lowest of two digits that its joints keep.",
        range(1, len(header)),
    )
    joined = smooth(*rule["jumps"])
    kept = rule["digits"] != "no"
    remarks = [
        f"The printed result takes {rule['seconds']:.4f} s. Position, velocity and acceleration are "
        f"{'continuous' if joined else 'not continuous'} at the waypoints, {agrees(joined)} (largest jump "
        f"{max(rule['jumps']):.1g} deg, deg/s or deg/s²).",
        f"It keeps the limits of Table 6: {rule['digits']} ({rule['most']}), {agrees(kept)}.",
        f"Sec. 4.3.2 says that the acceleration grows markedly at joints {listed(SAID)}. Against the plan of "
        f"2 s a segment it grows {_most(grown)}. Of the limits of acceleration that fit Table 9 it reaches "
        f"{_most(beyond)}.",
        f"The optimum of the same spline family takes {best['seconds']:.4f} s: "
        f"{above(best['seconds'], rule['seconds'])} against the printed result and "
        f"{above(best['seconds'], plan['seconds'])} against the plan.",
    ]
    most = f"that the acceleration grows most at joints {listed(SAID)}"
    verdicts = [
        ItemVerdict("that the motion is continuous at the waypoints", held(joined)),
        ItemVerdict("that it keeps the limits of Table 6", held(kept)),
        ItemVerdict(f"{most}, against the plan", held(_where(grown) == SAID)),
        ItemVerdict(f"{most}, against the limits that fit Table 9", held(_where(beyond) == SAID)),
    ]
    return Shown([curves(found), table], remarks, verdicts)


def _order(factors: list[float]) -> list[int]:
    """Joints, that with the largest factor first."""
    return sorted(range(1, len(factors) + 1), key=lambda joint: -factors[joint - 1])


def _where(factors: list[float]) -> tuple[int, ...]:
    """Return the joints with the largest factors, as many as the text names."""
    return tuple(sorted(_order(factors)[: len(SAID)]))


def _most(factors: list[float]) -> str:
    """Which joints have the largest factors, and whether the text names these."""
    order, first = _order(factors), _where(factors)
    shown = [f"{factors[joint - 1]:.2f} times at joint {joint}" for joint in order[: len(SAID) + 1]]
    return f"{listed(shown)}: most at joints {listed(first)}, {agrees(first == SAID)}"


FIGURES_17_19 = Item(
    "Figs 17-19",
    "angle, velocity and acceleration of every joint with the optimised times",
    make_verification,
    show_verification,
    "The printed curves come from the controller of the arm, cycle by cycle. The paper prints neither these "
    "data nor the cycle: the same times in the spline, which the controller followed, stand for them. The plan "
    "of Figs 7-9 and the optimum are added.",
    cost=1.5,
)
