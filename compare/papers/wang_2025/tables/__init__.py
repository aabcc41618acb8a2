"""Tables of Wang 2025, each with the figures that show the same numbers."""
