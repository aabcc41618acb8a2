"""``timebound merge``: the results of several folders made into one."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from compare.benchmark.records.merge import merge
from compare.benchmark.run import tabulate_known_times
from compare.commands import DONE
from compare.files import output_folder


def merge_folders(
    folders: Annotated[tuple[str, ...], Parameter(name="DIR")],
    /,
    *,
    out: Annotated[str | None, Parameter(metavar="DIR")] = None,
    machines: bool = False,
) -> int:
    """Merge the results of folders into what one comparison would have given.

    Equal rows stand once; two results of one run by the same code are refused, and so are rows of one
    swarm on one case that another code, version or budget has made. Draw the report of the merged
    results with ``timebound report DIR``; go on with ``timebound all --resume --out DIR``.

    Parameters
    ----------
    folders
        Folders that ``timebound all`` wrote; where they hold the same, that of the first stays.
    out
        Folder of the merged results; the first of the folders if left out.
    machines
        Let rows of one swarm on one case come from different machines.
    """
    target = Path(folders[0]) if out is None else output_folder(out)
    store = merge([Path(name) for name in folders], target, allow=("machine",) if machines else ())
    if store.settings().size != "suite":  # its instances are no paper's
        with ThreadPoolExecutor(1) as pool:
            tabulate_known_times(pool, store.problems(), store)
    print(f"merged: {store.file} ({sum(1 for _ in store.iterate_rows())} rows)")
    return DONE
