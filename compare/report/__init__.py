"""The report: pages, figures and their style, drawn from stored rows alone."""
