"""Lu 2024, eq. 4, 5: chord-length parameters, the durations that need no search."""

from __future__ import annotations

import math
from typing import Any

from compare.papers.item import Item, Shown, Table
from compare.papers.lu_2024.plan import task
from compare.papers.measure import judged
from compare.papers.verdicts import yes_no
from compare.papers.words import above, percent
from formulations import FAMILIES, chord_lengths, family_optimum

RULES = {
    "chord lengths (eq. 4, 5)": 1.0,
    "square roots of chord lengths (centripetal, Lee 1989)": 0.5,
    "equal durations": 0.0,
}
EQ_5 = next(iter(RULES))


def by_rule(family: str) -> dict[str, dict[str, Any]]:
    """Judge the motions of all rules on z1, each scaled to its derivative limits.

    Parameters
    ----------
    family : str
        A key of ``FAMILIES``.

    Returns
    -------
    dict
        By rule: what ``measure.judged`` says, and excess over the position limits [rad].
    """
    problem, found = task(family), {}
    for name, power in RULES.items():
        durations = chord_lengths(problem, power=power)
        excess = float(FAMILIES[family].position_excess(problem, durations[None])[0])
        found[name] = {**judged(problem, durations), "excess": excess}
    return found


def make_chords(full: bool) -> dict[str, Any]:
    """Judge the rules in both degrees, beside the best known B-spline."""
    optimum = family_optimum(task("b-spline-5"), starts=None if full else 1)
    return {"5": by_rule("b-spline-5"), "3": by_rule("b-spline-3"), "optimum": optimum.seconds}


def show_chords(data: dict[str, Any]) -> Shown:
    """Show what the rules give."""
    rows = [
        [name, degree, f"{motion['seconds']:.3f}", above(motion["seconds"], data["optimum"]),
         f"{motion['excess']:.3f} ({math.degrees(motion['excess']):.1f} deg)", yes_no(motion["keeps"])]
        for degree in ("5", "3")
        for name, motion in data[degree].items()
    ]  # fmt: skip
    header = ["durations in proportion to", "degree", "total [s]", "above the best known of degree 5",
              "beyond the position limits [rad]", "keeps all limits"]  # fmt: skip
    caption = (
        "Each is scaled by the least factor that keeps velocity and acceleration. Position limits depend on "
        f"the ratios alone. The best known B-spline of degree 5 takes {data['optimum']:.3f} s."
    )
    chord = data["5"][EQ_5]
    kept = {name: motion for name, motion in data["5"].items() if motion["keeps"]}
    remarks = [
        f"Chord-length durations take {chord['seconds']:.2f} s, "
        f"{percent(chord['seconds'] / data['optimum'] - 1.0)} more than the best known, and "
        + (
            "keep all limits."
            if chord["keeps"]
            else f"leave the position limits by {chord['excess']:.2f} rad: they are no motion for the "
            "arm, and no scaling mends them."
        )
    ]
    if kept:
        best = min(kept, key=lambda name: kept[name]["seconds"])
        remarks.append(
            f"The shortest of the {len(RULES)} rules that keeps all limits is: {best}. It takes "
            f"{kept[best]['seconds']:.2f} s, {above(kept[best]['seconds'], data['optimum'])} against the "
            "best known, and costs one evaluation. Figs 6-8 set the whales beside it."
        )
    return Shown([Table(header, rows, caption, range(1, 6))], remarks, ())


EQUATIONS_4_5 = Item(
    "Eqs 4, 5",
    "chord-length parameters: durations without a search",
    make_chords,
    show_chords,
    "The paper gives chord-length parameters as one way to get the parameters of the waypoints, and then "
    "searches for better ones. The length of a chord is that of all joints together [rad]. Waypoints of our "
    "own "
    "(case z1).",
    cost=4.0,
)
