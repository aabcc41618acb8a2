"""The linear relaxation that every motion satisfies: its variables, rows and solver."""
