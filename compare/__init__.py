"""Swarms graded against bounds: commands, rows on disk, tables, figures, report."""
