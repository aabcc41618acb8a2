"""The registry of citations: what the code calls, by its name, and the papers behind it.

The names are those of ``CASES``, ``FAMILIES``, ``RUNGS``, ``ALGORITHMS`` and ``LIBRARIES``, and the modules of
``compare.statistics`` that name papers; a test says which one is missing. Papers are keys of
``references.bib``. ``OWN`` stands for what is this project's own work.
"""

from __future__ import annotations

from enum import StrEnum

OWN = ("timebound",)
STOP_AND_GO = "stop and go"
"""Method of ``free_form`` in closed form, where joints have no acceleration limit."""


class CitedKind(StrEnum):
    """What is cited, as it is said to a person."""

    case = "case"
    family = "spline family"
    rung = "bound"
    algorithm = "algorithm"
    library = "library"
    statistic = "statistics of"


_NLP = ("andersson2019", "wachter2006")  # CasADi and IPOPT
_RELAXATION = ("kelley1960", "mccormick1976", "neumaier2004", "gleixner2017", "huangfu2018")

CITED: dict[CitedKind, dict[str, tuple[str, ...]]] = {
    CitedKind.case: {
        "bagging": ("li2022",),
        "cobot": ("zhang2025",),
        "sr4c": ("wang2025",),
        "ur5": ("zhou2025",),
        "ur5-corrected": ("zhou2025",),
        "z1": ("lu2024",),
    },
    CitedKind.family: {
        "3-5-3": ("wang2025",),
        "4-3-4": ("li2022",),
        "quintic": ("lu2024", "biagiotti2008"),
        "b-spline-3": ("lu2024",),
        "b-spline-5": ("lu2024",),
    },
    CitedKind.rung: {
        "displacement": OWN,
        "ruckig_end_to_end": ("berscheid2021", "biagiotti2008"),
        "free_form_lower": (*OWN, *_RELAXATION),
        "free_form": (*OWN, *_NLP, "berscheid2021"),
        STOP_AND_GO: OWN,
        "ruckig_stop_and_go": ("berscheid2021",),
        "family_lower": (*OWN, "verfaillie1996"),
        "family": (*OWN, *_NLP),
        "family_longest_segment": (*OWN, *_NLP),
        "toppra_family_path": ("pham2018",),
        "toppra_cubic": ("pham2018",),
        "toppra_torque": ("pham2018", "carpentier2019"),
        "copp_family_path": ("wang2026",),
    },
    CitedKind.algorithm: {
        "pso": ("clerc2002",),
        "pso-linear": ("shi1998",),
        "pso-1995": ("kennedy1995",),
        "mipso": ("wang2025",),
        "mipso-pso1": ("wang2025",),
        "mipso-pso2": ("wang2025",),
        "mipso-pso3": ("wang2025",),
        "mipso-printed": ("wang2025",),
        "mpso": ("li2022",),
        "mpso-times-ten": ("li2022",),
        "pso-zhang-2025": ("zhang2025",),
        "pso-zhang-2025-printed": ("zhang2025",),
        "sparrow": ("xue2020",),
        "sparrow-printed": ("zhou2025",),
        "butterfly": ("arora2019",),
        "issa": ("zhou2025", "xue2020", "arora2019"),
        "issa-blended": ("zhou2025", "xue2020", "arora2019"),
        "whale": ("mirjalili2016",),
        "whale-lu-2024": ("lu2024", "mirjalili2016"),
        "whale-lu-2024-printed": ("lu2024", "mirjalili2016"),
        "random": OWN,
        "sobol": ("sobol1967",),
        "de": ("storn1997",),
        "lshade": ("tanabe2014",),
        "cma-es": ("hansen2016", "auger2005"),
        "annealing": ("xiang1997",),
        "nelder-mead": ("nelder1965",),
        "slsqp": ("kraft1988",),
    },
    CitedKind.library: {
        "cmaes": ("nomura2026",),
        "mealpy": ("vanthieu2023",),
        "minionpy": ("muzakka2025",),
        "nevergrad": ("rapin2018",),
        "pymoo": ("blank2020",),
        "scipy": ("virtanen2020",),
    },
    CitedKind.statistic: {
        "pairs": ("vargha2000", "newcombe2006", "holm1979"),
        "instances": ("demsar2006", "benavoli2016", "dolan2002"),
        "equivalence": ("benavoli2017", "schuirmann1987", "vargha2000"),
        "runtimes": ("hansen2021", "wilson1927"),
        "seeds": ("noether1987",),
        "medians": ("david2003",),
    },
}
"""By kind and name: keys of ``references.bib``."""
