"""Old names of ``compare.files`` and ``compare.screen``."""

from __future__ import annotations

from compare.files import output_folder, write_json, write_text
from compare.screen import table

__all__ = ["output_folder", "table", "write_json", "write_text"]
