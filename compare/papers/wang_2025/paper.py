"""Wang 2025: what its tables and figures share."""

from __future__ import annotations

from compare.audit.paper import Paper, load_papers, settings
from compare.benchmark.protocol import Budget

SWARM = "mipso"
ALONE = (
    "Joint 1 alone. A candidate that breaks a limit is out. The paper prints neither the search box nor the "
    "constants of PSO. It does not have the equations of IPSO, so IPSO cannot be run. "
)


def paper() -> Paper:
    """The numbers that the paper prints."""
    return load_papers("wang_2025")[0]


def budget() -> Budget:
    """Population and iterations of Table 7."""
    swarm = settings("wang_2025")["swarm"]
    return Budget(swarm["population"], swarm["iterations"])
