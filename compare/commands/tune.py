"""``timebound tune``: constants of swarms, tuned on the open instances."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

from compare.benchmark.protocol import DEFAULT_BUDGET, swarms_of
from compare.benchmark.proving import prove_all
from compare.benchmark.records.provenance import versions_text
from compare.benchmark.records.store import Store
from compare.benchmark.run import warm_up
from compare.benchmark.suite import SIZE, Split, suite
from compare.benchmark.tuning.constants import constants_text
from compare.benchmark.tuning.tuner import optuna_library, tune
from compare.commands import DONE
from compare.commands.options import CORES, Budget, Jobs, Out, Seed, Swarms, positive
from compare.engines import each, workers
from compare.files import output_folder, write_text
from compare.screen import table


def tune_swarms(
    *,
    swarms: Swarms = None,
    trials: Annotated[int, Parameter(validator=positive)] = 60,
    instances: Annotated[int, Parameter(metavar="N", validator=positive)] = SIZE,
    budget: Budget = DEFAULT_BUDGET.evaluations,
    seed: Seed = 0,
    out: Out = "tuned",
    jobs: Jobs = CORES,
) -> int:
    """Tune the constants of swarms on the open instances, each swarm with the same effort.

    `timebound all --tracks equal,tuned --constants DIR/tuned.toml` grades them. The held-out instances
    are never looked at. The coding is the stretched one.

    Parameters
    ----------
    trials
        Sets of constants tried for each swarm, the published one among them.
    instances
        Tune on the open ones among the first N instances.
    """
    optuna_library()  # says what is missing before anything is proved
    wanted = list(swarms or swarms_of("suite"))
    opened = [one for one in suite(instances) if one.split is Split.open]
    store = Store(output_folder(out))
    warm_up({one.name: one.problem for one in opened})
    with workers(jobs) as pool:
        prove_all(pool, opened, store)
        ladders = store.ladders()
        optima = {one.name: ladders[one.name]["ladder"]["family"]["seconds"] for one in opened}
        posed = [(one, seconds) for one in opened if (seconds := optima[one.name]) is not None]
        calls = [(name, posed, trials, budget, seed) for name in wanted]
        found = {answer[0]: answer[1:] for answer in each(pool, "tuning", tune, calls)}
    made: dict[str, str | int] = {
        "command": f"timebound tune --swarms {','.join(wanted)} --trials {trials} --instances {instances}"
        f" --budget {budget} --seed {seed}",
        "instances": " ".join(one.name for one, _ in posed),
        "versions": versions_text(),
    }
    path = store.folder / "tuned.toml"
    write_text(path, constants_text(made, {name: found[name][0] for name in wanted}))
    cells = [[name, f"{found[name][1]:.2f}", f"{found[name][2]:.2f}"] for name in wanted]
    print(table(["swarm", "mean log10 of the gap, published", "tuned"], cells, right=(1, 2)))
    print(f"constants: {path}")
    return DONE
