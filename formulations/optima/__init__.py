"""Upper bounds: the fastest spline of a family, and the fastest motion of all."""
