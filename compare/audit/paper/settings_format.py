"""Keys of a shipped paper that its chapter needs beside the audit; the audit does not use them."""

from __future__ import annotations

from compare.audit.paper.keys import Key, KeyTable

_WHERE = Key("text", "place in the paper", '"sec. 3"')
_POPULATION = Key("whole number", "individuals of the swarm", "30")
_ITERATIONS = Key("whole number", "iterations of the swarm", "500")
_DIMENSIONS = Key("whole number", "unknowns of the search", "7")
_LOW = Key("number", "lower edge of the search box", "0", "s")
_HIGH = Key("number", "upper edge of the search box", "5", "s")


def _ablation(name: str) -> Key:
    return Key("list", f"factors of {name}, one per function", '["1.2"]')


SETTINGS = KeyTable(
    "What the chapters of the shipped papers need beside the audit; the audit does not use it.",
    {
        "swarm": KeyTable(
            "The swarm of the paper.",
            {
                "where": _WHERE,
                "population": _POPULATION,
                "iterations": _ITERATIONS,
                "dimensions": _DIMENSIONS,
                "alpha": Key("number", "peak of the tent map", "0.499"),
                "inertia": Key("list", "inertia, first and last", "[0.9, 0.4]"),
                "factors": Key("list", "learning factors, first and last", "[2, 2]"),
                "mutation": Key("list", "probability of a mutation, least and greatest", "[0.1, 0.3]"),
                "first_interval": Key(
                    "number", "time of each segment of the first individual", "1", "s"
                ),
                "low": _LOW,
                "high": _HIGH,
            },
        ),
        "tent": KeyTable(
            "The picture of the tent map.",
            {
                "where": _WHERE,
                "alpha": Key("number", "peak of the tent map", "0.499"),
                "population": _POPULATION,
                "bins": Key("whole number", "bars of the picture", "10"),
            },
        ),
        "chaos": KeyTable(
            "The picture of the chaotic start.",
            {
                "where": _WHERE,
                "beta": Key("number", "peak of the tent map", "0.5"),
                "population": _POPULATION,
                "dimensions": _DIMENSIONS,
                "low": _LOW,
                "high": _HIGH,
            },
        ),
        "ablation": KeyTable(
            "The ablation on test functions.",
            {
                "where": _WHERE,
                "population": _POPULATION,
                "dimensions": _DIMENSIONS,
                "iterations": _ITERATIONS,
                "runs": Key("whole number", "runs per function", "30"),
            },
        ),
        "ablation_factors": KeyTable(
            "The factors that the ablation prints.",
            {
                "where": _WHERE,
                "functions": Key("list", "numbers of the test functions", "[1]"),
                "PSO1": _ablation("PSO1"),
                "PSO2": _ablation("PSO2"),
                "PSO3": _ablation("PSO3"),
            },
        ),
        "first_plan": KeyTable(
            "The motion before the search.",
            {"where": _WHERE, "times": Key("list", "its durations", '["1.0"]', "s")},
        ),
        "box": KeyTable(
            "The search box.",
            {"where": _WHERE, "seconds": Key("list", "its lower and upper edge", "[0, 5]", "s")},
        ),
        "descent": KeyTable(
            "What the paper reads from its curve of convergence.",
            {
                "where": _WHERE,
                "steady_after": Key("whole number", "iteration after which nothing changes", "100"),
                "left_local_optimum": Key(
                    "whole number", "iteration that leaves a local optimum", "50"
                ),
            },
        ),
        "converged": KeyTable(
            "Iterations to convergence.",
            {
                "where": _WHERE,
                "improved": Key("whole number", "of the improved swarm", "22"),
                "PSO": Key("whole number", "of PSO", "78"),
                "WOA": Key("whole number", "of WOA", "56"),
            },
        ),
        "arm": KeyTable(
            "A length of the arm that the paper prints wrong.",
            {"where": _WHERE, "d1": Key("number", "link offset of joint 1", '"0.1305"', "m")},
        ),
    },
)

LEFT_OUT = KeyTable(
    "Shipped papers only: what the chapter does not make again.",
    {
        "where": Key("text", "place in the paper", '"Fig 1"', needed=True),
        "what": Key("text", "what stands there", '"a drawing of the arm"', needed=True),
        "why": Key("text", "why the chapter leaves it out", '"It holds no numbers."', needed=True),
    },
    many=True,
)
