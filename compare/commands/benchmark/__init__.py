"""Commands about the results of comparisons: merged, exported."""
