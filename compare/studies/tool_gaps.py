"""How far the motions found under a limit of the tool's speed are from their lower bounds, on random problems.

``python -m compare.studies.tool_gaps`` draws 100 problems of the UR5 of Zhou 2025 (3 to 5 waypoints, joints
within 1.5 rad, 3.14 rad/s, 10 rad/s^2, 100 rad/s^3, tool at 0.2 to 1 m/s) and prints a line for each, then
the quantiles.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from formulations import Conditions, Problem, free_form, free_form_bound
from formulations.arms import load_arm

_COUNT = 100
_TIME = 5.0  # s for the bound, beyond its first linear program


def problems(count: int, seed: int = 0) -> Iterator[Problem]:
    """Draw problems.

    Parameters
    ----------
    count : int
        How many.
    seed : int
        Of the random numbers.

    Yields
    ------
    Problem
        With a limit of the tool's speed.
    """
    rng = np.random.default_rng(seed)
    for number in range(count):
        points = rng.uniform(-1.5, 1.5, (int(rng.integers(3, 6)), 6))
        yield Problem(
            points,
            {"velocity": 3.14, "acceleration": 10.0, "jerk": 100.0},
            name=f"ur5-tool-{number}",
            tool=load_arm("ur5").tool,
            conditions=Conditions(tool_speed=float(rng.uniform(0.2, 1.0))),
        )


def main() -> None:
    """Print the gaps."""
    gaps = []
    for problem in problems(_COUNT):
        found = free_form(problem, tolerance=1e-2)
        bound = free_form_bound(problem, upper=found.seconds, gap=1e-2, time_limit=_TIME)
        slow = found.stages[0].seconds  # the motion without the limit, slowed down as a whole
        gaps.append((bound.gap, slow / bound.seconds - 1.0, found.runtime + bound.runtime))
        print(
            f"{problem.name}: {problem.n_segments} segments, {problem.conditions.tool_speed:.3f} m/s: "
            f"{found.seconds:.4f} s ({found.method}), bound {bound.seconds:.4f} s, gap {bound.gap:.2%}, "
            f"slowed down as a whole {slow:.4f} s, {gaps[-1][2]:.1f} s",
            flush=True,
        )
    quantiles = np.quantile(np.array(gaps, dtype=np.float64), [0.1, 0.5, 0.9, 1.0], axis=0)
    print(
        "10 %, 50 %, 90 %, 100 %: gap, gap of the motion slowed down as a whole, seconds of computation"
    )
    print(quantiles.round(4).tolist())


if __name__ == "__main__":
    main()
