"""The words of the report, a line each. Pages link to them as ``#term-KEY``."""

from __future__ import annotations

GLOSSARY: dict[str, tuple[str, str]] = {
    "motion": ("Motion", "How all joints move over time through the waypoints, from rest to rest."),
    "family": (
        "Family",
        "A rule that makes durations into a spline through the waypoints: 3-5-3, 4-3-...-3-4, quintic,"
        " B-spline. The best spline is the fastest motion that this rule can give.",
    ),
    "durations": (
        "Durations",
        "The times of the segments between waypoints [s]; what a swarm searches.",
    ),
    "bound": (
        "Lower bound",
        "A time below which there is no motion at all, or none of the family. Proved: by arithmetic that is"
        " rounded to the safe side.",
    ),
    "gap": (
        "Gap",
        "How much longer a verified motion takes than the best motion of its family that is known.",
    ),
    "claim": (
        "Claim",
        "The time that a method's own rule gives. A claimed motion can break its limits; the verified one never"
        " does.",
    ),
    "coding": (
        "Coding",
        "How a swarm's vector becomes a motion. published: each joint alone, then the longest time per segment;"
        " shared: one set of durations for all joints; stretched: the same, made feasible exactly.",
    ),
    "stretch": (
        "Stretch",
        "The least factor on all durations that makes a motion keep its velocity, acceleration and jerk"
        " limits.",
    ),
    "swarm": (
        "Swarm",
        "An optimiser that moves many candidates at once (PSO, whales, sparrows, ...); controls are other"
        " optimisers.",
    ),
    "seed": ("Seed", "The start of a run's random numbers. Every swarm runs with the same seeds."),
    "rung": (
        "Ladder, rung",
        "The ladder holds every bound and reference of one problem, sorted by time; each line is a rung.",
    ),
}
"""Title and meaning by key."""
