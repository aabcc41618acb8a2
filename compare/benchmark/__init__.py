"""The benchmark: what is run, how a run is graded, and where its rows are kept."""
