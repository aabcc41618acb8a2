"""URDFs of small arms with inertias, made here: a pendulum, a planar arm of two links, an arm of six axes."""

from __future__ import annotations

from collections.abc import Sequence

VERTICAL, LEVEL = "0 0 1", "0 1 0"


def link(name: str, mass: float, com: Sequence[float], inertia: Sequence[float]) -> str:
    x, y, z = inertia
    return (
        f'<link name="{name}"><inertial><origin xyz="{com[0]} {com[1]} {com[2]}"/><mass value="{mass}"/>'
        f'<inertia ixx="{x}" iyy="{y}" izz="{z}" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )


def joint(
    name: str,
    parent: str,
    child: str,
    axis: str,
    *,
    at: Sequence[float] = (0.0, 0.0, 0.0),
    effort: float = 100.0,
    damping: float = 0.0,
    friction: float = 0.0,
    kind: str = "revolute",
) -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{at[0]} {at[1]} {at[2]}"/><axis xyz="{axis}"/>'
        f'<limit lower="-3" upper="3" velocity="5" effort="{effort}"/>'
        f'<dynamics damping="{damping}" friction="{friction}"/></joint>'
    )


def arm(*parts: str) -> str:
    return f'<robot name="arm"><link name="base"/>{"".join(parts)}</robot>'


def pendulum(
    axis: str = LEVEL,
    *,
    mass: float = 2.0,
    length: float = 0.5,
    inertia: float = 0.1,
    effort: float = 8.0,
    damping: float = 0.0,
    friction: float = 0.0,
    kind: str = "revolute",
) -> str:
    """One body; its centre of mass is on the x axis at q = 0, and moves down about ``LEVEL`` as q grows."""
    return arm(
        link("rod", mass, (length, 0.0, 0.0), (inertia,) * 3),
        joint(
            "hinge", "base", "rod", axis, effort=effort, damping=damping, friction=friction, kind=kind
        ),
    )


def two_links(
    masses=(3.0, 2.0), lengths=(0.6, 0.5), inertias=(0.12, 0.07), *, axis: str = LEVEL
) -> str:
    """A planar arm; centres of mass in the middle of the links."""
    first, second = (
        link(f"l{i}", masses[i], (lengths[i] / 2.0, 0.0, 0.0), (inertias[i],) * 3) for i in range(2)
    )
    return arm(
        first,
        second,
        joint("one", "base", "l0", axis, effort=60.0),
        joint("two", "l0", "l1", axis, at=(lengths[0], 0.0, 0.0), effort=25.0),
    )


SIX = ("turn", "lift", "elbow", "roll", "bend", "flange")


def six_axes() -> str:
    """An arm of six axes, of the size of a small industrial one."""
    bodies = [
        link("b0", 4.0, (0.0, 0.02, 0.05), (0.02, 0.02, 0.015)),
        link("b1", 7.0, (0.2, 0.0, 0.08), (0.02, 0.22, 0.22)),
        link("b2", 3.0, (0.15, 0.0, 0.02), (0.006, 0.05, 0.05)),
        link("b3", 1.2, (0.0, 0.01, 0.02), (0.002, 0.002, 0.002)),
        link("b4", 1.2, (0.0, 0.0, 0.02), (0.002, 0.002, 0.002)),
        link("b5", 0.4, (0.0, 0.0, 0.03), (0.0004, 0.0004, 0.0003)),
    ]
    places = [(0, 0, 0.1), (0, 0.13, 0), (0.42, 0, 0), (0.39, 0, 0), (0, 0.1, 0), (0, 0, 0.09)]
    axes = [VERTICAL, LEVEL, LEVEL, LEVEL, VERTICAL, LEVEL]
    efforts = (120.0, 120.0, 70.0, 20.0, 20.0, 20.0)
    links = ["base", "b0", "b1", "b2", "b3", "b4", "b5"]
    joints = [
        joint(name, links[i], links[i + 1], axes[i], at=places[i], effort=efforts[i], damping=0.1)
        for i, name in enumerate(SIX)
    ]
    return arm(*bodies, *joints)
