"""The process of one rival, ``python -m compare.rivals.child FOLDER``: a task in, plain numbers out."""

from __future__ import annotations

import json
import pickle
import sys
import time
from importlib import import_module
from pathlib import Path

import numpy as np


def main(folder: Path) -> None:
    """Run the rival of the task, and write its answer.

    Parameters
    ----------
    folder : Path
        Holds ``task.pickle``; gets ``answer.npz`` and then ``answer.json``.
    """
    target, modules, problem, seconds, memory = pickle.loads((folder / "task.pickle").read_bytes())
    if sys.platform == "linux":
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (memory, memory))
    place, _, name = target.partition(":")
    function = getattr(import_module(place), name)
    for module in modules:
        import_module(module)
    (folder / "started").touch()  # the time limit counts from here
    begun = time.perf_counter()
    answer = function(problem, seconds)
    computation = time.perf_counter() - begun
    if answer.motion is not None:
        np.savez(
            folder / "answer.npz",
            durations=answer.motion.durations,
            coefficients=answer.motion.coefficients,
        )
    said = {
        "claimed": answer.claimed,
        "bound": answer.bound,
        "note": answer.note,
        "computation": computation,
    }
    (folder / "answer.json").write_text(json.dumps(said), "utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
