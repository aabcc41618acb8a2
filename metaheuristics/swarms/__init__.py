"""The swarms of the five papers and their baselines, one published variant per small file."""
