"""What demands cost: each task solved again without one of them, and the difference that is proved."""
