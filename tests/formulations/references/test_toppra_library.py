"""toppra is loaded without matplotlib, and its own plots work all the same."""

from __future__ import annotations

import subprocess
import sys

_LOADED = """
import sys
import formulations
print("toppra" in sys.modules, "matplotlib" in sys.modules)
from toppra import algorithm, parametrizer
stood_for = parametrizer.plt.figure, algorithm.algorithm.plt.figure
import matplotlib.pyplot as plt
print(all(figure is plt.figure for figure in stood_for), sys.modules["matplotlib"].__version__ != "")
"""


def test_matplotlib_is_loaded_when_toppra_draws_and_not_before() -> None:
    ended = subprocess.run([sys.executable, "-c", _LOADED], capture_output=True, text=True, check=True)
    assert ended.stdout.split() == ["True", "False", "True", "True"]
