"""Lu 2024, Figs 6 to 8: both methods' motions, on made waypoints since the paper prints none."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from compare.papers.item import Item, ItemVerdict, Shown, Table
from compare.papers.lu_2024.equations_4_5 import by_rule
from compare.papers.lu_2024.figure_5 import RUNS, STARTS
from compare.papers.lu_2024.full_stops import FullStops
from compare.papers.lu_2024.other_waypoints import make_sets, sets_remarks, sets_table
from compare.papers.lu_2024.plan import between, losses, plan, printed_total, shared, solved, task
from compare.papers.measure import judged, spline
from compare.papers.pictures.panels import all_joints, panels, verdict_told
from compare.papers.verdicts import Reproduction, agrees, held, shown_gain, smooth
from compare.papers.words import percent
from compare.statistics.medians import Estimate, gain_over, median_of
from formulations import check, family_optimum

METHODS = {  # key: (name, whose total is printed, family or none, swarm)
    "b-spline-5": ("B-spline of degree 5, whales of Lu 2024", "B-spline with WOA", "b-spline-5",
                   "whale-lu-2024"),
    "quintic": ("quintic spline, whales of 2016", "quintic with WOA", "quintic", "whale"),
    "stops": ("quintic with a full stop at each waypoint, whales of 2016", "", "", "whale"),
    "b-spline-3": ("B-spline of degree 3, whales of Lu 2024", "", "b-spline-3", "whale-lu-2024"),
    "quintic, same whales": ("quintic spline, whales of Lu 2024", "", "quintic", "whale-lu-2024"),
}  # fmt: skip
_DRAWN = ("b-spline-5", "quintic")


def make_curves(full: bool) -> dict[str, Any]:
    """Run the paper's method and its rivals; compare the families alone on these and on other waypoints."""
    stops = FullStops(task("quintic"))
    found = {}
    for key, (_, _, family, swarm) in METHODS.items():
        objective = shared(family) if family else stops
        found[key] = plan(objective, stops.problem.n_segments, swarm, RUNS[full])
        del found[key]["descent"]
    medians, ends = {}, {}
    for key in _DRAWN:
        durations = found[key]["durations"]
        medians[key] = None if durations is None else judged(task(key), durations)
        if durations is not None:
            motion = spline(task(key), durations)
            edge = np.abs([motion.at([0.0, motion.seconds], order) for order in (1, 2)]).max()
            ends[key] = {"jump": float(motion.jumps[1:].max()), "edge": float(edge)}
    optima = {key: family_optimum(task(key), starts=STARTS[full]).seconds for key in _DRAWN}
    shortest = check(stops.problem, stops.trajectory(stops.least))
    return {
        "found": found,
        "medians": medians,
        "ends": ends,
        "optima": {**optima, "stops": shortest.seconds},
        "stops_keep": shortest.feasible,
        "rules": by_rule("b-spline-5"),
        "others": make_sets(full),
    }


def show_curves(data: dict[str, Any]) -> Shown:
    """Show the times of both methods, then the curves of both, then other sets of waypoints."""
    rows = []
    for key, (name, printed, *_) in METHODS.items():
        entry = data["found"][key]
        times = [seconds for seconds in entry["seconds"] if seconds is not None]
        rows.append(
            [
                name,
                printed_total(printed) if printed else "",
                between(median_of(losses(entry))),
                f"{min(times):.2f} to {max(times):.2f}" if times else "",
                solved(entry),
                f"{data['optima'][key]:.3f}" if key in data["optima"] else "",
            ]
        )
    for name, motion in data["rules"].items():
        kept = "" if motion["keeps"] else f", {motion['excess']:.2f} rad beyond the position limits"
        rows.append(
            [
                f"B-spline of degree 5, no swarm: {name}",
                "",
                f"{motion['seconds']:.2f}{kept}",
                "",
                "",
                "",
            ]
        )
    header = ["method", "printed, other waypoints [s]", "reproduced, median [s]", "all runs [s]",
              "solved", "best known of the family [s]"]  # fmt: skip
    caption = (
        "Total times: as printed in sec. 3.2, and on the waypoints of the case z1, budget as printed. In "
        "brackets the 95 % interval of the median, between two of the runs."
    )
    columns = []
    for key in _DRAWN:
        median = data["medians"][key]
        if median is not None:
            title = f"{METHODS[key][0]}, {median['seconds']:.2f} s:\n{verdict_told(median)}"
            columns.append(all_joints(title, task(key), median["durations"]))
    parts: list[Table | Figure] = [Table(header, rows, caption, (1, 2, 3, 4, 5))]
    if columns:
        parts.append(panels(columns))
    return Shown([*parts, sets_table(data["others"])], _remarks(data), _verdicts(data))


RIVALS = {
    "quintic": "the gain of the B-spline over the quintic spline",
    "quintic, same whales": "the same gain, the same whales for both",
    "stops": "the same gain, over a quintic with a full stop at each waypoint",
}


def _gain(data: dict[str, Any], rival: str) -> tuple[Estimate, Reproduction]:
    """By how much the B-spline is shorter than a rival, and what that leaves of the printed gain."""
    found = gain_over(*(losses(data["found"][key]) for key in ("b-spline-5", rival)), seed=0)
    return found, shown_gain(_claimed(), found.value, found.low, found.high)


def _claimed() -> float:
    spline_5, quintic = (float(printed_total(METHODS[key][1])) for key in _DRAWN)
    return 1.0 - spline_5 / quintic


def _verdicts(data: dict[str, Any]) -> list[ItemVerdict]:
    verdicts = [ItemVerdict(what, _gain(data, rival)[1]) for rival, what in RIVALS.items()]
    if "b-spline-5" in data["ends"]:
        calm = smooth(*data["ends"]["b-spline-5"].values())
        verdicts.append(
            ItemVerdict("that the B-spline is continuous, and at rest at its ends", held(calm))
        )
    return verdicts


def _remarks(data: dict[str, Any]) -> list[str]:
    optima = data["optima"]
    printed = [float(printed_total(METHODS[key][1])) for key in _DRAWN]
    claimed = _claimed()
    times = {key: losses(entry) for key, entry in data["found"].items()}
    runs = len(times["quintic"])
    first, outcome = _gain(data, "quintic")
    alike, outcome_alike = _gain(data, "quintic, same whales")
    inside = first.low <= claimed <= first.high
    remarks = [
        f"The waypoints are our own: the printed {printed[0]:.2f} s and {printed[1]:.2f} s cannot be "
        "reproduced, only which method is the shorter one.",
        f"{outcome}: by the medians of {runs} runs each, the B-spline is {_shorter(first.value)} than the "
        f"quintic ({_interval(first)}; printed: {_shorter(claimed)}, which lies "
        f"{'inside' if inside else 'outside'}). With the same whales for both it is {_shorter(alike.value)} "
        f"({_interval(alike)}): {outcome_alike.inside}.",
        _stops(data),
    ]
    apart = 1.0 - optima["b-spline-5"] / optima["quintic"]
    left = {key: median_of(times[key]).value / optima[key] - 1.0 for key in _DRAWN}
    remarks.append(
        f"The best known motions of both families take {optima['b-spline-5']:.3f} s and "
        f"{optima['quintic']:.3f} s: without any swarm the B-spline is {_shorter(apart)}. The median whales "
        "end above the optimum of their own family by "
        + " and ".join(percent(gap) for gap in left.values())
        + "."
    )
    remarks.append(_rules(data, median_of(times["b-spline-5"])))
    remarks += sets_remarks(data["others"])
    cubic = gain_over(times["b-spline-5"], times["b-spline-3"], seed=0)
    remarks.append(
        f"The other reading of the degree, 3: degree 5 is {_shorter(cubic.value)} ({_interval(cubic)})."
    )
    if "b-spline-5" in data["ends"]:
        ends = data["ends"]["b-spline-5"]
        calm = smooth(ends["jump"], ends["edge"])
        remarks.append(
            f"The B-spline is {'continuous and at rest' if calm else 'not continuous or not at rest'} at its "
            f"ends, {agrees(calm)} (Figs 7 and 8): velocity and acceleration jump by {ends['jump']:.0e} at "
            f"most and are {ends['edge']:.0e} rad/s or rad/s² at the ends. The motion uses most of the "
            f"{data['medians']['b-spline-5']['most']}."
        )
    return remarks


def _stops(data: dict[str, Any]) -> str:
    """Say what is left of the gain if the rival stops at each waypoint."""
    least, quintic = data["optima"]["stops"], median_of(losses(data["found"]["quintic"])).value
    bspline = median_of(losses(data["found"]["b-spline-5"])).value
    gain, outcome = _gain(data, "stops")
    return (
        f"The second reading of the rival, a quintic with a full stop at each waypoint, takes {least:.2f} s "
        f"at best ({'keeps' if data['stops_keep'] else 'breaks'} all limits), in closed form and without a "
        f"swarm: that is {_shorter(1.0 - least / quintic)} than the median of the whales on the quintic "
        f"spline, and the whales' B-spline is {_shorter(1.0 - bspline / least)} than it. Against whales on "
        f"this rival: {outcome.inside}, the B-spline is {_shorter(gain.value)} ({_interval(gain)})."
    )


def _rules(data: dict[str, Any], whales: Estimate) -> str:
    """Set the durations that need no search beside the whales."""
    kept = {name: motion for name, motion in data["rules"].items() if motion["keeps"]}
    if not kept:
        return "None of the durations that need no search keeps all limits."
    name = min(kept, key=lambda key: kept[key]["seconds"])
    seconds = kept[name]["seconds"]
    within = whales.low <= seconds <= whales.high
    return (
        f"Durations without a search, one evaluation: {name}, {seconds:.2f} s within all limits, "
        f"{_shorter(1.0 - seconds / whales.value)} than the whales' median of {whales.value:.2f} s and "
        f"{'inside' if within else 'outside'} its 95 % interval."
    )


def _interval(gain: Estimate) -> str:
    return f"95 % interval {percent(gain.low)} to {percent(gain.high)}"


def _shorter(gain: float) -> str:
    """By how much one motion is shorter or longer than another."""
    return f"{percent(abs(gain))} {'shorter' if gain > 0.0 else 'longer'}"


FIGURES_6_8 = Item(
    "Figs 6-8",
    "position, velocity and acceleration of the joints, B-spline and quintic",
    make_curves,
    show_curves,
    "Waypoints of our own. The paper does not say which velocities the quintic has at inner waypoints: zero "
    "where a joint turns, else the mean of both sides; the other reading is a full stop at each waypoint. The "
    "limits are in degrees, printed as radians.",
    cost=18.0,
)
