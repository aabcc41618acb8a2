"""``timebound speed``: candidate checks and evaluations of whole swarms per second, and written files."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.commands import DONE
from compare.commands.options import Json, positive
from compare.commands.studies import alone
from compare.screen import show
from compare.studies import speed as checks
from compare.studies.speed_files import FILES
from compare.studies.speed_mealpy import PAIRED
from compare.studies.speed_swarms import COSTS
from formulations import InputError, load

_FIVE_MINUTES = 300.0  # s


def speed(
    *,
    case: str = "sr4c",
    swarms: bool = False,
    files: bool = False,
    rounds: Annotated[int, Parameter(validator=positive)] = 5,
    json: Json = None,
) -> int:
    """Count candidate checks per second, beside the papers' way.

    Parameters
    ----------
    case
        A problem file or a shipped case; of the family 3-5-3, unless --swarms is given.
    swarms
        Show instead the evaluations per second of each swarm with its driver, on one core and in two
        processes, who spends the time, and the same swarms in mealpy.
    files
        Show instead what it takes to write five minutes of seven joints at 1 kHz in each format, read back
        and judged.
    rounds
        Rounds; the best one counts.
    """
    if files:
        if swarms:
            raise InputError("--files: given beside --swarms; leave one of them out")
        one = alone(FILES, [(_FIVE_MINUTES, rounds)], out=None, resume=False)
        show(one.as_text(), one.to_json(), json)
        return DONE
    problem = load(case)
    if not swarms and problem.family != "3-5-3":
        raise InputError(f"--case: the papers' 14x14 matrix is 3-5-3's, {case} is {problem.family}")
    studies = (COSTS, PAIRED) if swarms else (checks.STUDY,)
    found = [alone(study, [(problem, rounds)], out=None, resume=False) for study in studies]
    title = f"{problem.name}: {problem.dof} joints, {problem.family}, one core, best of {rounds} rounds"
    text = [title, *(one.study.text(one.rows, one.summary) for one in found[:-1]), found[-1].as_text()]
    show("\n".join(text), [one.to_json() for one in found], json)
    return DONE
