"""Studies beside the main comparison, one command each."""
