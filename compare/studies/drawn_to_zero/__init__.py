"""Which swarms are drawn to x = 0: the objective moved away from zero, and nothing else changed."""
