"""Optimisers of well-kept libraries behind the same driver: controls, and rivals by name."""
