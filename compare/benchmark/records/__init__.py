"""What is kept of a run: one typed row, its text, where it came from, and whether it still holds."""
