"""The fastest motion again, such that the points of a file describe it exactly."""
