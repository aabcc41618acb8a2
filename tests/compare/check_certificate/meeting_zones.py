"""Random motions under demands, with zones that meet and joints that are limited in velocity alone."""

from __future__ import annotations

import numpy as np
from demanded_motions import Scenario, scenario


def drawn(
    rng: np.random.Generator, ends: str, *, n: int | None = None, times: str = "some"
) -> Scenario:
    """A motion and its demands; some zones meet, and some joints are limited in velocity alone."""
    made = scenario(rng, ends, n=int(rng.integers(2, 6)) if n is None else n, times=times)
    x = made.demands["waypoints"]
    for i in np.flatnonzero(rng.random(len(x) - 2) < 0.4) + 1:
        x[i, :, 0] = np.minimum(x[i, :, 0], x[i - 1].mean(axis=1))
        x[i, :, 1] = np.maximum(x[i, :, 1], x[i - 1].mean(axis=1))
    jumps = ~np.isfinite(made.demands["jerk"][0]) & (rng.random(x.shape[1]) < 0.5)
    made.demands["acceleration"][:, jumps] = (-np.inf, np.inf)
    made.demands["end_acceleration"][:, jumps] = (-np.inf, np.inf)
    return made
