"""The driver that runs, counts and judges every algorithm."""
