"""``python -m compare NAME``: every command by its name."""

from __future__ import annotations

import runpy
import sys

COMMANDS = {
    "all": "compare.all",
    "solve": "compare.commands.solve",
    "plan": "compare.commands.plan",
    "split": "compare.commands.split",
    "report": "compare.report.page",
    "motion_picture": "compare.report.motion_picture",
    "bias": "compare.studies.bias",
    "free_form_study": "compare.studies.free_form_study",
    "proofs": "compare.studies.proofs",
    "readings": "compare.studies.readings",
    "rivals": "compare.studies.rivals",
    "speed": "compare.studies.speed",
    "table8": "compare.papers.wang_2025.table_8",
    "ablation": "compare.papers.wang_2025.cec2017",
    "papers": "compare.papers",
    "audit": "compare.audit",
    "check_certificate": "compare.check_certificate",
}

if __name__ == "__main__":
    name = sys.argv.pop(1)
    runpy.run_module(COMMANDS[name], run_name="__main__", alter_sys=True)
