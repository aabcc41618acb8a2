"""A chain from base to tool as plain data, exact to the last bit: what stores and certificates keep of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from formulations.kinematics.link_chain import LinkChain, Step
from formulations.problem.arrays import Array


def plain_chain(chain: LinkChain) -> dict[str, Any]:
    """Return a chain as plain data.

    Parameters
    ----------
    chain : LinkChain

    Returns
    -------
    dict
        ``chain``, a dict per step from base to tip, and ``end``. Poses are three rows of four numbers [m].
    """
    links = [
        {
            "before": step.before[:3].tolist(),
            "axis": step.axis.tolist(),
            "prismatic": bool(step.prismatic),
            "joint": int(step.variable),
            "factor": float(step.factor),
            "offset": float(step.offset),
            "after": step.after[:3].tolist(),
        }
        for step in chain.steps
    ]
    return {"chain": links, "end": chain.end[:3].tolist()}


def chain_of(data: Mapping[str, Any], names: tuple[str, ...]) -> LinkChain:
    """Return the chain that plain data states.

    Parameters
    ----------
    data : mapping
        As ``plain_chain`` gives it.
    names : tuple of str
        The joints.

    Returns
    -------
    LinkChain

    Raises
    ------
    KeyError, TypeError, ValueError
        An entry is missing or of another type.
    """
    steps = tuple(
        Step(
            _pose(link["before"]),
            _pose(link["after"]),
            np.array(link["axis"], dtype=np.float64),
            bool(link["prismatic"]),
            int(link["joint"]),
            float(link["factor"]),
            float(link["offset"]),
        )
        for link in data["chain"]
    )
    return LinkChain(names, steps, _pose(data["end"]))


def _pose(rows: Any) -> Array:
    return np.vstack([np.array(rows, dtype=np.float64).reshape(3, 4), [0.0, 0.0, 0.0, 1.0]])
