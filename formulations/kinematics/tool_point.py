"""The tool point of a chain on any kind of number that can be added and multiplied and has a sine.

The same lines run on arrays, CasADi symbols, jets and intervals. The point is moved from the tip to the
base, since a point needs fewer products than a pose: x := A (R(q) (B x)), and by Rodrigues' formula, for a
unit axis k, R(q) x = x + sin q (k x x) + (1 - cos q) (k x (k x x)).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from formulations.kinematics.link_chain import LinkChain, Step
from formulations.problem.arrays import Array

Point = list[Any]


def tool_point(
    chain: LinkChain,
    joints: Sequence[Any],
    sine: Callable[[Any], Any] = np.sin,
    cosine: Callable[[Any], Any] = np.cos,
    lift: Callable[[float], Any] = float,
) -> Point:
    """Compute the tool point.

    Parameters
    ----------
    chain : LinkChain
    joints : sequence, length dof
        A number per joint [rad or m].
    sine, cosine : callable
        Of such numbers.
    lift : callable
        Makes such a number of a float.

    Returns
    -------
    list of three numbers
        [m], in the base link.
    """
    point: Point = [lift(float(value)) for value in chain.end[:3, 3]]
    for step in reversed(chain.steps):
        point = _moved(step.after, point, lift)
        q = joints[step.variable]
        if step.factor != 1.0:
            q = q * step.factor
        if step.offset != 0.0:
            q = q + step.offset
        point = _driven(step, q, point, sine, cosine)
        point = _moved(step.before, point, lift)
    return point


def _moved(pose: Array, point: Point, lift: Callable[[float], Any]) -> Point:
    """A fixed pose applied to a point; zeros and ones take no work."""
    if np.array_equal(pose, np.eye(4)):
        return point
    found = []
    for row in pose[:3]:
        value = None
        for entry, component in zip(row[:3].tolist(), point, strict=True):
            if entry == 0.0:
                continue
            term = component if entry == 1.0 else component * entry
            value = term if value is None else value + term
        shift = float(row[3])
        if value is None:
            value = lift(shift)
        elif shift != 0.0:
            value = value + shift
        found.append(value)
    return found


def _driven(
    step: Step, q: Any, point: Point, sine: Callable[[Any], Any], cosine: Callable[[Any], Any]
) -> Point:
    """The motion of a joint applied to a point."""
    axis = step.axis.tolist()
    if step.prismatic:
        return [
            component if along == 0.0 else component + q * along
            for component, along in zip(point, axis, strict=True)
        ]
    across = _crossed(axis, point)
    inward = _crossed(axis, across)
    s, c = sine(q), cosine(q)
    return [
        component
        if a is None
        else component + s * a
        if b is None
        else component + s * a + (1.0 - c) * b
        for component, a, b in zip(point, across, inward, strict=True)
    ]


def _crossed(axis: Sequence[float], point: Sequence[Any]) -> Point:
    """The cross product of an axis with a point; None where it is 0."""
    found = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        terms = [
            point[b] * factor
            for b, factor in ((k, axis[j]), (j, -axis[k]))
            if factor != 0.0 and point[b] is not None
        ]
        found.append(None if not terms else terms[0] if len(terms) == 1 else terms[0] + terms[1])
    return found
