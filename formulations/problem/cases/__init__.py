"""The papers' tasks, one TOML each; source, units and every assumption stand inside the file."""
